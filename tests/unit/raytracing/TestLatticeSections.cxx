// SPDX-License-Identifier: BSD-3-Clause
// Where rays meet planes through a lattice, and the bricks that beams of rays foresee.
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/LatticeSections.h"

#include "RandomRays.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <vector>

namespace
{

const bricks::Index3 Cells{ 40, 29, 23 };

rt::LatticeField CreateField(const glm::dmat4& indexToWorld)
{
  auto voxels = std::make_shared<bricks::VoxelField>();
  voxels->Lattice =
    bricks::BrickLattice(Cells + bricks::Index3(1), bricks::ScalarType::Float32, false, 4);
  rt::LatticeField field;
  field.Voxels = voxels;
  field.SetIndexToWorld(indexToWorld);
  return field;
}

class LatticeSections : public testing::Test
{
protected:
  glm::dvec3 GetVector() { return { this->Get(-1, 1), this->Get(-1, 1), this->Get(-1, 1) }; }
  double Get(double low, double high) { return this->Random.Get(low, high); }

  /// A random plane through the lattice, in some cases along its axes.
  rt::SectionPlane CreatePlane(const rt::LatticeField& field, int number)
  {
    glm::dvec3 normal = this->GetVector();
    glm::dvec3 point = this->Random.GetPoint();
    if (number % 3 == 0)
    {
      normal = glm::dvec3(0.0);
      normal[number % 9 / 3] = this->Get(-2, 2);
      point = number % 2 == 0 ? glm::round(point) : point;
    }
    return { normal * glm::dmat3(field.WorldToIndex),
      glm::dvec3(field.IndexToWorld * glm::dvec4(point, 1.0)) };
  }

