// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelMedia_h
#define rt_LevelMedia_h

#include "DSMRayTracing/field/lattice/VoxelMedia.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/field/levels/LevelPackets.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace rt
{

/// Takes batches of rays through a medium whose values are those of levels. Bricks of different levels may lie
/// around one another, so the pieces that a ray meets before the next brick are put in order.
template <class Store>
class LevelMedia : public VoxelMedia<LevelField, Store>
{
public:
  LevelMedia(Store& store, typename Store::Worker& worker)
    : VoxelMedia<LevelField, Store>(store, worker)
    , Unsorted(std::make_unique<MediumLight>())
  {
  }

  /// See MediumTracer::GetMarchedLook.
  static bool CanShade(const LevelField&) { return false; }

  /// See MediumTracer.
  RayMask March(const LevelField& field, const TransferFunction& function, ObjectBeam* beam,
    const Ray* rays, RayMask wanted, MediumLight& light) const
  {
    MediumLight& all = *this->Unsorted;
    all.Begin(rays, wanted);
    all.SetSpace(rays, wanted, light.WorldToSpace);
    all.KeepsPieces = true;
    all.ErrorFactor = light.ErrorFactor;
    all.IsExact = light.IsExact;
    all.DarkBelow = light.DarkBelow;
    all.HasLateExtinction = light.HasLateExtinction;
    all.KeepsValues = light.KeepsValues;
    // Pieces are joined when they are in order.
    ForEachRay(
      wanted, [&](int ray) { all.FirstPiece[ray] = std::numeric_limits<std::size_t>::max(); });
    return ForEachPacket(field, TransferPredicate(function), this->Kernel,
      static_cast<BeamBricks*>(beam), rays, wanted,
      [&](BeamBricks& bricks, LevelPackets& packets)
      { return this->MarchPacket(field, function, bricks, packets, light); });
  }

private:
  /// The rays that meet a brick, and the T from which on each of them may meet those behind it.
  struct Visit
  {
    RayMask Meets;
    double Next[RayPacket::Size];
  };

  /// Finds which rays meet the bricks, and in what order.
  std::vector<Visit> FindVisits(const BeamBricks& bricks, LevelPackets& packets) const
  {
    std::vector<Visit> visits(bricks.Bricks.size());
    double next[RayPacket::Size];
    std::fill_n(next, RayPacket::Size, std::numeric_limits<double>::infinity());
    for (std::size_t place = visits.size(); place-- > 0;)
    {
      const BeamBricks::Brick& brick = bricks.Bricks[place];
      RayPacket& packet = packets.Get(brick.Id);
      std::copy_n(next, RayPacket::Size, visits[place].Next);
      visits[place].Meets = this->Kernel.MeetBrick(packet, packet.Rays, brick.Lower, brick.Upper);
      ForEachRay(visits[place].Meets,
        [&](int ray) { next[ray] = std::min(next[ray], packet.BrickEnter[ray]); });
    }
    return visits;
  }

  /// Returns the rays that are dark.
  RayMask MarchPacket(const LevelField& field, const TransferFunction& function, BeamBricks& bricks,
    LevelPackets& packets, MediumLight& light) const
  {
    MediumLight& all = *this->Unsorted;
    const bricks::LevelLattice& lattice = field.Voxels->Lattice;
    const bricks::LevelScales& scales = lattice.GetScales();
    const double finest = scales.GetSize(scales.GetCount() - 1);
    const std::vector<Visit> visits = this->FindVisits(bricks, packets);
    RayMask open = packets.GetCoarsest().Rays;
    this->Dispatch(field,
      [&](auto sample)
      {
        for (std::size_t place = 0; place < visits.size() && open != 0; ++place)
        {
          if ((visits[place].Meets & open) == 0)
          {
            continue;
          }
          const int level = lattice.GetBrick(bricks.Bricks[place].Id).Level;
          all.JoinedLength = light.JoinedLength * scales.GetSize(level) / finest;
          // All that has been taken is before this brick. More may be, in bricks that begin behind it.
          all.ClearSums(visits[place].Meets);
          ForEachRay(visits[place].Meets,
            [&](int ray) { all.Transmittance[ray] = light.Transmittance[ray]; });
          RayMask none;
          const RayMask meets = this->template MarchBrick<decltype(sample)>(
            field, function, bricks, place, packets, open, all, none);
          open &= ~FindRays(meets,
            [&](int ray)
            { return TakePieces(all.Pieces[ray], visits[place].Next[ray], ray, light); });
        }
      });
    return packets.GetCoarsest().Rays & ~open;
  }

  /// Moves the pieces that begin before `end`, in order, to the light of a ray; returns whether it is dark then.
  static bool TakePieces(std::vector<MediumPiece>& pieces, double end, int ray, MediumLight& light)
  {
    std::sort(pieces.begin(), pieces.end(),
      [](const MediumPiece& one, const MediumPiece& other) { return one.Begin < other.Begin; });
    auto piece = pieces.begin();
    for (; piece != pieces.end() && piece->Begin < end && !light.IsDark(ray); ++piece)
    {
      light.Add(ray, *piece);
    }
    pieces.erase(pieces.begin(), piece);
    return light.IsDark(ray);
  }

  std::unique_ptr<MediumLight> Unsorted; ///< during March; kept for its memory
};

} // namespace rt

#endif
