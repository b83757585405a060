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

  /// For each of `rays` (bits), which is in the macrocell of the part with the number
  /// x + 4 y + 16 z in `macrocells`: its first cell, and in `cells` a bit x + 4 y + 16 z for each
  /// cell of it that has corners on both sides.
  virtual void FindCells(const int part[3], unsigned rays, const std::uint64_t* macrocells,
    int (*first)[3], std::uint64_t* cells) const = 0;

  /// For each of `rays`, which is in a cell that has the number x + 4 y + 16 z in `cells` within the
  /// macrocell from the cell `first` on: the corners less the isovalue, `stride` numbers from one to
  /// the next, those of ray i from `corners` + i on. Returns the rays whose cells hold data.
  virtual unsigned GetCorners(unsigned rays, const int (*first)[3], const std::uint64_t* cells,
    double* corners, int stride) const = 0;

  /// Samples that can be read without asking.
  struct FloatSamples
  {
    const float* First = nullptr; ///< null: ask GetCorners
    double Row = 0.0;             ///< samples to the next one on y, and on z
    double Slice = 0.0;
    double Isovalue = 0.0;
  };
  FloatSamples Floats;

protected:
  ~PacketBrick() = default;
};

} // namespace rt

#endif