  RandomRays Random{ Cells, 5 };
};

TEST_F(LatticeSections, HitsAreInOrderWithinThePlanesAndTheLattice)
{
  const rt::LatticeField field = CreateField(
    glm::rotate(glm::scale(glm::dmat4(1.0), { 0.7, 1.3, 1.0 }), 0.4, { 1.0, 2.0, 0.5 }));
  std::vector<rt::SectionPlane> planes;
  for (int number = 0; number < 6; ++number)
  {
    planes.push_back(this->CreatePlane(field, number));
  }
  const rt::LatticeSections sections(field, planes);
  int hits = 0;
  for (int number = 0; number < 500; ++number)
  {
    rt::Ray ray = this->Random.Create(static_cast<RandomRays::Kind>(number % 7));
    ray.Origin = glm::dvec3(field.IndexToWorld * glm::dvec4(ray.Origin, 1.0));
    ray.Direction = glm::dmat3(field.IndexToWorld) * ray.Direction;
    rt::LatticeSections::Line line;
    ASSERT_TRUE(sections.GetLine(ray, line));
    rt::LatticeSections::Hit hit;
    std::set<int> met;
    double last = ray.Min;
    while (sections.FindNext(ray, line, hit))
    {
      ++hits;
      ASSERT_GE(hit.T, last);
      ASSERT_LE(hit.T, ray.Max);
      last = hit.T;
      ASSERT_TRUE(met.insert(hit.Plane).second) << "each plane once";
      const glm::dvec3 place(field.IndexToWorld * glm::dvec4(hit.At.IndexPoint, 1.0));
      const rt::SectionPlane& plane = planes[hit.Plane];
      EXPECT_NEAR(glm::dot(glm::normalize(plane.Normal), place - plane.Point), 0.0,
        1e-6 * glm::length(ray.Origin));
      EXPECT_EQ(hit.At.Brick, field.Voxels->Lattice.FindBrick(hit.At.IndexPoint));
      const glm::dvec3 inside = hit.At.IndexPoint - glm::dvec3(hit.At.Cell);
      EXPECT_TRUE(inside.x >= 0 && inside.y >= 0 && inside.z >= 0 && inside.x <= 1 &&
        inside.y <= 1 && inside.z <= 1);
    }
  }
  EXPECT_GT(hits, 300);
}

TEST_F(LatticeSections, APlaneThroughSamplesHasTheirCoordinate)
{
  // Neither the spacing nor the origin are numbers that floats hold.
  const rt::LatticeField field = CreateField(
    glm::scale(glm::translate(glm::dmat4(1.0), { 0.1, -1000.3, 7.7 }), { 0.1, 0.3, 0.7 }));
  const glm::dvec3 normal = glm::dvec3(0.0, 1.0, 0.0) * glm::dmat3(field.WorldToIndex);
  for (int index = 0; index <= Cells.y; ++index)
  {
    const std::vector<rt::SectionPlane> planes{ { normal,
      glm::dvec3(field.IndexToWorld * glm::dvec4(0.0, index, 0.0, 1.0)) } };
    const rt::LatticeSections sections(field, planes);
    rt::Ray ray;
    ray.Origin = { 1.0, -900.0, 9.0 };
    ray.Direction = { 0.003, -1.0, 0.007 };
    ray.Max = 1000.0;
    rt::LatticeSections::Line line;
    rt::LatticeSections::Hit hit;
    ASSERT_TRUE(sections.GetLine(ray, line) && sections.FindNext(ray, line, hit));
    EXPECT_EQ(hit.At.IndexPoint.y, index);
    EXPECT_EQ(hit.At.Cell.y, std::min<std::int64_t>(index, Cells.y - 1));
  }
}

TEST_F(LatticeSections, BeamsForeseeWhatTheirRaysMeet)
{
  const rt::LatticeField field = CreateField(glm::scale(glm::dmat4(1.0), { 0.7, 1.3, 1.0 }));
  int known = 0;
  int met = 0;
  std::size_t foreseen = 0;
  for (int number = 0; number < 2000; ++number)
  {
    const std::vector<rt::SectionPlane> planes{ this->CreatePlane(field, number),
      this->CreatePlane(field, number + 1) };
    const rt::LatticeSections sections(field, planes);
    // From one point, or parallel along an axis.
    const glm::dvec3 target(field.IndexToWorld * glm::dvec4(this->Random.GetPoint(), 1.0));
    glm::dvec3 way = glm::normalize(this->GetVector());
    way = number % 5 == 0 ? glm::dvec3(0.0, 0.0, 1.0) : way;
    const glm::dvec3 right = glm::normalize(glm::cross(way, glm::dvec3(0.3, 0.9, 0.1)));
    const glm::dvec3 up = glm::cross(way, right);
    const double size = this->Get(0.1, 4.0);
    const auto getRay = [&](double x, double y)
    {
      rt::Ray ray;
      const glm::dvec3 aside = size * (x * right + y * up);
      ray.Origin = target - 60.0 * way + (number % 5 == 0 ? aside : glm::dvec3(0.0));
      ray.Direction = target + aside - ray.Origin;
      ray.Max = 10.0;
      return ray;
    };
    const rt::Ray corners[4] = { getRay(0, 0), getRay(1, 0), getRay(1, 1), getRay(0, 1) };
    const rt::SectionBeam beam = sections.FindBeam(corners);
    const std::set<dsm::BlockId> bricks(beam.Bricks.begin(), beam.Bricks.end());
    known += beam.IsKnown ? 1 : 0;
    foreseen += beam.IsKnown ? bricks.size() : 0;
    std::set<dsm::BlockId> needed;
    for (int ray = 0; ray < 30 && beam.IsKnown; ++ray)
    {
      const rt::Ray inside = getRay(this->Get(0, 1), this->Get(0, 1));
      rt::LatticeSections::Line line;
      rt::LatticeSections::Hit hit;
      ASSERT_TRUE(sections.GetLine(inside, line));
      while (sections.FindNext(inside, line, hit))
      {
        ASSERT_TRUE(beam.MayMeet());
        ASSERT_EQ(bricks.count(hit.At.Brick), 1u) << "beam " << number;
        needed.insert(hit.At.Brick);
      }
    }
    met += static_cast<int>(needed.size());
  }
  EXPECT_GT(known, 1500);
  EXPECT_LT(foreseen, 2u * met);
}

} // namespace
