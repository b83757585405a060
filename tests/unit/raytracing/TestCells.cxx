// SPDX-License-Identifier: BSD-3-Clause

// The visitors of field/cells with cells that are no voxels: values are polynomials, and there are no corners and
// no bricks.
#include "DSMRayTracing/base/VectorTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/unit/raytracing/TestCells.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/base/VectorKernel.h"
#include "DSMRayTracing/field/MediumTolerance.h"
#include "DSMRayTracing/field/cells/CellCrossing-inl.h"
#include "DSMRayTracing/field/cells/Cubics-inl.h"
#include "DSMRayTracing/field/cells/ExtremumCells-inl.h"
#include "DSMRayTracing/field/cells/MediumCells-inl.h"
#include "DSMRayTracing/field/cells/SurfaceCells-inl.h"

#include <gtest/gtest.h>

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#ifndef TestCells_cxx
#define TestCells_cxx

namespace testcells
{

/// Rays, each in one cell.
struct Ways
{
  static constexpr int Count = 61; // the last vector is not full
  alignas(64) double Coefficients[4][rt::MaxRays] = {};
  alignas(64) double Enter[rt::MaxRays] = {};
  alignas(64) double Exit[rt::MaxRays] = {};

  /// From cells that the rays go through in T from 1 to 3 or less.
  explicit Ways(std::mt19937& random)
  {
    for (int ray = 0; ray < rt::MaxRays; ++ray)
    {
      this->Enter[ray] = 1.0 + std::uniform_real_distribution<double>(0.0, 1.0)(random);
      this->Exit[ray] = this->Enter[ray] + 0.5;
    }
  }
  double GetT(int ray, double position) const
  {
    return this->Enter[ray] + position * (this->Exit[ray] - this->Enter[ray]);
  }
  double Evaluate(int ray, double s) const
  {
    const auto c = [&](int power) { return this->Coefficients[power][ray]; };
    return c(0) + s * (c(1) + s * (c(2) + s * c(3)));
  }
};

/// What a new kind of cells has for each instruction set.
struct PolynomialKernel
{
  const char* Name;
  int Width;

  /// Sets T of the first crossing of each ray that has one. Returns these rays.
  rt::RayMask (*FindFirst)(const Ways& ways, double* crossings);
  void (*Count)(const Ways& ways, int* counts);
  void (*FindExtrema)(const Ways& ways, rt::RayExtrema& extrema);
  rt::RayMask (*March)(
    const Ways& ways, const rt::TransferFunction& function, rt::MediumLight& light);

  static const PolynomialKernel& GetBest();
  static std::vector<PolynomialKernel> GetAll();
};

} // namespace testcells
#endif

HWY_BEFORE_NAMESPACE();
namespace testcells
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;
namespace kernels = rt::HWY_NAMESPACE;

template <class D>
struct PolynomialCrossing : kernels::CellCrossing<D>
{
  using Vector = hn::Vec<D>;
  static constexpr int PlaceNumbers = 1;

  Vector Coefficients[4];
  Vector Number;

  kernels::Cubics<D> GetCubics() const { return this->GetCubics(hn::Set(D(), 1.0)); }
  kernels::Cubics<D> GetCubics(Vector sign) const
  {
    Vector signedOnes[4];
    Vector last = hn::Zero(D());
    for (int power = 0; power < 4; ++power)
    {
      signedOnes[power] = hn::Mul(this->Coefficients[power], sign);
      last = hn::Add(last, signedOnes[power]);
    }
    return kernels::Cubics<D>(signedOnes, last);
  }
  /// That of the Bernstein coefficients.
  void FindRange(Vector& least, Vector& most) const
  {
    const Vector third = hn::Set(D(), 1.0 / 3.0);
    const Vector* const c = this->Coefficients;
    const Vector twice = hn::Add(hn::Add(c[1], c[1]), c[2]);
    const Vector all[4] = { c[0], hn::Add(c[0], hn::Mul(third, c[1])),
      hn::Add(c[0], hn::Mul(third, twice)), hn::Add(hn::Add(c[0], c[1]), hn::Add(c[2], c[3])) };
    least = all[0];
    most = all[0];
    for (const Vector& value : all)
    {
      least = hn::Min(least, value);
      most = hn::Max(most, value);
    }
  }
  std::uint32_t FindHidden(const kernels::Cubics<D>&, std::uint32_t) const { return 0; }
  template <class Put>
  void PutPlace(const Put& put) const
  {
    put(0, this->Number);
  }
};

