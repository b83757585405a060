// SPDX-License-Identifier: BSD-3-Clause
// Rays through cells find the same bits with every kind of vectors, those that they find one by one.
#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/cells/SplitCell.h"
#include "DSMRayTracing/field/tetrahedra/CellKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/ShearedRay.h"
#include "TetrahedronCrossing.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>
#include <vector>

namespace
{

using rt::CellKernel;
using rt::CellPacket;

constexpr double Lower[3] = { 0.0, 0.0, 0.0 };
constexpr double Upper[3] = { 4.0, 4.0, 4.0 };

/// Random cells and rays; `whole`: at whole numbers, so that rays pass through corners, edges and faces.
class Source
{
public:
  explicit Source(unsigned seed)
    : Random(seed)
  {
  }

  double GetNumber(bool whole, double least, double most)
  {
    return whole ? std::uniform_int_distribution<int>(
                     static_cast<int>(least), static_cast<int>(most))(this->Random)
                 : std::uniform_real_distribution<double>(least, most)(this->Random);
  }
  int GetCount(int most) { return static_cast<int>(this->Random() % most) + 1; }

  /// A ray from a corner of the packet's rays that may meet cells; `axis`: 0 to 2, along it.
  rt::ShearedRay CreateRay(bool whole, int axis)
  {
    rt::ShearedRay ray;
    while (true)
    {
      glm::dvec3 origin;
      glm::dvec3 direction(0.0);
      for (int place = 0; place < 3; ++place)
      {
        origin[place] = this->GetNumber(whole, -2.0, 4.0);
        direction[place] = place == axis ? 1.0 : axis < 0 ? this->GetNumber(whole, -3.0, 3.0) : 0.0;
      }
      const double last = this->Random() % 4 == 0 ? this->GetNumber(whole, 1.0, 5.0) : HUGE_VAL;
      if (ray.Set(&origin.x, &direction.x, 0.0, last, Lower, Upper))
      {
        return ray;
      }
    }
  }

  /// Rays that have their axes in common.
  CellPacket CreatePacket(std::vector<rt::ShearedRay>& rays)
  {
    CellPacket packet;
    const bool whole = this->Random() % 2 == 0;
    const int axis = static_cast<int>(this->Random() % 6) - 3;
    const int count = this->GetCount(CellPacket::Size);
    while (packet.Count < count)
    {
      const rt::ShearedRay ray = this->CreateRay(whole, axis);
      if (rays.empty() || std::equal(ray.Triangles.Axes, ray.Triangles.Axes + 3, packet.Axes))
      {
        packet.Add(packet.Count, ray);
        rays.push_back(ray);
      }
    }
    return packet;
  }

  CellKernel::Group CreateGroup()
  {
    CellKernel::Group group;
    const bool whole = this->Random() % 2 == 0;
    const int flat = static_cast<int>(this->Random() % 8); // an axis, or none
    const int count = 8 + this->GetCount(20);
    group.Used = (std::uint64_t(1) << count) - 1;
    for (int number = 0; number < count; ++number)
    {
      CellKernel::Group::Point& point = group.Points[number];
      for (int axis = 0; axis < 3; ++axis)
      {
        point.Place[axis] =
          axis == flat ? 1.0f : static_cast<float>(this->GetNumber(whole, 0.0, 4.0));
      }
      if (this->Random() % 8 == 0)
      {
        std::copy_n(group.Points[0].Place, 3, point.Place);
      }
      point.Value = static_cast<float>(this->GetNumber(whole, -2.0, 2.0));
    }
    group.Corners = this->Random() % 2 == 0 ? 4 : 8;
    group.CellCount = this->GetCount(CellKernel::Group::MostCells);
    int parts = 0;
    for (int index = 0; index < group.CellCount; ++index)
    {
      CellKernel::Group::Cell& cell = group.Cells[index];
      std::array<std::uint8_t, CellKernel::Group::MostPoints> points;
      std::iota(points.begin(), points.end(), std::uint8_t{ 0 });
      std::shuffle(points.begin(), points.begin() + count, this->Random);
      std::copy_n(points.begin(), CellKernel::Group::MostCorners, cell.At);
      cell.FirstPart = static_cast<std::uint8_t>(parts);
      cell.Parts = group.Corners == 4 ? 1 : bricks::MostTetrahedra;
      const bricks::SplitTetrahedra& split = bricks::Splits[this->Random() % bricks::SplitCodes];
      for (int part = 0; part < cell.Parts; ++part, ++parts)
      {
        for (int corner = 0; corner < 4; ++corner)
        {
          group.Tetrahedra[parts][corner] =
            cell.At[group.Corners == 4 ? corner : split.Corners[part][corner]];
        }
      }
    }
    return group;
  }

