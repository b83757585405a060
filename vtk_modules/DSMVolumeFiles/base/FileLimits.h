// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_FileLimits_h
#define vol_FileLimits_h

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

namespace vol
{

/// Upper bounds for the numbers that a file declares. The readers check every number against one of them, or against
/// what the file can hold, before they compute or allocate with it.
namespace FileLimits
{

constexpr std::uint64_t Samples = 0x7fffffff; ///< along an axis: VTK's indices are int
constexpr std::uint64_t ArrayBytes = std::uint64_t(1) << 62;
constexpr std::uint64_t ChunkBytes = std::uint64_t(4) << 30; ///< HDF5's own limit
constexpr std::uint64_t Components = 1 << 16;                ///< per sample
constexpr std::uint64_t Steps = 1 << 20;                     ///< time steps
constexpr std::uint64_t Arrays = 1 << 16;
constexpr std::uint64_t Objects = 1
  << 17; ///< groups and datasets that are looked at in an HDF5 file
constexpr std::ptrdiff_t GroupDepth = 64; ///< groups within one another that are looked at
constexpr std::uint64_t Axes = 32;        ///< HDF5's own limit
constexpr std::uint64_t Filters = 32;     ///< HDF5's own limit; also codecs of a Zarr array
constexpr std::uint64_t Compressors =
  4; ///< among the filters: each may need more memory than the one before
constexpr std::uint64_t Coordinates = 1
  << 20;                             ///< of samples along an axis, where they are told one by one
constexpr std::uint64_t Levels = 64; ///< levels of detail
constexpr std::uint64_t Chunks = 1 << 26; ///< that are stored, of an array
constexpr std::uint64_t ShardChunks = 1
  << 21; ///< in a shard of a Zarr array, whose index is read whole
constexpr std::uint64_t Sources = 1 << 16;   ///< sources of a virtual dataset
constexpr std::size_t NameBytes = 1 << 12;   ///< length of the name of an array, a path or a link
constexpr std::size_t HeaderBytes = 1 << 20; ///< header of a NRRD or MetaImage file
constexpr std::size_t JsonBytes = 8 << 20;   ///< file of Zarr metadata
constexpr std::size_t JsonValues = 1 << 17;  ///< in it, without its copies of other files
constexpr std::size_t JsonDepth = 64;
constexpr std::uint64_t ZipDirectoryBytes = 1
  << 30; ///< names of members of an archive, and what belongs to them

} // namespace FileLimits

/// Multiplies numbers from a file, none of which is negative. Returns nothing where the product exceeds `most`, which
/// it never wraps around.
template <class Factors = std::initializer_list<std::uint64_t>>
std::optional<std::uint64_t> MultiplyWithin(std::uint64_t most, const Factors& factors)
{
  std::uint64_t product = 1;
  bool isZero = false;
  bool fits = true;
  for (const std::uint64_t factor : factors)
  {
    isZero = isZero || factor == 0;
    fits = fits && factor != 0 && factor <= most / product;
    product = fits ? product * factor : product;
  }
  return isZero ? std::optional<std::uint64_t>(0)
    : fits      ? std::optional<std::uint64_t>(product)
                : std::nullopt;
}

/// Converts a number of a header to an integer. Returns nothing where it is not one, or outside [least, most].
inline std::optional<std::int64_t> ToInteger(double number, std::int64_t least, std::int64_t most)
{
  // A double beyond the range of int64 must not be converted; NaN fails the comparison.
  constexpr double bound = 0x1p62;
  if (!(number > -bound && number < bound))
  {
    return std::nullopt;
  }
  const auto integer = static_cast<std::int64_t>(number);
  return static_cast<double>(integer) == number && integer >= least && integer <= most
    ? std::optional<std::int64_t>(integer)
    : std::nullopt;
}

/// Throws dsm::Error, which names the file and `what` ("time steps"), where `count` exceeds `most`.
inline void CheckLimit(
  const std::string& path, const std::string& what, std::uint64_t count, std::uint64_t most)
{
  if (count > most)
  {
    throw FileError(path,
      "has an invalid header: it declares " + std::to_string(count) + " " + what + "; at most " +
        std::to_string(most) + " are supported.");
  }
}

} // namespace vol

#endif