template <class D>
class PolynomialSteps
{
public:
  static PolynomialKernel Create(const char* name)
  {
    return { name, Width, &FindFirst, &Count, &FindExtrema, &March };
  }

private:
  using Vector = hn::Vec<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  static rt::RayMask FindFirst(const Ways& ways, double* crossings)
  {
    using First = kernels::FirstCrossings<D, 1>;
    typename First::Found found;
    First first(&found);
    const rt::RayMask ended = VisitAll(ways, first);
    First any(nullptr);
    EXPECT_EQ(VisitAll(ways, any), ended);
    found.Refine(D(),
      [&](int index, Vector t, Vector, std::uint32_t isFromInside)
      {
        HWY_ALIGN double values[2][Width];
        hn::Store(t, D(), values[0]);
        hn::Store(found.GetPlace(D(), 0, index), D(), values[1]);
        for (int lane = 0; lane < std::min(Width, found.Count - index); ++lane)
        {
          const int ray = found.Ray[index + lane];
          EXPECT_EQ(values[1][lane], ray);
          EXPECT_EQ((isFromInside >> lane & 1) != 0, ways.Evaluate(ray, 0.0) >= 0.0);
          crossings[ray] = values[0][lane];
        }
      });
    return ended;
  }

  static void Count(const Ways& ways, int* counts)
  {
    kernels::CrossingCounts<D> counted(counts);
    EXPECT_EQ(VisitAll(ways, counted), 0u);
  }

  static void FindExtrema(const Ways& ways, rt::RayExtrema& extrema)
  {
    kernels::ExtremumCells<D> cells(extrema);
    VisitAll(ways, cells);
  }

  static rt::RayMask March(
    const Ways& ways, const rt::TransferFunction& function, rt::MediumLight& light)
  {
    kernels::MediumCells<D> cells(function, light);
    return VisitAll(ways, cells);
  }

  template <class Visitor>
  static rt::RayMask VisitAll(const Ways& ways, Visitor& visitor)
  {
    const D tag;
    rt::RayMask ended = 0;
    for (int first = 0; first < Ways::Count; first += Width)
    {
      std::size_t rays[Width];
      HWY_ALIGN double numbers[Width];
      for (int lane = 0; lane < Width; ++lane)
      {
        rays[lane] = static_cast<std::size_t>(first + lane);
        numbers[lane] = first + lane;
      }
      PolynomialCrossing<D> crossing;
      crossing.Ray = rays;
      crossing.There = rt::GetPart((rt::RayMask{ 1 } << Ways::Count) - 1, first, Width);
      crossing.Number = hn::Load(tag, numbers);
      crossing.Enter = hn::Load(tag, ways.Enter + first);
      crossing.Exit = hn::Load(tag, ways.Exit + first);
      crossing.Crossing = hn::Lt(crossing.Enter, crossing.Exit);
      for (int power = 0; power < 4; ++power)
      {
        crossing.Coefficients[power] = hn::Load(tag, ways.Coefficients[power] + first);
      }
      ended |= rt::RayMask{ visitor.Visit(crossing) } << first;
    }
    return ended;
  }
};

