// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMMemoryOptions
 * @brief   how the ranks keep the bricks of a dataset, with how many threads they trace, and how long
 *          they wait for one another
 *
 * Held by each mapper of a vtkDSMScene, of its own or together with others. All that is shown shares one memory, so
 * what the visible datasets of all scenes ask for when one of these is drawn is merged as said below; the picture is
 * the same whatever is chosen. Same values on every rank, but that the number of threads may differ.
 */

#ifndef vtkDSMMemoryOptions_h
#define vtkDSMMemoryOptions_h

#include "vtkObject.h"
#include "vtkRenderingDSMModule.h" // for the export macro

#include <string>

class VTKRENDERINGDSM_EXPORT vtkDSMMemoryOptions : public vtkObject
{
public:
  static vtkDSMMemoryOptions* New();
  vtkTypeMacro(vtkDSMMemoryOptions, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * How the ranks keep the bricks. The first among all datasets that is not Automatic counts.
   */
  enum MemoryOrganizationType
  {
    Automatic = 0,   ///< Replicated where everything fits the memory, else ObjectBased (default)
    Replicated = 1,  ///< every rank has all bricks
    ObjectBased = 2, ///< each has its own; those of others are fetched into a cache, by a table
    PageBased = 3    ///< the same, by page faults
  };
  vtkSetClampMacro(MemoryOrganization, int, Automatic, PageBased);
  vtkGetMacro(MemoryOrganization, int);
  ///@}

  ///@{
  /**
   * Whether ranks of one host read one another's bricks in place, where the organisation allows it
   * (default on). Off when any dataset wants it off.
   */
  vtkSetMacro(HostSharing, bool);
  vtkGetMacro(HostSharing, bool);
  vtkBooleanMacro(HostSharing, bool);
  ///@}

  ///@{
  /**
   * What each rank may take for its own bricks, copies and the cache, in MiB. 0 (the default): half
   * of what its host has left, divided by the ranks there. The largest among all datasets counts.
   */
  vtkSetClampMacro(Memory, int, 0, VTK_INT_MAX);
  vtkGetMacro(Memory, int);
  ///@}

  ///@{
  /**
   * A directory on the own disk of each rank's node, for bricks that do not fit the memory: they go to a
   * file without a name there, which ends with the process, instead of being refused. Empty (the
   * default): none. The first among all datasets that is given counts.
   */
  virtual void SetScratchDirectory(const char* directory);
  const char* GetScratchDirectory() const { return this->ScratchDirectory.c_str(); }
  ///@}

  ///@{
  /**
   * Whether volumes in files that have coarser levels are drawn from one of those while the camera moves (the window's
   * DesiredUpdateRate is 1 or more) and bricks of the finest that the picture needs are not in memory. They are
   * asked for meanwhile, and take their place as they come. All other pictures are of the finest. Off by default; on
   * when any dataset wants it on.
   */
  vtkSetMacro(CoarserDataWhileMoving, bool);
  vtkGetMacro(CoarserDataWhileMoving, bool);
  vtkBooleanMacro(CoarserDataWhileMoving, bool);
  ///@}

  ///@{
  /**
   * Memory of each rank for bricks of other ranks, in MiB. Default 256. The largest among all datasets
   * counts.
   */
  vtkSetClampMacro(CacheSize, int, 1, VTK_INT_MAX);
  vtkGetMacro(CacheSize, int);
  ///@}

  ///@{
  /**
   * Tracing threads of each rank; 0 (the default) divides the host's cores by its ranks. The largest
   * among all datasets counts.
   */
  static constexpr int MostThreads = 1024;
  vtkSetClampMacro(NumberOfThreads, int, 0, MostThreads);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * How the tiles of the picture come to the ranks. WorkStealing (the default): a rank begins with those
   * that it traced in the last picture, and takes from others when it has none left. CentralQueue: rank
   * 0 deals them out; so it is in a renderer where any dataset asks for it.
   */
  enum SchedulerType
  {
    WorkStealing = 0,
    CentralQueue = 1
  };
  vtkSetClampMacro(Scheduler, int, WorkStealing, CentralQueue);
  vtkGetMacro(Scheduler, int);
  ///@}

  ///@{
  /**
   * Seconds without any sign of life after which a rank that takes part in a frame is given up: frames
   * then end on the others with an error that names it. 0: never. Default 60. The largest among all
   * datasets counts, 0 as the largest of all.
   */
  vtkSetClampMacro(SilenceLimit, int, 0, VTK_INT_MAX);
  vtkGetMacro(SilenceLimit, int);
  ///@}

protected:
  vtkDSMMemoryOptions();
  ~vtkDSMMemoryOptions() override;

private:
  vtkDSMMemoryOptions(const vtkDSMMemoryOptions&) = delete;
  void operator=(const vtkDSMMemoryOptions&) = delete;

  int MemoryOrganization = Automatic;
  bool HostSharing = true;
  int Memory = 0;
  std::string ScratchDirectory;
  bool CoarserDataWhileMoving = false;
  int CacheSize = 256;
  int NumberOfThreads = 0;
  int Scheduler = WorkStealing;
  int SilenceLimit = 60;
};

#endif
