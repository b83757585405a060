// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMStatistics
 * @brief   what every rank did for the last frame
 */

#ifndef vtkDSMStatistics_h
#define vtkDSMStatistics_h

#include "vtkObject.h"
#include "vtkRenderingDSMModule.h" // for the export macro

#include <cstddef> // for std::byte
#include <string>  // for ivars
#include <vector>  // for ivars

namespace dsm
{
class BlockStore;
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
   * Returns this rank's counters of a frame, as a report for all ranks (rt::FrameRenderer::Records). `ranks` trace,
   * and this is number `rank`.
   */
  static std::vector<std::byte> CreateReport(
    dsm::BlockStore& store, const rt::Frame& frame, int rank, int ranks);

  /**
   * Takes every rank's counters from the frame's reports. Each pixel has `samples` of those that are `wanted`; the
   * data were shown `coarser` levels below the finest.
   */
  void Take(const rt::Frame& frame, int samples, int wanted, int coarser);

  /**
   * No frame.
   */
  void Clear();

  /**
   * Returns the seconds from the collective start of the frame until the slowest rank was done; 0 without a frame.
   */
  vtkGetMacro(FrameSeconds, double);

  /**
   * Returns how many levels below the finest the data of the frame were, if there are as many; see
   * vtkDSMMemoryOptions::SetCoarserDataWhileMoving. 0 for the finest, and without a frame.
   */
  vtkGetMacro(CoarserLevel, int);

  /**
   * Returns how often the frame had to wait for a brick, on all ranks.
   */
  vtkTypeInt64 GetNumberOfMisses() const;

  /**
   * A sentence for the user: how the ranks keep their bricks, and why. Empty without a frame.
   */
  vtkGetMacro(Explanation, std::string);

  /**
   * One row for each rank. Columns: Rank, Host, Organization (as the frame found it), and the counters of
   * frame/counters.cmake, which docs/properties.md lists. Times and what workers count are summed over the rank's
   * threads.
   */
  void GetTable(vtkTable* table) const;

  /**
   * One row for each tracing thread of each rank. Columns: Rank, Worker, and those counters that are of threads.
   */
  void GetWorkerTable(vtkTable* table) const;

  /**
   * The most important counters in a few lines of text; empty without a frame.
   */
  std::string GetSummary() const;

  /**
   * Number of ranks that traced the last frame; 0 without one.
   */
  int GetNumberOfRanks() const;

  /**
   * The name of the host that a rank runs on; empty if the rank does not exist.
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
  struct Delivery;
  double FrameSeconds = 0.0;
  int Samples = 0;
  int Wanted = 0;
  int CoarserLevel = 0;
  std::string Explanation;
  std::string Organization;
  std::vector<RankRow> Rows;
  std::vector<WorkerRow> Workers; ///< all ranks' workers, in rank order
};

#endif