  std::mt19937 Random;
};

/// What a ray crosses by itself, in the order of the tetrahedra.
std::vector<CellKernel::Crossing> FindAlone(
  const rt::ShearedRay& ray, const CellKernel::Group& group, const CellPacket& packet)
{
  std::vector<CellKernel::Crossing> found;
  const CellKernel::Group::Cell& last = group.Cells[group.CellCount - 1];
  for (int part = 0; part < last.FirstPart + last.Parts; ++part)
  {
    SeenPoint seen[4];
    for (int corner = 0; corner < 4; ++corner)
    {
      const CellKernel::Group::Point& from = group.Points[group.Tetrahedra[part][corner]];
      float point[3];
      for (int place = 0; place < 3; ++place)
      {
        point[packet.Axes[place]] = from.Place[place];
      }
      seen[corner].Set(ray.Triangles, point, from.Value);
    }
    TetrahedronCrossing crossing;
    if (crossing.Find(ray.Triangles, seen[0], seen[1], seen[2], seen[3]) &&
      crossing.Exit >= ray.Triangles.Min && crossing.Enter <= ray.Triangles.Max)
    {
      found.push_back({ crossing.Enter, crossing.Exit, crossing.First, crossing.Last, 0,
        static_cast<std::uint8_t>(part) });
    }
  }
  return found;
}

TEST(CellKernelTest, CrossesTetrahedraAsRaysAlone)
{
  Source source(5);
  std::size_t all = 0;
  for (int round = 0; round < 400; ++round)
  {
    std::vector<rt::ShearedRay> rays;
    const CellPacket packet = source.CreatePacket(rays);
    const CellKernel::Group group = source.CreateGroup();
    const rt::RayMask lanes =
      (rt::RayMask{ source.Random() } << 32 | source.Random() | 1) & packet.GetLanes();
    for (const CellKernel& kernel : CellKernel::GetAll())
    {
      SCOPED_TRACE(testing::Message() << kernel.Name << ", round " << round);
      CellKernel::Crossing crossings[CellKernel::MostCrossings];
      const int count = kernel.FindCrossings(packet, lanes, group, crossings);
      std::vector<CellKernel::Crossing> found(crossings, crossings + count);
      std::sort(found.begin(), found.end(),
        [](const auto& one, const auto& other)
        { return std::tie(one.Lane, one.Part) < std::tie(other.Lane, other.Part); });
      std::size_t next = 0;
      rt::ForEachRay(lanes,
        [&](int lane)
        {
          for (const CellKernel::Crossing& alone : FindAlone(rays[lane], group, packet))
          {
            ASSERT_LT(next, found.size());
            const CellKernel::Crossing& one = found[next++];
            EXPECT_EQ(one.Lane, lane);
            EXPECT_EQ(one.Part, alone.Part);
            EXPECT_EQ(one.Enter, alone.Enter);
            EXPECT_EQ(one.Exit, alone.Exit);
            EXPECT_EQ(one.First, alone.First);
            EXPECT_EQ(one.Last, alone.Last);
          }
        });
      EXPECT_EQ(next, found.size());
      all += next;
    }
  }
  EXPECT_GT(all, 10000u);
}

TEST(CellKernelTest, MeetsBoxesAsRaysAlone)
{
  Source source(6);
  int all = 0;
  for (int round = 0; round < 200; ++round)
  {
    std::vector<rt::ShearedRay> rays;
    CellPacket packet = source.CreatePacket(rays);
    bricks::WideBvhNode<std::uint16_t> node = { { 0.0f, 0.5f, 0.0f }, { 121, 121, 121 }, 8, {},
      {} };
    for (int plane = 0; plane < 24; ++plane)
    {
      node.Bounds[plane] = static_cast<std::uint8_t>(source.GetCount(255));
      node.Bounds[24 + plane] =
        static_cast<std::uint8_t>(std::min(255, node.Bounds[plane] + source.GetCount(100)));
    }
    const unsigned wanted = source.Random() & 255u;
    for (const CellKernel& kernel : CellKernel::GetAll())
    {
      SCOPED_TRACE(kernel.Name);
      CellKernel::Children met;
      kernel.FindChildren(
        packet, packet.GetLanes(), { node.Origin, node.Exponent, node.Bounds }, wanted, met);
      float nearest[8];
      std::fill_n(nearest, 8, std::numeric_limits<float>::infinity());
      for (int lane = 0; lane < packet.Count; ++lane)
      {
        float enter[8];
        const unsigned expected =
          rays[lane].Boxes.FindChildren(node, rays[lane].BoxesEnd, enter) & wanted;
        for (int child = 0; child < 8; ++child)
        {
          const bool isMet = (expected >> child & 1) != 0;
          if ((wanted >> child & 1) != 0)
          {
            EXPECT_EQ((met.Lanes[child] >> lane & 1) != 0, isMet);
          }
          nearest[child] = isMet ? std::min(nearest[child], enter[child]) : nearest[child];
          all += isMet;
        }
      }
      for (int child = 0; child < 8; ++child)
      {
        if ((wanted >> child & 1) != 0)
        {
          EXPECT_EQ(met.Enter[child], nearest[child]);
        }
      }
    }
  }
  EXPECT_GT(all, 1000);
}

/// Sums of rays that pass the same parts.
std::vector<double> Integrate(
  const CellKernel& kernel, const rt::TransferFunction& function, unsigned seed)
{
  Source source(seed);
  std::vector<rt::ShearedRay> rays;
  const CellPacket packet = source.CreatePacket(rays);
  std::vector<CellKernel::Part> parts[CellPacket::Size];
  CellKernel::Runs runs;
  for (int lane = 0; lane < packet.Count; ++lane)
  {
    double t = 0.0;
    double value = source.GetNumber(false, -0.2, 1.2);
    for (int part = source.GetCount(20) - 1; part > 0; --part)
    {
      const double exit = t + source.GetNumber(false, 0.0, 0.2);
      const double last = source.GetNumber(source.Random() % 4 == 0, -0.2, 1.2);
      parts[lane].push_back({ t, exit, value, last });
      t = exit;
      value = last;
    }
    runs.First[lane] = parts[lane].data();
    runs.Count[lane] = static_cast<int>(parts[lane].size());
  }
  rt::Ray plain[CellPacket::Size] = {};
  std::for_each(plain, plain + CellPacket::Size,
    [](rt::Ray& ray) { ray.Direction = glm::dvec3(0.0, 0.0, 1.0); });
  rt::MediumLight light;
  light.Begin(plain, packet.GetLanes());
  const rt::RayMask dark = kernel.Integrate(packet, runs, function, light);
  std::vector<double> sums;
  for (int lane = 0; lane < packet.Count; ++lane)
  {
    EXPECT_EQ((dark >> lane & 1) != 0, light.IsDark(lane));
    sums.insert(sums.end(),
      { light.Sum[0][lane], light.Sum[1][lane], light.Sum[2][lane], light.Transmittance[lane],
        light.First[lane], light.Middle[lane] });
  }
  return sums;
}

TEST(CellKernelTest, MediaAreTheSameForAllVectors)
{
  std::vector<glm::dvec4> looks;
  for (int sample = 0; sample < 12; ++sample)
  {
    looks.emplace_back(0.1 * sample, 0.5, 1.0 - 0.05 * sample, sample % 3 == 0 ? 0.0 : 4.0);
  }
  const rt::TransferFunction function(0.0, 1.0, looks);
  for (unsigned seed = 0; seed < 50; ++seed)
  {
    const auto kernels = CellKernel::GetAll();
    const std::vector<double> alone = Integrate(kernels.front(), function, seed);
    for (const CellKernel& kernel : kernels)
    {
      SCOPED_TRACE(kernel.Name);
      EXPECT_EQ(Integrate(kernel, function, seed), alone);
    }
  }
}

} // namespace
