// SPDX-License-Identifier: BSD-3-Clause
// The values at the corners of all leaves, compared with what the plainest way finds.
#include "tests/unit/raytracing/PublishedLevels.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <limits>
#include <map>
#include <tuple>

namespace
{

using bricks::Index3;

/// The function of a model as LevelNodes describes it, node by node.
class Reference
{
public:
  explicit Reference(const LevelModel& model)
    : Model(model)
  {
    model.ForEachLeaf(
      [&](int level, const Index3& cell)
      {
        const double value = model.OfPoints ? 0.0 : model.GetValue(level, cell);
        if (std::isfinite(value))
        {
          this->Limits = { std::min(this->Limits[0], value), std::max(this->Limits[1], value) };
        }
      });
  }

  /// The value at a point of the finest lattice.
  double GetNode(const Index3& point)
  {
    const auto key = std::make_tuple(point.x, point.y, point.z);
    const auto known = this->Nodes.find(key);
    if (known != this->Nodes.end())
    {
      return known->second;
    }
    const Around around = this->LookAround(point);
    const Index3 parts = this->Model.GetParts(around.Coarsest);
    double value = this->Round(this->FindInside(point));
    if (!this->Model.OfPoints && point % parts == Index3(0) && around.Inward != Index3(0))
    {
      const Index3 next = point + around.Inward * parts;
      // Corners of larger leaves have the value of those, on the border, too.
      const bool isOfLarger = this->LookAround(next).Coarsest < around.Coarsest;
      const double inside = isOfLarger ? this->GetNode(next) : this->Round(this->FindInside(next));
      const double exact = value + (value - inside) / (2.0 * around.Weights / around.Count - 1.0);
      value = std::isfinite(exact)
        ? this->Round(std::clamp(exact, this->Limits[0], this->Limits[1]))
        : value;
    }
    return this->Nodes[key] = value;
  }

private:
  /// What fills the octants of a point.
  struct Around
  {
    int Coarsest = 127;
    int Finest = -1;
    Index3 OfCoarsest{ 0 };
    Index3 Inward{ 0 }; ///< from where nothing is
    double Weights = 0.0;
    double Count = 0.0;
  };
  Around LookAround(const Index3& point) const
  {
    Around around;
    Index3 least(1);
    Index3 most(-1);
    bricks::ForEachIndex({ point - Index3(1), point + Index3(1) },
      [&](const Index3& octant)
      {
        const int level = this->Model.GetLevel(octant);
        if (level == LevelModel::Nothing)
        {
          return;
        }
        if (level < around.Coarsest)
        {
          around.Coarsest = level;
          around.OfCoarsest = octant;
        }
        around.Finest = std::max(around.Finest, level);
        around.Weights += static_cast<double>(this->Model.Scales[level].x);
        around.Count += 1.0;
        const Index3 side = (octant - point) * std::int64_t{ 2 } + Index3(1);
        least = glm::min(least, side);
        most = glm::max(most, side);
      });
    around.Inward = (least + most) / std::int64_t{ 2 };
    around.Weights /= static_cast<double>(this->Model.Scales[around.Coarsest].x);
    return around;
  }
  double Round(double value) const
  {
    return this->Model.Type == bricks::ScalarType::Float32 ? static_cast<float>(value) : value;
  }

