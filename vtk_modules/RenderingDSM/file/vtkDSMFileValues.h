// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFileValues_h
#define vtkDSMFileValues_h

#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/range/LookThrough.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>

class vtkObject;

/// Part of an array in a file: what vtkDSMFileArray shows to VTK, and what who knows of it reads in boxes. Any
/// thread.
class vtkDSMFileValues
{
public:
  /// `box`: the samples that the part has, in the file's indices. `options`: with which the file was opened.
  /// `nextStep`: that will probably be wanted next, or None.
  vtkDSMFileValues(std::shared_ptr<const vol::VolumeFile> file, std::size_t array, int step,
    const bricks::Box& box, int nextStep, vol::OpenOptions options = {});

  static constexpr int None = -1;

  const std::shared_ptr<const vol::VolumeFile>& GetFile() const { return this->Of.File; }
  const vol::OpenOptions& GetOptions() const { return this->Options; }
  std::size_t GetArrayNumber() const { return this->Of.Array; }
  int GetStep() const { return this->Of.Step; }
  const vol::ArrayStep& GetArrayStep() const { return this->Of; }
  int GetNextStep() const { return this->NextStep; }
  const bricks::Box& GetBox() const { return this->Box; }

  const vol::FileArray& GetArray() const { return this->Of.Get(); }
  /// As the file has them.
  bricks::ScalarType GetType() const { return this->GetArray().Type; }
  std::int64_t GetCount() const { return this->Box.GetCount(); }

  /// The samples of a box that counts from the part's first sample, dense, x fastest, all components of a sample
  /// together. Throws dsm::Error.
  void ReadBox(const bricks::Box& box, std::byte* out) const;

  /// Advises the system that the samples of boxes will probably be needed soon. Does not fail.
  void Prefetch(std::vector<bricks::Box> boxes) const;

  /// Opens a coarser level of the file, of which the first is 1, and returns all samples of the same array in it.
  /// Returns null where the file has no such level, or the level no such array. Throws dsm::Error.
  std::shared_ptr<vtkDSMFileValues> OpenCoarser(int level) const;
  /// Returns the number of levels below the one that was opened.
  int CountCoarser() const { return this->Of.File->GetLevels() - 1 - this->Options.Level; }
  /// Returns whether the file has coarser levels, and reading all of this array takes long: then ranges are those of a
  /// coarser level.
  bool IsTooLargeToRead() const;

  /// The part is what a rank has of all of the array: FindRanges may find those of more (vol::LoadRanges).
  void SetShare(bool isShare) { this->IsShare = isShare; }

  /// Equal only, for all practical purposes, for equal values.
  std::uint64_t GetStamp() const;

  /// The chunk that has a sample, and the sample's place in it. Throws dsm::Error.
  struct Place
  {
    vol::ChunkCache::Chunk Samples;
    bricks::Box Has; ///< that Samples has, in the part's indices
  };
  Place Find(const bricks::Index3& sample) const;
  bricks::Index3 GetSample(std::int64_t number) const
  {
    const bricks::Index3 size = this->Box.GetSize();
    return { number % size.x, number / size.x % size.y, number / (size.x * size.y) };
  }

  /// Returns the ranges of all values; computed on the first call, unless they were kept. An array that
  /// IsTooLargeToRead has the ranges of a coarser level. Returns null when `goesOn` returns false. `withBricks`: the
  /// values are also examined as bricks in the same pass, if possible (vol::LookThrough). Throws dsm::Error.
  const vol::ValueRanges* FindRanges(
    const std::function<bool(double)>& goesOn, bool withBricks = false) const;
  /// Returns the bricks examined in that pass, once; this object does not keep them any longer.
  std::optional<bricks::SeenBricks> TakeSeen() const;

private:
  /// Under the lock; leaves Ranges unset when `goesOn` returns false.
  void ReadRanges(const std::function<bool(double)>& goesOn, bool withBricks) const;
  /// Likewise, of a coarser level. Returns whether there is one.
  bool ReadCoarserRanges(const std::function<bool(double)>& goesOn) const;

  vol::ArrayStep Of;
  int NextStep;
  bricks::Box Box;
  vol::OpenOptions Options;
  bool IsShare = false;
  mutable std::mutex RangesLock;
  mutable std::optional<vol::ValueRanges> Ranges;
  mutable std::optional<bricks::SeenBricks> Seen;
};

#endif
