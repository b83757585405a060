// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ValueOrigin_h
#define vol_ValueOrigin_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vol
{

/// Origin of the values of a brick file. Each rank can provide some of them.
class ValueOrigin
{
public:
  virtual ~ValueOrigin() = default;

  /// The same on every rank, as all but Read.
  virtual const FileGeometry& GetGeometry() const = 0;
  /// Only the samples of their grids matter; the file chooses its own chunks.
  virtual const std::vector<FileArray>& GetArrays() const = 0;
  /// Identifies the values, for a later process.
  virtual std::string Describe() const = 0;

  /// Collective. The rank that each of these boxes of an array's samples is dealt to. Throws the same dsm::Error on
  /// every rank.
  virtual std::vector<int> Deal(std::size_t array, const std::vector<bricks::Box>& boxes) = 0;
  /// Any thread: the samples of one of the boxes that were dealt last, to this rank; dense, x fastest, the
  /// components of a sample together. Throws dsm::Error.
  virtual void Read(std::size_t array, const bricks::Box& box, std::byte* out) const = 0;
};

} // namespace vol

#endif
