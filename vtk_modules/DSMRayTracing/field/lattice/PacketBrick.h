// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PacketBrick_h
#define rt_PacketBrick_h

#include <cstdint>

namespace rt
{

/// Data about 4 x 4 x 4 macrocells of a brick. Bit (or index) x + 4 y + 16 z stands for a macrocell
/// of the part, or for a cell of the macrocell, counted in the order of NodeOrder.
struct PacketPart
{
  std::uint64_t Macrocells; ///< those that may hold the surface
  std::uint64_t Known;      ///< those of which Cells tells something
  std::uint64_t Cells[64];  ///< for each macrocell: its cells that have corners on both sides
  ///@{
  /// For media: TransferFunction::Behavior in each macrocell.
  double Extinction[64];
  double Change[64];
  double Tinge[64];
  ///@}
  /// Those of Known in which values bend so little that rays may go through them as a whole; see TransferTest.
  std::uint64_t Smooth;
};

/// Queries of a packet about a brick and an isovalue, independent of the type of the samples.
/// Coordinates are brick indices.
class PacketBrick
{
public:
  virtual int GetMacrocells(int axis) const = 0;
  virtual int GetCells(int axis) const = 0;

  /// The macrocells from 4 part on. Valid until the next call.
  virtual const PacketPart& FindPart(const int part[3]) const = 0;

  /// Adds the cells of a macrocell of the part that FindPart was last called for.
  virtual void FindCells(const int part[3], int macrocell) const = 0;

  /// For each of `rays`, which is in the cell with the coordinates cell[axis * stride + ray]: the
  /// corners less the isovalue, `stride` numbers from one to the next, those of a ray from
  /// `corners` + ray on. Returns the rays whose cells hold data.
  virtual unsigned GetCorners(
    unsigned rays, const double* cell, double* corners, int stride) const = 0;

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
