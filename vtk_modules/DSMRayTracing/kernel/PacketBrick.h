// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PacketBrick_h
#define rt_PacketBrick_h

#include <cstdint>

namespace rt
{

/// What a packet asks of a brick and an isovalue, whatever the type of the samples. Coordinates are
/// the brick's.
class PacketBrick
{
public:
  virtual int GetMacrocells(int axis) const = 0;

  /// Bit x + 4 y + 16 z is set where the macrocell 4 part + (x, y, z) may hold the surface.
  virtual std::uint64_t FindMacrocells(const int part[3]) const = 0;

  /// Bit x + 4 y + 16 z is set where the cell (x, y, z) of the macrocell with the given first cell
  /// has corners on both sides.
  virtual std::uint64_t FindCells(const int first[3]) const = 0;

  /// Whether the cell holds data, and where it does its corners less the isovalue: `stride` numbers
  /// from one to the next.
  virtual bool GetCorners(const int cell[3], double* corners, int stride) const = 0;

protected:
  ~PacketBrick() = default;
};

} // namespace rt

#endif
