// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_PublishedLevels_h
#define tests_PublishedLevels_h

#include "tests/support/LevelModel.h"
#include "tests/support/LoopbackCluster.h"

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMBricks/levels/PublishLevels.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/store/BlockStore.h"

#include <glm/common.hpp>

#include <memory>

/// A model in the bricks of the only rank.
class PublishedLevels
{
public:
  using Index3 = bricks::Index3;

  explicit PublishedLevels(const LevelModel& model)
    : Model(model)
    , Messages(std::move(dsm::LoopbackTransport::CreateGroup(1).front()))
    , Store(this->Messages, {})
  {
    const LevelModelSource source(model);
    const bricks::LevelLattice lattice = bricks::DivideLevels(
      "levels", bricks::LevelScales(model.Scales), model.Type, source, this->Messages);
    this->Levels = bricks::PublishLevels(
      "levels", lattice, source, this->Store, this->Messages, dsm::BlockStore::Place::Memory, 1);
    this->Blocks.resize(lattice.GetBrickCount());
    this->Levels->Segment->ForEachResident(
      [this](dsm::BlockId id, const std::byte* block, std::size_t) { this->Blocks[id] = block; });
  }

  /// The values at the corners of a leaf; false if the bricks do not have it.
  bool GetCorners(int level, const Index3& cell, double corners[8]) const
  {
    return bricks::DispatchSamples(this->Levels->Lattice,
      [&](auto sample)
      {
        const dsm::BlockId id = this->Levels->Lattice.Find(level, cell);
        if (id == bricks::LevelLattice::None)
        {
          return false;
        }
        const bricks::VoxelBrick<decltype(sample)> voxels(this->Blocks[id]);
        const glm::ivec3 at(cell - this->Levels->Lattice.GetBrick(id).Cells.Min);
        for (int corner = 0; corner < 8; ++corner)
        {
          corners[corner] = static_cast<double>(
            voxels.GetSample(at.x + (corner & 1), at.y + (corner >> 1 & 1), at.z + (corner >> 2)));
        }
        return voxels.IsCovered(at.x, at.y, at.z);
      });
  }

  /// The value in the leaf that has a cell of the finest lattice, at a place in cells of that lattice.
  bool GetValue(const Index3& finest, const glm::dvec3& place, double& value) const
  {
    const int level = this->Model.GetLevel(finest);
    double corners[8];
    if (level == LevelModel::Nothing)
    {
      return false;
    }
    const Index3 parts = this->Model.GetParts(level);
    const Index3 cell = finest / parts;
    if (!this->GetCorners(level, cell, corners))
    {
      return false;
    }
    const glm::dvec3 at =
      glm::clamp((place - glm::dvec3(cell * parts)) / glm::dvec3(parts), 0.0, 1.0);
    value = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 weights = glm::mix(1.0 - at, at, side);
      value += weights.x * weights.y * weights.z * corners[corner];
    }
    return std::isfinite(value);
  }

  std::uint64_t CountMasked() const
  {
    std::uint64_t count = 0;
    bricks::DispatchSamples(this->Levels->Lattice,
      [&](auto sample)
      {
        for (dsm::BlockId id = 0; id < this->Blocks.size(); ++id)
        {
          const bricks::VoxelBrick<decltype(sample)> voxels(this->Blocks[id]);
          const bricks::LevelBrick& brick = this->Levels->Lattice.GetBrick(id);
          bricks::ForEachIndex({ Index3(0), brick.Cells.GetSize() },
            [&](const Index3& cell)
            {
              const glm::ivec3 at(cell);
              count += voxels.IsCovered(at.x, at.y, at.z) ? 1 : 0;
            });
        }
      });
    return count;
  }

  const LevelModel& Model;
  dsm::Messenger Messages;
  dsm::BlockStore Store;
  std::shared_ptr<bricks::LevelVoxels> Levels;

private:
  std::vector<const std::byte*> Blocks;
};

#endif
