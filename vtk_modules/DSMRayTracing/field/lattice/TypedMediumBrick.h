// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TypedMediumBrick_h
#define rt_TypedMediumBrick_h

#include "DSMBricks/layout/BrickBends.h"
#include "DSMBricks/layout/GridPlanes.h"
#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMCore/base/Block.h"
#include "DSMRayTracing/field/lattice/MacrocellKernel.h"
#include "DSMRayTracing/field/lattice/MediumBrick.h"
#include "DSMRayTracing/field/lattice/RecentBricks.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumShading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace rt
{

/// Memory of a worker for the brick that it is in.
struct MediumBrickMemory
{
  /// See MediumBrick.
  struct Nodes
  {
    std::vector<float> Error;
    std::vector<float> Change;
    std::vector<float> Deep;
    std::vector<float> Glare;
    std::vector<std::uint64_t> SeenCells;
  };
  static constexpr std::size_t DescribedBricks = 1024;

  std::vector<float> Samples;
  RecentBricks<std::vector<float>> Bordered;
  RecentBricks<Nodes> Described;
  std::vector<float> Planes[3];
  std::vector<float> Inverse[3];
  /// Places of the samples of the brick, with one more on each side; null: none.
  const float* WithBorder = nullptr;
  MediumShading Shading;
};

/// A MediumBrick of samples of type T. Keeps references.
template <class T>
class TypedMediumBrick final : public MediumBrick
{
public:
  /// `planes`: of a rectilinear grid, or null; `origin`: the brick's first cell there.
  TypedMediumBrick(dsm::BlockId id, const bricks::VoxelBrick<T>& brick,
    const TransferFunction& function, bool isNearest, const bricks::GridPlanes* planes,
    const double origin[3], const MacrocellKernel& kernel, MediumBrickMemory& memory)
    : Brick(brick)
    , Function(function)
    , Grid(planes)
    , Kernel(kernel)
    , Memory(memory)
  {
    this->Row = brick.GetRow();
    this->Slice = brick.GetSlice();
    this->IsNearest = isNearest;
    this->Mask = brick.GetMask();
    int parts = 1;
    int macrocells = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Cells[axis] = brick.GetCells(axis);
      this->Macrocells[axis] = brick.GetMacrocells(axis);
      this->Parts[axis] = (brick.GetCells(axis) + PartCells - 1) / PartCells;
      parts *= this->Parts[axis];
      macrocells *= this->Macrocells[axis];
      this->First[axis] = static_cast<std::size_t>(origin[axis]);
      this->SetPlanes(axis);
    }
    this->FirstMacrocell = parts;
    memory.Described.SetCount(MediumBrickMemory::DescribedBricks);
    this->Nodes = &memory.Described.Get(id,
      [=](MediumBrickMemory::Nodes& own)
      {
        const auto nodes = static_cast<std::size_t>(parts + macrocells);
        own.Error.assign(nodes, Unknown);
        own.Change.resize(nodes);
        own.Deep.resize(nodes);
        own.Glare.resize(nodes);
        own.SeenCells.resize(static_cast<std::size_t>(macrocells));
      });
    this->Error = this->Nodes->Error.data();
    this->Change = this->Nodes->Change.data();
    this->Deep = this->Nodes->Deep.data();
    this->Glare = this->Nodes->Glare.data();
    this->SeenCells = this->Nodes->SeenCells.data();
    this->SetSamples();
  }

  void Describe(int node) override
  {
    const bool isPart = node < this->FirstMacrocell;
    const int* const counts = isPart ? this->Parts : this->Macrocells;
    const int number = isPart ? node : node - this->FirstMacrocell;
    const std::array<int, 3> place{ number % counts[0], number / counts[0] % counts[1],
      number / (counts[0] * counts[1]) };
    const bricks::MacrocellRange<T> values =
      isPart ? this->FindPartRange(place) : this->Brick.GetMacrocellRanges()[number];
    const auto at = static_cast<std::size_t>(node);
    if (!(values.Min <= values.Max) ||
      !this->Function.IsSeen(static_cast<double>(values.Min), static_cast<double>(values.Max)))
    {
      this->Nodes->Error[at] = Unseen;
      return;
    }
    if (!isPart)
    {
      const std::uint64_t cells = this->FindSeenCells(place, values);
      this->Nodes->SeenCells[static_cast<std::size_t>(number)] = cells;
      if (cells == 0)
      {
        this->Nodes->Error[at] = Unseen;
        return;
      }
    }
    const TransferFunction::Behavior behavior =
      this->Function.FindBehavior(this->Function.GetPlace(static_cast<double>(values.Min)),
        this->Function.GetPlace(static_cast<double>(values.Max)));
    this->Nodes->Change[at] = static_cast<float>(behavior.Change);
    this->Nodes->Deep[at] = static_cast<float>(behavior.Extinction * behavior.Tinge);
    double bend = std::numeric_limits<double>::infinity();
    if (this->IsNearest)
    {
      bend = values.Min < values.Max || this->Mask ? bend : 0.0;
    }
    else if (!this->Grid)
    {
      bend = bricks::GetBend(this->Brick.GetHeader(), isPart, number);
    }
    else if (!isPart && !this->Mask)
    {
      bend = this->FindStretchedBend(place);
    }
    this->Nodes->Error[at] = static_cast<float>(behavior.Change * this->Function.GetScale() * bend);
    // How far normals turn in the node, at most: its second differences beside its first.
    const double range = static_cast<double>(values.Max) - static_cast<double>(values.Min);
    const double edge = isPart ? PartCells : MacrocellCells;
    const double turn = 1.6 * edge * edge * bend / range;
    this->Nodes->Glare[at] =
      static_cast<float>(behavior.Extinction * std::min(1.0, 0.125 * turn * turn));
    if (std::isnan(this->Nodes->Glare[at])) // values are all the same
    {
      this->Nodes->Glare[at] = 0.0f;
    }
    if (std::isnan(this->Nodes->Error[at])) // no change, of a bend that is not known
    {
      this->Nodes->Error[at] = std::numeric_limits<float>::infinity();
    }
  }

private:
  void SetPlanes(int axis)
  {
    this->Planes[axis] = nullptr;
    this->Inverse[axis] = nullptr;
    if (!this->Grid)
    {
      return;
    }
    const double* const places = this->Grid->GetPlaces(axis) + this->First[axis];
    const int pieces = this->IsNearest ? 2 : 1;
    std::vector<float>& own = this->Memory.Planes[axis];
    std::vector<float>& inverse = this->Memory.Inverse[axis];
    own.clear();
    inverse.clear();
    for (int cell = 0; cell < this->Cells[axis]; ++cell)
    {
      const double width = (places[cell + 1] - places[cell]) / pieces;
      for (int piece = 0; piece < pieces; ++piece)
      {
        own.push_back(static_cast<float>(places[cell] - places[0] + piece * width));
        inverse.push_back(width > 0.0 ? static_cast<float>(1.0 / width) : 0.0f);
      }
    }
    own.push_back(static_cast<float>(places[this->Cells[axis]] - places[0]));
    this->Planes[axis] = own.data();
    this->Inverse[axis] = inverse.data();
  }

  void SetSamples()
  {
    const double origin = this->Function.GetOrigin();
    const double scale = this->Function.GetScale();
    if (this->Memory.WithBorder)
    {
      this->Row += 2;
      this->Slice = this->Row * (this->Cells[1] + 3);
      this->SetPlaces(this->Memory.WithBorder + 1 + this->Row + this->Slice);
      return;
    }
    this->Samples = this->Brick.GetSamples();
    this->Subtracted = static_cast<float>(origin);
    this->Scale = static_cast<float>(scale);
    this->Offset = static_cast<float>((static_cast<double>(this->Subtracted) - origin) * scale);
    this->Kind = SampleKind::Float;
    constexpr double largest = 1e30; // far from what a float can hold
    const bool fits = scale < largest && scale > 1.0 / largest && std::abs(origin) < largest;
    if constexpr (std::is_same_v<T, float>)
    {
      if (fits)
      {
        return;
      }
    }
    else if constexpr (std::is_integral_v<T> && sizeof(T) <= 2)
    {
      if (fits)
      {
        this->Kind = sizeof(T) == 1
          ? (std::is_signed_v<T> ? SampleKind::SignedByte : SampleKind::Byte)
          : (std::is_signed_v<T> ? SampleKind::SignedShort : SampleKind::Short);
        return;
      }
    }
    this->Memory.Samples.resize(
      static_cast<std::size_t>(this->Slice) * static_cast<std::size_t>(this->Cells[2] + 1));
    std::transform(this->Brick.GetSamples(), this->Brick.GetSamples() + this->Memory.Samples.size(),
      this->Memory.Samples.begin(),
      [&](T sample) { return static_cast<float>((static_cast<double>(sample) - origin) * scale); });
    this->SetPlaces(this->Memory.Samples.data());
  }
  void SetPlaces(const float* places)
  {
    this->Kind = SampleKind::Float;
    this->Samples = places;
    this->Subtracted = 0.0f;
    this->Scale = 1.0f;
    this->Offset = 0.0f;
  }

  bricks::MacrocellRange<T> FindPartRange(const std::array<int, 3>& part) const
  {
    constexpr int edge = PartCells / MacrocellCells;
    int last[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      last[axis] =
        std::min(edge * (part[static_cast<std::size_t>(axis)] + 1), this->Macrocells[axis]);
    }
    bricks::MacrocellRange<T> all{ std::numeric_limits<T>::max(),
      std::numeric_limits<T>::lowest() };
    for (int z = edge * part[2]; z < last[2]; ++z)
    {
      for (int y = edge * part[1]; y < last[1]; ++y)
      {
        const bricks::MacrocellRange<T>* const row =
          this->Brick.GetMacrocellRanges() + this->Macrocells[0] * (y + this->Macrocells[1] * z);
        for (int x = edge * part[0]; x < last[0]; ++x)
        {
          all.Min = std::min(all.Min, row[x].Min);
          all.Max = std::max(all.Max, row[x].Max);
        }
      }
    }
    return all;
  }

  /// MediumBrick::SeenCells of a macrocell with these values.
  std::uint64_t FindSeenCells(
    const std::array<int, 3>& macrocell, const bricks::MacrocellRange<T>& values) const
  {
    const auto getBin = [&](T value)
    { return this->Function.GetBin(this->Function.GetPlace(static_cast<double>(value))); };
    if (this->Function.AreAllBinsSeen(getBin(values.Min), getBin(values.Max)))
    {
      return ~std::uint64_t{ 0 };
    }
    constexpr int points = MacrocellCells + 1;
    int first[3];
    int counts[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      first[axis] = MacrocellCells * macrocell[static_cast<std::size_t>(axis)];
      counts[axis] = std::min(MacrocellCells, this->Cells[axis] - first[axis]);
    }
    // The bins of edges along x.
    std::int16_t least[points][points][MacrocellCells];
    std::int16_t most[points][points][MacrocellCells];
    for (int z = 0; z <= counts[2]; ++z)
    {
      for (int y = 0; y <= counts[1]; ++y)
      {
        const T* const row =
          this->Brick.GetSamples() + this->Brick.GetOffset(first[0], first[1] + y, first[2] + z);
        auto before = static_cast<std::int16_t>(getBin(row[0]));
        for (int x = 0; x < counts[0]; ++x)
        {
          const auto next = static_cast<std::int16_t>(getBin(row[x + 1]));
          least[z][y][x] = std::min(before, next);
          most[z][y][x] = std::max(before, next);
          before = next;
        }
      }
    }
    std::uint64_t seen = 0;
    for (int z = 0; z < counts[2]; ++z)
    {
      for (int y = 0; y < counts[1]; ++y)
      {
        for (int x = 0; x < counts[0]; ++x)
        {
          const int low = std::min(
            { least[z][y][x], least[z][y + 1][x], least[z + 1][y][x], least[z + 1][y + 1][x] });
          const int high = std::max(
            { most[z][y][x], most[z][y + 1][x], most[z + 1][y][x], most[z + 1][y + 1][x] });
          seen |= std::uint64_t{ this->Function.IsAnyBinSeen(low, high) } << (x + 4 * (y + 4 * z));
        }
      }
    }
    return seen;
  }

  /// How far values along a ray through a rectilinear macrocell may be from a quadratic: trilinear values are an eighth
  /// of how much they bend in a cell from a smooth curve. That curve itself is taken for up to three times as far.
  double FindStretchedBend(const std::array<int, 3>& macrocell) const
  {
    int first[3];
    int counts[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      first[axis] = MacrocellCells * macrocell[static_cast<std::size_t>(axis)];
      counts[axis] = std::min(MacrocellCells, this->Cells[axis] - first[axis]);
    }
    MacrocellSamples samples;
    if (!samples.Set(this->Brick, first, counts))
    {
      return std::numeric_limits<double>::infinity();
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      samples.SetWidths(axis,
        this->Grid->GetInverseWidths(axis) + this->First[axis] +
          static_cast<std::size_t>(first[axis]));
    }
    return 0.5 * this->Kernel.FindRoughness(samples);
  }

  const bricks::VoxelBrick<T>& Brick;
  const TransferFunction& Function;
  const bricks::GridPlanes* Grid;
  const MacrocellKernel& Kernel;
  MediumBrickMemory& Memory;
  MediumBrickMemory::Nodes* Nodes;
  std::size_t First[3]; ///< the brick's first cell
};

} // namespace rt

#endif
