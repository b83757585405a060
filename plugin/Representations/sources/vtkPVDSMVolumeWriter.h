// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMVolumeWriter
 * @brief   vtkDSMVolumeWriter, known to ParaView's client-server layer
 */

#ifndef vtkPVDSMVolumeWriter_h
#define vtkPVDSMVolumeWriter_h

#include "vtkDSMVolumeWriter.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMVolumeWriter : public vtkDSMVolumeWriter
{
public:
  static vtkPVDSMVolumeWriter* New();
  vtkTypeMacro(vtkPVDSMVolumeWriter, vtkDSMVolumeWriter);

  ///@{
  /**
   * As in the superclass; declared here because the client-server layer knows only the methods of
   * the plugin's own classes.
   */
  void SetFileName(const char* name) override;
  void SetCompression(int compression) override;
  void SetCoarserLevels(bool coarser) override;
  int Write() override;
  void SetInputConnection(vtkAlgorithmOutput* input) override;
  void SetInputConnection(int port, vtkAlgorithmOutput* input) override;
  ///@}

protected:
  vtkPVDSMVolumeWriter();
  ~vtkPVDSMVolumeWriter() override;

private:
  vtkPVDSMVolumeWriter(const vtkPVDSMVolumeWriter&) = delete;
  void operator=(const vtkPVDSMVolumeWriter&) = delete;
};

#endif
