// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumBrick_h
#define rt_MediumBrick_h

#include <cstdint>

namespace rt
{

struct MediumShading;

/// A brick of voxels as rays see it that pass through a medium: samples, and what is known of the nodes of the brick:
/// macrocells, and parts of 4 x 4 x 4 of them. For one thread.
///
/// Where values are those of the nearest sample, all coordinates are those of half cells, in each of which the value
/// is the same everywhere.
class MediumBrick
{
public:
  static constexpr int MacrocellCells = 4; ///< along an edge
  static constexpr int PartCells = 16;

  enum class SampleKind
  {
    Float,
    SignedByte,
    Byte,
    SignedShort,
    Short
  };
  SampleKind Kind;
  const void* Samples;
  int Row; ///< samples to the next one on y, and on z
  int Slice;
  /// The place of a sample in the function: (sample - Subtracted) * Scale + Offset.
  float Subtracted;
  float Scale;
  float Offset;
  int Cells[3];
  const std::uint8_t* Mask; ///< cells that hold data, see VoxelBrickHeader; null: all
  bool IsNearest;
  /// In a rectilinear grid: places of planes on each axis from the brick's first one on, and reciprocals of the widths
  /// between them; of half cells where values are those of the nearest sample. Null: 0, 1, 2 ...
  const float* Planes[3];
  const float* Inverse[3];

  /// Null: not shaded. Else samples are floats, with one more around the brick on each side.
  const MediumShading* Shading = nullptr;

  ///@{
  /// Of nodes, first those of parts, then those of macrocells, each x fastest.
  int Parts[3]; ///< in each direction
  int Macrocells[3];
  int FirstMacrocell;
  /// The error of the optical depth of a unit of length, if a ray goes through the node in one step, and values along
  /// it are taken for quadratic. Infinite: cells may hold no data. Unseen: no value of the node is visible. Unknown:
  /// Describe was not called for the node.
  const float* Error;
  static constexpr float Unseen = -1.0f;
  static constexpr float Unknown = -2.0f;
  const float* Change; ///< TransferFunction::Behavior
  const float* Deep;   ///< Extinction times Tinge
  /// Error of the light of a unit of length, if a ray through the node is shaded at one place.
  const float* Glare;
  ///@}
  /// For each macrocell that is seen: bit x + 4 y + 16 z is set where a value of that cell may be visible.
  const std::uint64_t* SeenCells;

  virtual void Describe(int node) = 0;

protected:
  ~MediumBrick() = default;
};

} // namespace rt

#endif
