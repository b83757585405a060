// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMReadAhead_h
#define vtkDSMReadAhead_h

#include "DSMVolumeFiles/cache/ChunkCache.h"

#include <cstddef>
#include <memory>

/// Reads chunks of one step of a file that will probably be wanted soon into a cache, one after the other, on one
/// of the process's ReaderThreads, while nobody else is busy. Chunks of which parts can be read by
/// themselves are left to the system. Takes at most half of the cache's room; what cannot
/// be read is passed by, as whoever needs it will be told. Any thread.
class vtkDSMReadAhead
{
public:
  /// To the cache that all files of the process share.
  static vtkDSMReadAhead& GetShared();

  /// The cache must outlive the read that is under way.
  explicit vtkDSMReadAhead(vol::ChunkCache& cache);

  /// What is still to be read of another file, array or step is given up. Throws std::bad_alloc.
  void Add(const std::shared_ptr<const vol::VolumeFile>& file, std::size_t array, int step,
    const rt::Index3& chunk);

  /// As long as there is one, no read begins: a frame is being made.
  class Pause
  {
  public:
    explicit Pause(vtkDSMReadAhead& ahead);
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

  private:
    vtkDSMReadAhead& Ahead;
  };

private:
  struct Shared;

  /// What the reads under way have, too.
  std::shared_ptr<Shared> State;
};

#endif
