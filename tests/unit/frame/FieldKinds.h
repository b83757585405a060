// SPDX-License-Identifier: BSD-3-Clause
#ifndef FieldKinds_h
#define FieldKinds_h

#include "tests/support/FunctionVolume.h"
#include "tests/support/LevelModel.h"
#include "tests/support/QuadraticField.h"

#include "DSMBricks/levels/PublishLevels.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/scene/OtherKindDescription.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/slice/SliceTracer.h"
#include "DSMRayTracing/surface/IsosurfaceTracer.h"

#include <cstdint>
#include <memory>
#include <type_traits>

namespace FieldKinds
{

/// A kind of field in tests: how values are made of a function. Collective.
struct Functions
{
  using FieldType = QuadraticField;
  static constexpr bool IsExact = true;

  static std::shared_ptr<const Quadratic> Publish(
    const Quadratic& function, dsm::Messenger&, dsm::BlockStore&)
  {
    return std::make_shared<const Quadratic>(function);
  }
  static FieldType Create(const std::shared_ptr<const Quadratic>& values)
  {
    FieldType field;
    field.Function = values;
    return field;
  }
};

struct Lattices
{
  using FieldType = rt::LatticeField;
  static constexpr bool IsExact = false;

  static std::shared_ptr<const bricks::VoxelField> Publish(
    const Quadratic& function, dsm::Messenger& messenger, dsm::BlockStore& store)
  {
    return FunctionVolume::Publish(
      Points, [&](const glm::dvec3& p) { return function.Evaluate(p); }, messenger, store)
      .Field.Voxels;
  }
  static FieldType Create(const std::shared_ptr<const bricks::VoxelField>& values)
  {
    FieldType field;
    field.Voxels = values;
    field.SetIndexToWorld(FunctionVolume::GetIndexToWorld(Points));
    return field;
  }

private:
  static constexpr std::int64_t Points = 33;
};

struct Levels
{
  using FieldType = rt::LevelField;
  static constexpr bool IsExact = false;

  /// Cells of level 1, and of level 2 in a part of the box; the ranks have leaves in turn.
  static std::shared_ptr<const bricks::LevelVoxels> Publish(
    const Quadratic& function, dsm::Messenger& messenger, dsm::BlockStore& store)
  {
    using bricks::Index3;
    LevelModel model(Index3(Roots), { Index3(1), Index3(2), Index3(4) });
    model.OfPoints = true;
    model.Type = bricks::ScalarType::Float64;
    model.Function = [&](int, const glm::dvec3& place)
    { return function.Evaluate(place * (2.0 / Roots) - 1.0); };
    model.ReplaceIn(0, { Index3(0), Index3(Roots) }, 1);
    model.ReplaceIn(1, { Index3(3, 2, 5), Index3(13, 9, 12) }, 2);
    const LevelModelSource source(model,
      [&](int, const Index3& cell)
      { return (cell.x + cell.z) / 3 % messenger.GetSize() == messenger.GetRank(); });
    const bricks::LevelLattice lattice = bricks::DivideLevels(
      "levels", bricks::LevelScales(model.Scales), model.Type, source, messenger);
    return bricks::PublishLevels(
      "levels", lattice, source, store, messenger, dsm::BlockStore::Place::Memory, 1);
  }
  static FieldType Create(const std::shared_ptr<const bricks::LevelVoxels>& values)
  {
    FieldType field;
    field.Voxels = values;
    field.SetIndexToWorld(FunctionVolume::GetIndexToWorld(Roots + 1));
    return field;
  }

private:
  static constexpr std::int64_t Roots = 8;
};

/// An object or a medium of a scene, whether its kind is in the list or not.
template <class Kind>
rt::SceneObject GetObject(const Kind& kind)
{
  if constexpr (std::is_constructible_v<rt::SceneObject, Kind>)
  {
    return kind;
  }
  else
  {
    return rt::CreateOtherObject(kind);
  }
}
template <class Kind>
rt::SceneMedium GetMedium(const Kind& kind)
{
  if constexpr (std::is_constructible_v<rt::SceneMedium, Kind>)
  {
    return kind;
  }
  else
  {
    return rt::CreateOtherMedium(kind);
  }
}

} // namespace FieldKinds

#endif
