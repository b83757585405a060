// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ValueRanges_h
#define vol_ValueRanges_h

#include "DSMVolumeFiles/format/ArrayStep.h"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace vol
{

/// Least and greatest of some values; Least is above Greatest where there are none.
struct ValueRange
{
  double Least = std::numeric_limits<double>::max();
  double Greatest = std::numeric_limits<double>::lowest();

  void Add(double value)
  {
    this->Least = value < this->Least ? value : this->Least;
    this->Greatest = value > this->Greatest ? value : this->Greatest;
  }
  void Add(const ValueRange& other)
  {
    this->Least = other.Least < this->Least ? other.Least : this->Least;
    this->Greatest = other.Greatest > this->Greatest ? other.Greatest : this->Greatest;
  }
  bool IsEmpty() const { return this->Least > this->Greatest; }
};

/// Ranges of an array's samples: one for each component and, if there are several, one for the magnitude at the
/// end. NaN is ignored.
struct ValueRanges
{
  std::vector<ValueRange> All;
  std::vector<ValueRange> Finite; ///< without infinite values

  /// Ranges of no samples: empty.
  explicit ValueRanges(int components);
  /// Returns whether samples of a type can have these ranges. Ranges that were copied out of a file must pass
  /// before they are used.
  bool IsValid(bricks::ScalarType type) const;
  void Add(const ValueRanges& other);
  /// Adds the samples in `want` from a dense array of the samples in `have`.
  void Add(const FileArray& array, const std::byte* samples, const bricks::Box& have,
    const bricks::Box& want);
};

/// Reads all of a box of an array, with so many threads, or fewer if their chunks would not fit the shared
/// cache. `goesOn(part)` receives the completed part on the calling thread; when it returns false, nothing is
/// returned. Throws dsm::Error when the file cannot be read.
std::optional<ValueRanges> FindRanges(const ArrayStep& of, const bricks::Box& box, int threads,
  const std::function<bool(double)>& goesOn);

/// Ranges that the file itself tells, which are those of all of the array, or that were found before, in the user's
/// cache directory ($XDG_CACHE_HOME or ~/.cache): they are known as long as the file is what it was. `isShare`: the
/// box is what a rank has of all of the array, whose ranges are those of all ranks' boxes together: then they may
/// be those of more than the box, such as what was found with another number of ranks. Neither throws; what cannot
/// be kept is found again.
std::optional<ValueRanges> LoadRanges(const ArrayStep& of, const bricks::Box& box, bool isShare);
void KeepRanges(const ArrayStep& of, const bricks::Box& box, const ValueRanges& ranges);

} // namespace vol

#endif
