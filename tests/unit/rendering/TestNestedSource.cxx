// SPDX-License-Identifier: BSD-3-Clause
// Values of levels that lie within one another.
#include "vtkDSMNestedSource.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace
{

using bricks::Box;
using bricks::Index3;

/// Samples of a level of a file, which are the values of a function at their places among the finest ones.
class Samples final : public bricks::VoxelSource
{
public:
  Samples(const Index3& count, double scale, bool isLinear)
    : Count(count)
    , Scale(scale)
    , IsLinear(isLinear)
  {
  }

  static double GetLinear(const glm::dvec3& place)
  {
    return 3.0 * place.x - place.y + 0.5 * place.z;
  }
  /// A mean's place is between those of the samples that it is of.
  double GetFirst() const { return 0.5 * (this->Scale - 1.0); }

  Box GetCells() const override { return { Index3(0), this->Count - Index3(1) }; }
  void ReadSamples(const Box& points, std::byte* out) const override
  {
    auto* next = reinterpret_cast<float*>(out);
    bricks::ForEachIndex(points,
      [&](const Index3& point)
      {
        const glm::dvec3 place = this->GetFirst() + this->Scale * glm::dvec3(point);
        const double noise = std::sin(12.9898 * place.x + 78.233 * place.y + 37.719 * place.z);
        *next++ = static_cast<float>(this->IsLinear ? GetLinear(place) : 100.0 * noise);
      });
  }

private:
  Index3 Count;
  double Scale;
  bool IsLinear;
};

/// Sources of three levels, the finest first: each in a box of whole bricks of the next one.
struct Levels
{
  explicit Levels(bool isLinear)
  {
    const Index3 points(101, 90, 77);
    const Box boxes[] = { { { 16, 16, 32 }, { 48, 64, 76 } }, { { 0, 0, 16 }, { 32, 32, 38 } },
      { { 0, 0, 0 }, { 25, 23, 19 } } };
    std::shared_ptr<const vtkDSMNestedSource> coarser;
    for (int level = 2; level >= 0; --level)
    {
      const std::int64_t scale = std::int64_t(1) << level;
      const Index3 count = (points + Index3(scale - 1)) / Index3(scale);
      const auto samples =
        std::make_shared<const Samples>(count, static_cast<double>(scale), isLinear);
      vtkDSMNestedSource::Level of;
      of.Samples = samples;
      of.Type = bricks::ScalarType::Float32;
      of.Count = count;
      of.First = glm::dvec3(-samples->GetFirst() / static_cast<double>(scale));
      of.Step = glm::dvec3(1.0);
      of.Cells = (points - Index3(1) + Index3(scale - 1)) / Index3(scale);
      coarser = std::make_shared<const vtkDSMNestedSource>(
        of, boxes[level], bricks::ScalarType::Float64, coarser, Index3(2));
      this->Sources[level] = coarser;
      this->Boxes[level] = boxes[level];
    }
  }

  std::vector<double> Read(int level, const Box& points) const
  {
    std::vector<double> values(static_cast<std::size_t>(points.GetCount()));
    const Box own{ points.Min - this->Boxes[level].Min, points.Max - this->Boxes[level].Min };
    this->Sources[level]->ReadSamples(own, reinterpret_cast<std::byte*>(values.data()));
    return values;
  }

  std::shared_ptr<const vtkDSMNestedSource> Sources[3];
  Box Boxes[3];
};

} // namespace

TEST(NestedSource, KeepsALinearFunction)
{
  const Levels levels(true);
  for (int level = 0; level < 3; ++level)
  {
    // Beyond the middles of the outermost samples, values stay as they are.
    Box points{ levels.Boxes[level].Min + Index3(1), levels.Boxes[level].Max - Index3(1) };
    const std::vector<double> values = levels.Read(level, points);
    std::size_t next = 0;
    bricks::ForEachIndex(points,
      [&](const Index3& point)
      {
        const glm::dvec3 place = std::ldexp(1.0, level) * glm::dvec3(point);
        ASSERT_NEAR(values[next], Samples::GetLinear(place), 1e-4) << "level " << level;
        ++next;
      });
  }
}

/// On the faces of a box, the values are those of the coarser cells around it; a part is read as the whole is.
TEST(NestedSource, ContinuesTheCoarserLevel)
{
  const Levels levels(false);
  for (int level = 0; level < 2; ++level)
  {
    const Box& box = levels.Boxes[level];
    const Box all{ box.Min, box.Max + Index3(1) };
    const std::vector<double> values = levels.Read(level, all);
    const Box coarse{ all.Min / Index3(2), (all.Max + Index3(1)) / Index3(2) };
    const std::vector<double> coarser = levels.Read(level + 1, coarse);
    const auto get = [](const std::vector<double>& from, const Box& in, const Index3& point)
    {
      const Index3 at = point - in.Min;
      const Index3 size = in.GetSize();
      return from[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))];
    };
    int onFaces = 0;
    int others = 0;
    bricks::ForEachIndex(all,
      [&](const Index3& point)
      {
        double mean = 0.0;
        for (int corner = 0; corner < 8; ++corner)
        {
          const Index3 more(corner & 1, corner >> 1 & 1, corner >> 2);
          mean += 0.125 * get(coarser, coarse, (point + more) / Index3(2));
        }
        const double value = get(values, all, point);
        const bool isOnFace = (box.Min.x > 0 && point.x == box.Min.x) || point.x == box.Max.x ||
          (box.Min.y > 0 && point.y == box.Min.y) || point.y == box.Max.y ||
          (box.Min.z > 0 && point.z == box.Min.z);
        if (isOnFace)
        {
          ASSERT_NEAR(value, mean, 1e-9) << "level " << level;
          ++onFaces;
        }
        else if (std::abs(value - mean) > 1.0)
        {
          ++others;
        }
      });
    EXPECT_GT(onFaces, 1000);
    EXPECT_GT(others, 10 * onFaces / 2);
    const Box part{ box.Min + Index3(8, 0, 3), box.Min + Index3(17, 9, 12) };
    const std::vector<double> some = levels.Read(level, part);
    std::size_t next = 0;
    bricks::ForEachIndex(
      part, [&](const Index3& point) { EXPECT_EQ(some[next++], get(values, all, point)); });
  }
}
