// SPDX-License-Identifier: BSD-3-Clause
#ifndef FieldKinds_h
#define FieldKinds_h

#include "tests/support/FunctionVolume.h"
#include "tests/support/LevelModel.h"
#include "tests/support/PublishedCells.h"
#include "tests/support/QuadraticField.h"

#include "DSMBricks/levels/PublishLevels.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/scene/OtherKindDescription.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/slice/SliceTracer.h"
#include "DSMRayTracing/surface/IsosurfaceTracer.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

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

/// Cells of all kinds, or one curvilinear grid; the ranks have cells in turn.
template <bool IsGrid>
struct Cells
{
  using FieldType = rt::CellField;
  static constexpr bool IsExact = false;

  static std::shared_ptr<const bricks::CellValues> Publish(
    const Quadratic& function, dsm::Messenger& messenger, dsm::BlockStore& store)
  {
    using bricks::Index3;
    CellModel::Settings settings;
    settings.Boxes = Index3(Edge);
    settings.IsGrid = IsGrid;
    settings.Move = [](const glm::dvec3& place) { return Move(place); };
    settings.KindOf = [](const Index3& box)
    { return static_cast<CellModel::Kind>((box.x / 3 + box.y / 5 + box.z / 4) % 4); };
    settings.IsOwn = [&](const Index3& box)
    { return (box.x + box.z) / 3 % messenger.GetSize() == messenger.GetRank(); };
    return PublishCellModel(
      CellModel(std::move(settings)), [&](const glm::dvec3& p) { return function.Evaluate(p); },
      messenger, store);
  }
  static FieldType Create(const std::shared_ptr<const bricks::CellValues>& values)
  {
    FieldType field;
    field.Voxels = values;
    return field;
  }

private:
  /// Cells are as long as the quadratic field's detail.
  static constexpr std::int64_t Edge = 32;

  /// From [0, 1]^3 to [-1, 1]^3, bent inside.
  static glm::dvec3 Move(const glm::dvec3& place)
  {
    const glm::dvec3 inside = place * (1.0 - place);
    const double bend = inside.x * inside.y * inside.z;
    return 2.0 * place - 1.0 +
      bend * glm::dvec3(2.0 * std::sin(7.0 * place.y), 1.5, std::cos(5.0 * place.x));
  }
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
