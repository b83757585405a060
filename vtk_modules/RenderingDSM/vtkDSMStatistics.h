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
   * Collective: every rank learns of every rank's counters.
   */
  void Gather(dsm::Messenger& messenger, const rt::Frame& frame);

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
   * One row for each rank. Columns: Rank, Host, Threads, BytesResident, BytesCached, CacheCapacity,
   * Accesses, Hits, Misses, BytesReceived, Tiles, Seconds (of tracing, summed over the threads).
   */
  void GetTable(vtkTable* table) const;

  /**
   * The same as JSON: an array with an object for each rank, keys as the table's columns.
   */
  std::string GetJson() const;

protected:
  vtkDSMStatistics();
  ~vtkDSMStatistics() override;

private:
  vtkDSMStatistics(const vtkDSMStatistics&) = delete;
  void operator=(const vtkDSMStatistics&) = delete;

  struct RankRow;
  double FrameSeconds = 0.0;
  std::vector<RankRow> Rows;
};

#endif
