// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMMemoryOptions
 * @brief   vtkDSMMemoryOptions, known to ParaView's client-server layer
 */

#ifndef vtkPVDSMMemoryOptions_h
#define vtkPVDSMMemoryOptions_h

#include "vtkDSMMemoryOptions.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMMemoryOptions : public vtkDSMMemoryOptions
{
public:
  static vtkPVDSMMemoryOptions* New();
  vtkTypeMacro(vtkPVDSMMemoryOptions, vtkDSMMemoryOptions);

  ///@{
  /**
   * As in the superclass; declared here because the client-server layer knows only the methods of
   * the plugin's own classes.
   */
  void SetMemoryOrganization(int organization) override;
  void SetHostSharing(bool shared) override;
  void SetMemory(int mebibytes) override;
  void SetScratchDirectory(const char* directory) override;
  void SetCoarserDataWhileMoving(bool coarser) override;
  void SetCacheSize(int mebibytes) override;
  void SetNumberOfThreads(int threads) override;
  void SetScheduler(int scheduler) override;
  void SetSilenceLimit(int seconds) override;
  ///@}

protected:
  vtkPVDSMMemoryOptions();
  ~vtkPVDSMMemoryOptions() override;

private:
  vtkPVDSMMemoryOptions(const vtkPVDSMMemoryOptions&) = delete;
  void operator=(const vtkPVDSMMemoryOptions&) = delete;
};

#endif
