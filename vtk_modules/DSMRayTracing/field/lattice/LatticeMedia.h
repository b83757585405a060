// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeMedia_h
#define rt_LatticeMedia_h

#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/LatticePackets.h"
#include "DSMRayTracing/field/lattice/VoxelMedia.h"

#include <cstddef>

namespace rt
{

/// Takes batches of rays through a medium whose values are a lattice's.
template <class Store>
class LatticeMedia : public VoxelMedia<LatticeField, Store>
{
public:
  using VoxelMedia<LatticeField, Store>::VoxelMedia;

  /// See MediumTracer::GetMarchedLook.
  static bool CanShade(const LatticeField& field)
  {
    return !field.Voxels->Planes && !field.Voxels->Lattice.HasCellMask();
  }

  /// See MediumTracer.
  RayMask March(const LatticeField& field, const TransferFunction& function, ObjectBeam* beam,
    const Ray* rays, RayMask wanted, MediumLight& light) const
  {
    return ForEachPacket(field, TransferPredicate(function), this->Kernel,
      static_cast<BeamBricks*>(beam), rays, wanted,
      [&](BeamBricks& bricks, LatticePackets& packets)
      {
        const RayMask all = packets.GetCoarsest().Rays;
        RayMask open = all;
        this->Dispatch(field,
          [&](auto sample)
          {
            for (std::size_t place = 0; place < bricks.Bricks.size() && open != 0; ++place)
            {
              RayMask dark;
              this->template MarchBrick<decltype(sample)>(
                field, function, bricks, place, packets, open, light, dark);
              open &= ~dark;
            }
          });
        return all & ~open;
      });
  }
};

} // namespace rt

#endif
