// SPDX-License-Identifier: BSD-3-Clause
#ifndef FunctionVolume_h
#define FunctionVolume_h

#include "DSMBricks/build/PublishVolume.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/scene/Scene.h"

#include <cstring>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

/// A volume of doubles that samples a function of the world position over [-1, 1]^3.
class FunctionVolume final : public bricks::VoxelSource
{
public:
  using Function = std::function<double(const glm::dvec3&)>;

  FunctionVolume(std::int64_t points, Function function)
    : Points(points)
    , Evaluate(std::move(function))
  {
  }

  bricks::Box GetCells() const override
  {
    return { bricks::Index3(0), bricks::Index3(this->Points - 1) };
  }

  void ReadSamples(const bricks::Box& points, std::byte* out) const override
  {
    for (auto k = points.Min.z; k < points.Max.z; ++k)
    {
      for (auto j = points.Min.y; j < points.Max.y; ++j)
      {
        for (auto i = points.Min.x; i < points.Max.x; ++i)
        {
          const double value =
            this->Evaluate(glm::dvec3(GetIndexToWorld(this->Points) * glm::dvec4(i, j, k, 1.0)));
          std::memcpy(out, &value, sizeof(value));
          out += sizeof(value);
        }
      }
    }
  }

  static glm::dmat4 GetIndexToWorld(std::int64_t points)
  {
    const double spacing = 2.0 / static_cast<double>(points - 1);
    glm::dmat4 matrix(1.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      matrix[axis][axis] = spacing;
      matrix[3][axis] = -1.0;
    }
    return matrix;
  }

  /// The function's surface at zero. Collective; the first rank has all of it.
  static rt::LatticeIsosurface Publish(
    std::int64_t points, Function function, dsm::Messenger& messenger, dsm::BlockStore& store)
  {
    const bricks::BrickLattice lattice(
      bricks::Index3(points), bricks::ScalarType::Float64, false, 16);
    rt::LatticeIsosurface object;
    std::vector<std::shared_ptr<const bricks::VoxelSource>> pieces;
    if (messenger.GetRank() == 0)
    {
      pieces.push_back(std::make_shared<FunctionVolume>(points, std::move(function)));
    }
    object.Field.Voxels = bricks::PublishVolume("function", lattice, pieces, store, messenger);
    object.Field.SetIndexToWorld(GetIndexToWorld(points));
    object.Isovalues = { 0.0 };
    return object;
  }

private:
  std::int64_t Points;
  Function Evaluate;
};

#endif