  /// Without what is at the border.
  double FindInside(const Index3& point)
  {
    const auto [coarsest, finest, ofCoarsest, inward, all, count] = this->LookAround(point);
    const Index3 parts = this->Model.GetParts(coarsest);
    if (point % parts != Index3(0))
    {
      const Index3 leaf = ofCoarsest / parts;
      const glm::dvec3 at = glm::dvec3(point - leaf * parts) / glm::dvec3(parts);
      double value = 0.0;
      for (int corner = 0; corner < 8; ++corner)
      {
        const Index3 side(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 weights = glm::mix(1.0 - at, at, glm::dvec3(side));
        value += weights.x * weights.y * weights.z * this->GetNode((leaf + side) * parts);
      }
      return value;
    }
    if (this->Model.OfPoints)
    {
      return this->Model.GetValue(finest, point / this->Model.GetParts(finest));
    }
    double sum = 0.0;
    double weights = 0.0;
    bricks::ForEachIndex({ point - Index3(1), point + Index3(1) },
      [&](const Index3& octant)
      {
        const int level = this->Model.GetLevel(octant);
        if (level != LevelModel::Nothing)
        {
          const double weight = static_cast<double>(this->Model.Scales[level].x);
          sum += weight * this->Model.GetValue(level, octant / this->Model.GetParts(level));
          weights += weight;
        }
      });
    return sum / weights;
  }

  const LevelModel& Model;
  std::array<double, 2> Limits{ std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity() };
  std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, double> Nodes;
};

/// Of samples near 1; in double precision, of the sums, too, here and there.
double GetRounding(bricks::ScalarType type)
{
  return type == bricks::ScalarType::Float32 ? std::numeric_limits<float>::epsilon()
                                             : 8.0 * std::numeric_limits<double>::epsilon();
}

double GetNoise(int level, const glm::dvec3& place)
{
  const double wave = std::sin(dot(place, glm::dvec3(127.1, 311.7, 74.7)) + level) * 43758.5453;
  return wave - std::floor(wave) - 0.5;
}

/// All leaves are in bricks, and have the reference's values at their corners.
void CompareNodes(const LevelModel& model, double largest)
{
  PublishedLevels published(model);
  Reference reference(model);
  std::uint64_t count = 0;
  model.ForEachLeaf(
    [&](int level, const Index3& cell)
    {
      ++count;
      double corners[8];
      ASSERT_TRUE(published.GetCorners(level, cell, corners)) << "level " << level;
      for (int corner = 0; corner < 8 && !testing::Test::HasFailure(); ++corner)
      {
        const Index3 point = cell + Index3(corner & 1, corner >> 1 & 1, corner >> 2);
        const double expected = reference.GetNode(point * model.GetParts(level));
        if (std::isnan(expected))
        {
          EXPECT_TRUE(std::isnan(corners[corner]));
          continue;
        }
        // At the border, the difference of two rounded numbers counts.
        EXPECT_NEAR(corners[corner], expected, 3.0 * largest * GetRounding(model.Type))
          << "level " << level << ", point " << point.x << " " << point.y << " " << point.z;
      }
    });
  EXPECT_EQ(published.Levels->Lattice.CountLeaves(), count);
  EXPECT_EQ(published.CountMasked(), count);
}

/// Wherever leaves touch, both have the same value there.
void CompareSides(const LevelModel& model, double largest)
{
  PublishedLevels published(model);
  model.ForEachLeaf(
    [&](int level, const Index3& cell)
    {
      double corners[8];
      ASSERT_TRUE(published.GetCorners(level, cell, corners));
      for (int corner = 0; corner < 8; ++corner)
      {
        const Index3 point =
          (cell + Index3(corner & 1, corner >> 1 & 1, corner >> 2)) * model.GetParts(level);
        bricks::ForEachIndex({ point - Index3(1), point + Index3(1) },
          [&](const Index3& octant)
          {
            double value;
            if (!testing::Test::HasFailure() &&
              published.GetValue(octant, glm::dvec3(point), value))
            {
              ASSERT_NEAR(corners[corner], value, largest * GetRounding(model.Type))
                << "level " << level;
            }
          });
      }
    });
}

} // namespace

TEST(LevelNodes, EqualTheReference)
{
  for (unsigned seed = 0; seed < 24; ++seed)
  {
    SCOPED_TRACE(seed);
    LevelModel model = CreateRandomLevels(seed, seed % 2 == 1);
    model.OfPoints = seed % 4 >= 2;
    model.Type = seed % 5 == 0 ? bricks::ScalarType::Float64 : bricks::ScalarType::Float32;
    const double offset = seed % 7 == 3 ? 1e5 : 0.0;
    model.Function = [&](int level, const glm::dvec3& place)
    { return offset + GetNoise(level, place); };
    CompareNodes(model, offset + 0.5);
    CompareSides(model, offset + 0.5);
    // Cells without a number leave the others alone.
    model.Function = [&](int level, const glm::dvec3& place)
    {
      const double value = GetNoise(level, place);
      return value > 0.48 ? std::numeric_limits<double>::quiet_NaN() : value;
    };
    CompareNodes(model, 0.5);
    if (testing::Test::HasFailure())
    {
      return;
    }
  }
}

TEST(LevelNodes, KeepLinearFunctions)
{
  const glm::dvec3 gradient(0.3, -0.7, 1.9);
  for (unsigned seed = 0; seed < 24; ++seed)
  {
    SCOPED_TRACE(seed);
    LevelModel model = CreateRandomLevels(seed, false);
    model.OfPoints = seed % 4 >= 2;
    model.Type = bricks::ScalarType::Float64;
    model.Function = [&](int, const glm::dvec3& place) { return 1.0 + dot(place, gradient); };
    // Values stay within those of the cells, so in two corners the function is another one.
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    model.ForEachLeaf(
      [&](int level, const Index3& cell)
      {
        least = std::min(least, model.GetValue(level, cell));
        most = std::max(most, model.GetValue(level, cell));
      });
    const double inACell = dot(abs(gradient), glm::dvec3(1.0));
    PublishedLevels published(model);
    model.ForEachLeaf(
      [&](int level, const Index3& cell)
      {
        double corners[8];
        ASSERT_TRUE(published.GetCorners(level, cell, corners));
        for (int corner = 0; corner < 8; ++corner)
        {
          const Index3 point = cell + Index3(corner & 1, corner >> 1 & 1, corner >> 2);
          const glm::dvec3 place = glm::dvec3(point) / glm::dvec3(model.Scales[level]);
          const double expected = model.Function(level, place);
          if (model.OfPoints || (expected > least + inACell && expected < most - inACell))
          {
            ASSERT_NEAR(corners[corner], expected, 1e-13);
          }
          ASSERT_TRUE(model.OfPoints || (corners[corner] >= least && corners[corner] <= most));
        }
      });
  }
}

TEST(LevelNodes, BlocksOfOneLevelThatOverlapAreRefused)
{
  const LevelModel model(Index3(4), { Index3(1) });
  const LevelModelSource source(model);
  std::vector<bricks::LevelCube> cubes = source.GetCubes();
  cubes.push_back(cubes.front());
  EXPECT_THROW(
    bricks::LevelLattice(bricks::LevelScales(model.Scales), cubes, model.Type), dsm::Error);
}
