// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_FileCells_h
#define vol_FileCells_h

#include "DSMBricks/build/CellReader.h"
#include "DSMVolumeFiles/cache/FileSamples.h"

#include <memory>
#include <vector>

namespace vol
{

/// Values of cells of an array in a file, of one component or, for the magnitude, of all, read through a cache of
/// chunks, which must outlive it. Any thread.
class FileCells final : public bricks::CellReader
{
public:
  /// `part`: the cells; see FileSamples.
  FileCells(const ArrayStep& of, const FileSamples::Part& part, ChunkCache& cache, bool scattered);

  bricks::Box GetCells() const override { return this->Cells; }
  bricks::Box GetReach() const override { return this->Cells; }
  bool HasMask() const override { return false; }
  void ReadStates(const bricks::Box& cells, std::uint8_t* out) const override;
  int CountComponents() const override { return static_cast<int>(this->Components.size()); }
  bricks::ScalarType GetType() const override { return this->Type; }
  void ReadValues(int component, const bricks::Box& cells, std::byte* out) const override;
  void Combine(std::size_t count, const std::byte* values, std::byte* samples) const override;

private:
  bricks::Box Cells;
  bricks::ScalarType Type;       ///< the array's
  bricks::ScalarType ResultType; ///< of the samples
  bool IsMagnitude;
  std::vector<FileSamples> Components;
};

} // namespace vol

#endif
