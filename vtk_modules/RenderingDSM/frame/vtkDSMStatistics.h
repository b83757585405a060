// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMStatistics
 * @brief   what every rank did for the last frame
 */

#ifndef vtkDSMStatistics_h
#define vtkDSMStatistics_h

#include "vtkObject.h"
#include "vtkRenderingDSMModule.h" // for the export macro

#include <string> // for ivars
#include <vector> // for ivars

namespace dsm
{
class Messenger;
}
namespace rt
{
struct Frame;
}
class vtkTable;

class VTKRENDERINGDSM_EXPORT vtkDSMStatistics : public vtkObject
{
public:
  static vtkDSMStatistics* New();
  vtkTypeMacro(vtkDSMStatistics, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Collective: every rank learns of every rank's counters. `samples` of each pixel are there of those
   * that are `wanted`; the data were shown `coarser` levels below the finest.
   */
  void Gather(
    dsm::Messenger& messenger, const rt::Frame& frame, int samples, int wanted, int coarser);

  /**
   * No frame.
   */
  void Clear();

  /**
   * From the collective start of the frame to its collective end, on the slowest rank; 0 without a
   * frame.
   */
  vtkGetMacro(FrameSeconds, double);

  /**
   * How many levels below the finest the data of the frame were, where there are as many; see
   * vtkDSMMemoryOptions::SetCoarserDataWhileMoving. 0 for the finest, and without a frame.
   */
  vtkGetMacro(CoarserLevel, int);

  /**
   * How often the frame had to wait for a brick, on all ranks.
   */
  vtkTypeInt64 GetNumberOfMisses() const;

  /**
   * A sentence for the user: how the ranks keep their bricks, and why. Empty without a frame.
   */
  vtkGetMacro(Explanation, std::string);

  /**
   * One row for each rank. Columns: Rank, Host, Organization (as the frame found it), Threads,
   * BytesResident (bricks that it owns), BytesShared (read in place, on its host), BytesCopied
   * (replicated), BytesOfTables (which find bricks), BytesCached, PeakBytesCached, CacheCapacity,
   * MemoryBudget, Publications (how often an array or a surface was cut into bricks since the ranks
   * came together), BytesPublished (that it put into bricks for it, since then), Accesses, Hits, Misses, Joins (misses that found the brick requested already),
   * Evictions, Prefetches (bricks asked for before a tile came to them), PrefetchesUsed (those of
   * them that were needed in the frame), Requests (messages that asked for bricks), BytesReceived,
   * BytesSent, WaitSeconds (of tiles, for bricks), IdleSeconds (of threads that found no other tile
   * to trace meanwhile), Tiles, NewTiles (those that another rank traced in the last frame),
   * Seconds (of tracing, processor time). Times and what workers count are summed over the rank's
   * threads.
   */
  void GetTable(vtkTable* table) const;

  /**
   * One row for each tracing thread of each rank. Columns: Rank, Worker, Accesses, Hits, Misses, Joins,
   * WaitSeconds.
   */
  void GetWorkerTable(vtkTable* table) const;

  /**
   * The most telling figures in a few lines of text; empty without a frame.
   */
  std::string GetSummary() const;

  /**
   * Of the last frame; 0 without one.
   */
  int GetNumberOfRanks() const;

  /**
   * The name of the host that a rank runs on; empty for a rank that there is not.
   */
  std::string GetHost(int rank) const;

  /**
   * The same as JSON: an array with an object for each rank, keys as the table's columns, and
   * Explanation; under Workers an array with an object for each thread.
   */
  std::string GetJson() const;

protected:
  vtkDSMStatistics();
  ~vtkDSMStatistics() override;

private:
  vtkDSMStatistics(const vtkDSMStatistics&) = delete;
  void operator=(const vtkDSMStatistics&) = delete;

  struct RankRow;
  struct WorkerRow;
  double FrameSeconds = 0.0;
  int Samples = 0;
  int Wanted = 0;
  int CoarserLevel = 0;
  std::string Explanation;
  std::string Organization;
  std::vector<RankRow> Rows;
  std::vector<WorkerRow> Workers; ///< of all ranks, in rank order
};

#endif
