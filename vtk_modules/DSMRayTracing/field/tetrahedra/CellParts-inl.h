// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see CellKernel.cxx.
#if defined(rt_CellParts_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_CellParts_inl_h
#undef rt_CellParts_inl_h
#else
#define rt_CellParts_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/cells/MediumPieces-inl.h"
#include "DSMRayTracing/field/tetrahedra/CellKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Takes rays of a medium through tetrahedra: each is a way of MediumPieces. D: vectors of doubles.
template <class D>
class CellParts
{
public:
  /// Keeps references.
  CellParts(const CellPacket& packet, const CellKernel::Runs& runs,
    const TransferFunction& function, MediumLight& light)
    : Packet(packet)
    , Runs(runs)
    , Function(function)
    , Light(light)
    , Pieces(function, light)
  {
  }

  /// See CellKernel::Integrate.
  RayMask Integrate()
  {
    RayMask dark = 0;
    for (int first = 0; first < this->Packet.Count; first += Width)
    {
      dark |= RayMask{ this->IntegrateSome(first) } << first;
    }
    return dark;
  }

private:
  using F = hn::Rebind<float, D>;
  using Vector = hn::Vec<D>;
  using Part = CellKernel::Part;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  /// The lanes from `first` on.
  std::uint32_t IntegrateSome(int first)
  {
    const int lanes = std::min(Width, this->Packet.Count - first);
    std::uint32_t all = 0;
    int most = 0;
    for (int lane = 0; lane < Width; ++lane)
    {
      const int from = first + (lane < lanes ? lane : 0);
      this->Next[lane] = this->Runs.First[from];
      this->Left[lane] = lane < lanes ? this->Runs.Count[from] : 0;
      this->Ray[lane] = static_cast<std::size_t>(this->Packet.Rays[from]);
      this->Origin[lane] = this->Packet.StartT[from];
      this->Scale[lane] = 1.0 / this->Packet.BoxesPerT[from];
      this->Unit[lane] = this->Packet.BoxesPerT[from];
      this->Length[lane] = this->Light.Length[this->Ray[lane]];
      all |= std::uint32_t{ this->Left[lane] > 0 } << lane;
      most = std::max(most, this->Left[lane]);
    }
    if (all == 0)
    {
      return 0;
    }
    this->Pieces.SetRays(this->Ray, all, this->Origin, this->Scale);
    std::uint32_t dark = 0;
    for (int step = 0; step < most && (all & ~dark) != 0; ++step)
    {
      const std::uint32_t there = this->FindThere() & ~dark;
      if (there != 0)
      {
        this->Add(there);
        dark |= GetMaskBits(F(), this->Pieces.FindDark()) & there;
      }
      this->GoOn();
    }
    this->Pieces.PutRays(all);
    return dark;
  }

  std::uint32_t FindThere() const
  {
    std::uint32_t there = 0;
    for (int lane = 0; lane < Width; ++lane)
    {
      there |= std::uint32_t{ this->Left[lane] > 0 } << lane;
    }
    return there;
  }
  void GoOn()
  {
    for (int lane = 0; lane < Width; ++lane)
    {
      const int more = static_cast<int>(this->Left[lane] > 0);
      this->Left[lane] -= more;
      this->Next[lane] += more;
    }
  }

  /// Adds the next part of each lane.
  HWY_INLINE void Add(std::uint32_t there)
  {
    const D tag;
    const F floats;
    std::size_t own[Width];
    for (int lane = 0; lane < Width; ++lane)
    {
      own[lane] = (there >> lane & 1) != 0 ? lane : __builtin_ctz(there);
    }
    const auto load = [&](double Part::*number)
    { return SetLanes<double, Width>([&](int lane) { return this->Next[own[lane]]->*number; }); };
    const Vector enter = load(&Part::Enter);
    const Vector exit = load(&Part::Exit);
    const Vector origin = hn::Load(tag, this->Origin);
    const Vector unit = hn::Load(tag, this->Unit);
    const auto toPlace = [&](Vector value)
    {
      return hn::DemoteTo(floats,
        hn::Mul(hn::Sub(value, hn::Set(tag, this->Function.GetOrigin())),
          hn::Set(tag, this->Function.GetScale())));
    };
    typename MediumPieces<F>::Ways ways;
    ways.First = toPlace(load(&Part::First));
    ways.Last = toPlace(load(&Part::Last));
    ways.Middle = hn::Mul(hn::Set(floats, 0.5f), hn::Add(ways.First, ways.Last));
    ways.Cubic = hn::Zero(floats);
    ways.Length = hn::DemoteTo(floats, hn::Mul(hn::Sub(exit, enter), hn::Load(tag, this->Length)));
    ways.Begin = hn::DemoteTo(floats, hn::Mul(hn::Sub(enter, origin), unit));
    ways.End = hn::DemoteTo(floats, hn::Mul(hn::Sub(exit, origin), unit));
    const TransferFunction::Behavior& worst = this->Function.GetWorstBehavior();
    this->Pieces.Add(ways, GetBitMask(floats, there),
      { hn::Set(floats, static_cast<float>(worst.Change)),
        hn::Set(floats, static_cast<float>(worst.Extinction * worst.Tinge)) });
  }

  const CellPacket& Packet;
  const CellKernel::Runs& Runs;
  const TransferFunction& Function;
  MediumLight& Light;
  MediumPieces<F> Pieces;
  // For each lane:
  const Part* Next[Width];
  int Left[Width]; ///< parts
  std::size_t Ray[Width];
  HWY_ALIGN double Origin[Width];
  HWY_ALIGN double Scale[Width];
  HWY_ALIGN double Unit[Width]; ///< its inverse
  HWY_ALIGN double Length[Width];
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
