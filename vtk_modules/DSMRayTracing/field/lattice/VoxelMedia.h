// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VoxelMedia_h
#define rt_VoxelMedia_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/lattice/BorderedBrick.h"
#include "DSMRayTracing/field/lattice/TypedMediumBrick.h"
#include "DSMRayTracing/field/lattice/VoxelSearch.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace rt
{

/// Base of what takes batches of rays through a medium whose values are in bricks of voxels.
template <class FieldType, class Store>
class VoxelMedia : public VoxelSearch<FieldType, Store>
{
public:
  using VoxelSearch<FieldType, Store>::VoxelSearch;

  /// See BeamFinder.
  std::unique_ptr<ObjectBeam> FindBeam(
    const FieldType& field, const TransferFunction& function, const Ray corners[4]) const
  {
    return VoxelMedia::FindBricks(field, TransferPredicate(function), corners);
  }

protected:
  /// Takes those of the `open` rays that meet a brick through it, and returns them. `packets`: LatticePackets or
  /// LevelPackets. `dark`: becomes those that are dark then.
  template <class T, class Packets>
  RayMask MarchBrick(const FieldType& field, const TransferFunction& function, BeamBricks& bricks,
    std::size_t place, Packets& packets, RayMask open, MediumLight& light, RayMask& dark) const
  {
    const BeamBricks::Brick& brick = bricks.Bricks[place];
    RayPacket& packet = packets.Get(brick.Id);
    const RayMask meets = this->Kernel.MeetBrick(packet, open, brick.Lower, brick.Upper);
    dark = 0;
    if (meets == 0)
    {
      return 0;
    }
    bricks.Reached = std::max(bricks.Reached, place + 1);
    MediumBrickMemory& memory = *this->Memory;
    memory.WithBorder = nullptr;
    if constexpr (std::is_same_v<typename FieldType::Values, bricks::VoxelField>)
    {
      if (light.Shading)
      {
        memory.WithBorder = BorderedBrick<T>::Get(
          this->Blocks, this->Self, *field.Voxels, brick.Id, function, memory);
      }
    }
    const typename Store::Pin pin =
      this->Blocks.Acquire(this->Self, *field.Voxels->Segment, brick.Id);
    const bricks::VoxelBrick<T> voxels(pin.GetData());
    TypedMediumBrick<T> medium(brick.Id, voxels, function, light.Nearest, packet.Planes,
      brick.Lower, this->Kernel.Macrocells, memory);
    if (light.Shading)
    {
      memory.Shading = *light.Shading;
      memory.Shading.ToNormal = -glm::mat3(glm::transpose(field.GetIndexSpace().GetWorldToIndex()));
      medium.Shading = &memory.Shading;
    }
    dark = this->Kernel.March(packet, meets, medium, brick.Lower, function, light);
    return meets;
  }

private:
  std::unique_ptr<MediumBrickMemory> Memory = std::make_unique<MediumBrickMemory>();
};

} // namespace rt

#endif
