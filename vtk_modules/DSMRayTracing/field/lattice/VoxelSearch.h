// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VoxelSearch_h
#define rt_VoxelSearch_h

#include "DSMBricks/layout/VoxelField.h"
#include "DSMBricks/levels/LevelLattice.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/ray/Ray.h"

#include <cstddef>
#include <memory>
#include <type_traits>

namespace rt
{

/// Base of what searches a field's bricks of voxels, which are those of a lattice or of levels, for batches of
/// rays. A ray's result does not depend on its packet. Threads and pins as IsosurfaceSearch.
template <class FieldType, class Store>
class VoxelSearch
{
public:
  VoxelSearch(Store& store, typename Store::Worker& worker,
    const PacketKernel& kernel = PacketKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Kernel(kernel)
  {
  }

  /// See BeamFinder.
  bool Prefetch(const FieldType& field, const ObjectBeam& beam, std::size_t count) const
  {
    return PrefetchFirst(this->Blocks, *field.Voxels->Segment, beam, count);
  }

protected:
  /// The bricks with values that satisfy `mayHold`, for BeamFinder.
  template <class Predicate>
  static std::unique_ptr<ObjectBeam> FindBricks(
    const FieldType& field, const Predicate& mayHold, const Ray corners[4])
  {
    return std::make_unique<BeamBricks>(FindBeamBricks(field, mayHold, corners));
  }

  /// Calls `function(T{})` with the C++ type of the samples.
  template <class Function>
  static void Dispatch(const FieldType& field, const Function& function)
  {
    if constexpr (std::is_same_v<typename FieldType::Values, bricks::VoxelField>)
    {
      bricks::Dispatch(field.Voxels->Lattice.GetScalarType(), function);
    }
    else
    {
      bricks::DispatchSamples(field.Voxels->Lattice, function);
    }
  }

  Store& Blocks;
  typename Store::Worker& Self;
  const PacketKernel& Kernel;
};

} // namespace rt

#endif