RT_CREATE_KERNEL(PolynomialKernel, PolynomialSteps, double, 8)

} // namespace HWY_NAMESPACE
} // namespace testcells
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace testcells
{

RT_DISPATCH_KERNEL(PolynomialKernel)

namespace
{

double Draw(std::mt19937& random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Up to three different roots, some of them outside of [0, 1], ascending.
std::vector<double> DrawRoots(std::mt19937& random)
{
  std::vector<double> roots(1 + random() % 3);
  for (std::size_t index = 0; index < roots.size(); ++index)
  {
    roots[index] = Draw(random, 0.01, 0.49) + 0.5 * (static_cast<double>(index) - 0.6);
  }
  return roots;
}

TEST(Cells, PolynomialsCrossTheSurfaceAtTheirRoots)
{
  for (const PolynomialKernel& kernel : PolynomialKernel::GetAll())
  {
    std::mt19937 random(5);
    for (int round = 0; round < 20; ++round)
    {
      Ways ways(random);
      std::vector<double> inside[Ways::Count];
      for (int ray = 0; ray < Ways::Count; ++ray)
      {
        ways.Coefficients[0][ray] = random() % 2 == 0 ? 2.0 : -2.0;
        for (const double root : DrawRoots(random))
        {
          // Times (s - root).
          for (int power = 3; power >= 0; --power)
          {
            double& own = ways.Coefficients[power][ray];
            own = (power > 0 ? ways.Coefficients[power - 1][ray] : 0.0) - root * own;
          }
          if (root > 0.0 && root < 1.0)
          {
            inside[ray].push_back(root);
          }
        }
      }
      double crossings[rt::MaxRays];
      const rt::RayMask found = kernel.FindFirst(ways, crossings);
      int counts[rt::MaxRays] = {};
      kernel.Count(ways, counts);
      for (int ray = 0; ray < Ways::Count; ++ray)
      {
        EXPECT_EQ(counts[ray], static_cast<int>(inside[ray].size())) << kernel.Name << ray;
        ASSERT_EQ((found >> ray & 1) != 0, !inside[ray].empty()) << kernel.Name << ray;
        if (!inside[ray].empty())
        {
          EXPECT_NEAR(crossings[ray], ways.GetT(ray, inside[ray].front()), 1e-7) << kernel.Name;
        }
      }
      EXPECT_EQ(found >> Ways::Count, 0u);
    }
  }
}

TEST(Cells, ExtremaOfParabolasAreAtTheirEndsOrVertices)
{
  for (const PolynomialKernel& kernel : PolynomialKernel::GetAll())
  {
    std::mt19937 random(6);
    for (const double sign : { 1.0, -1.0 })
    {
      Ways ways(random);
      double vertices[Ways::Count];
      for (int ray = 0; ray < Ways::Count; ++ray)
      {
        // 1 + bend (s - vertex)^2
        const double bend = Draw(random, -3.0, 3.0);
        const double vertex = Draw(random, -0.5, 1.5);
        vertices[ray] = vertex;
        ways.Coefficients[0][ray] = 1.0 + bend * vertex * vertex;
        ways.Coefficients[1][ray] = -2.0 * bend * vertex;
        ways.Coefficients[2][ray] = bend;
      }
      constexpr double infinity = std::numeric_limits<double>::infinity();
      const rt::RayMask all = (rt::RayMask{ 1 } << Ways::Count) - 1;
      rt::RayExtrema extrema(all, sign < 0.0, -infinity, infinity);
      kernel.FindExtrema(ways, extrema);
      EXPECT_EQ(extrema.Found, all);
      for (int ray = 0; ray < Ways::Count; ++ray)
      {
        double best = 0.0;
        for (const double place : { vertices[ray], 1.0 })
        {
          const bool isLarger = sign * ways.Evaluate(ray, place) > sign * ways.Evaluate(ray, best);
          best = place > 0.0 && place <= 1.0 && isLarger ? place : best;
        }
        EXPECT_NEAR(extrema.Value[ray], sign * ways.Evaluate(ray, best), 1e-12) << kernel.Name;
        EXPECT_NEAR(extrema.T[ray], ways.GetT(ray, best), 1e-7) << kernel.Name;
      }
    }
  }
}

/// Extinction grows with the value, whose range is [2, 3]; one color.
rt::TransferFunction CreateFunction(const glm::dvec3& color, double extinction)
{
  std::vector<glm::dvec4> samples;
  for (int sample = 0; sample <= rt::TransferFunction::Bins; ++sample)
  {
    samples.emplace_back(color, extinction * sample / rt::TransferFunction::Bins);
  }
  return rt::TransferFunction(2.0, 3.0, samples);
}

TEST(Cells, MediaDimAsTheMeanOfPolynomialsTells)
{
  const glm::dvec3 color(0.25, 0.5, 0.75);
  for (const PolynomialKernel& kernel : PolynomialKernel::GetAll())
  {
    for (const double extinction : { 2.0, 60.0 })
    {
      const rt::TransferFunction function = CreateFunction(color, extinction);
      std::mt19937 random(7);
      Ways ways(random);
      rt::Ray rays[rt::MaxRays];
      for (int ray = 0; ray < Ways::Count; ++ray)
      {
        rays[ray].Direction = glm::dvec3(0.0, 0.0, 2.0);
        // Less the begin of the range; linear, or bent.
        const double begin = Draw(random, 0.1, 0.9);
        const double end = Draw(random, 0.1, 0.9);
        const double bend = ray % 2 == 0 ? 0.0 : Draw(random, -0.2, 0.2);
        ways.Coefficients[0][ray] = begin;
        ways.Coefficients[1][ray] = end - begin - bend;
        ways.Coefficients[2][ray] = bend;
      }
      const rt::RayMask all = (rt::RayMask{ 1 } << Ways::Count) - 1;
      rt::MediumLight light;
      light.Begin(rays, all);
      const rt::RayMask ended = kernel.March(ways, function, light);
      for (int ray = 0; ray < Ways::Count; ++ray)
      {
        const double mean = ways.Coefficients[0][ray] + ways.Coefficients[1][ray] / 2.0 +
          ways.Coefficients[2][ray] / 3.0;
        const double expected = std::exp(-2.0 * 0.5 * extinction * mean);
        const double tolerance = ray % 2 == 0 ? 1e-6 : rt::MediumTolerance::Depth;
        // A ray ends once it is dark.
        const bool isDark = (ended >> ray & 1) != 0;
        EXPECT_EQ(isDark, light.Transmittance[ray] < rt::MediumLight::Dark) << kernel.Name << ray;
        EXPECT_NEAR(light.Transmittance[ray], expected, isDark ? rt::MediumLight::Dark : tolerance)
          << kernel.Name << ray;
        for (int channel = 0; channel < 3; ++channel)
        {
          EXPECT_NEAR(
            light.GetColor(ray)[channel], color[channel] * (1.0 - light.Transmittance[ray]), 1e-6)
            << kernel.Name << ray;
        }
        EXPECT_EQ(light.First[ray], ways.Enter[ray]);
      }
      EXPECT_EQ(ended != 0, extinction > 10.0);
    }
  }
}

} // namespace

} // namespace testcells
#endif
