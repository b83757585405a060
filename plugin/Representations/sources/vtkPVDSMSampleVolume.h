// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMSampleVolume
 * @brief   vtkDSMSampleVolume, known to ParaView's client-server layer
 */

#ifndef vtkPVDSMSampleVolume_h
#define vtkPVDSMSampleVolume_h

#include "vtkDSMSampleVolume.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMSampleVolume : public vtkDSMSampleVolume
{
public:
  static vtkPVDSMSampleVolume* New();
  vtkTypeMacro(vtkPVDSMSampleVolume, vtkDSMSampleVolume);

  ///@{
  /**
   * As in the superclass; declared here because the client-server layer knows only the methods of
   * the plugin's own classes.
   */
  void SetKind(int kind) override;
  void SetDimensions(int i, int j, int k) override;
  void SetDimensions(const int dimensions[3]) override;
  void SetScalarType(int type) override;
  ///@}

protected:
  vtkPVDSMSampleVolume();
  ~vtkPVDSMSampleVolume() override;

private:
  vtkPVDSMSampleVolume(const vtkPVDSMSampleVolume&) = delete;
  void operator=(const vtkPVDSMSampleVolume&) = delete;
};

#endif
