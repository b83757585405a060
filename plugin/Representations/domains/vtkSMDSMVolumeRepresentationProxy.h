// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMVolumeRepresentationProxy
 * @brief   chooses the array of a volume, or of slices, when the user first asks for them
 *
 * A volume, and slices, show the array that colors their dataset. ParaView chooses one for its own Volume where
 * there is none yet; this does it for DSM Volume and DSM Slices, before the view renders: once for each dataset, so
 * that the user can choose none. Slices are in the middle of the data until the user places them. The panel shows
 * what shades a volume and sets its density without the gear button.
 *
 * The name is what ParaView makes of the element DSMVolumeRepresentationProxy.
 */

#ifndef vtkSMDSMVolumeRepresentationProxy_h
#define vtkSMDSMVolumeRepresentationProxy_h

#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSMRepresentationProxy.h"

#include <string> // for ivars

class vtkSMPVRepresentationProxy;

class VTKREPRESENTATIONSDSM_EXPORT vtkSMDSMVolumeRepresentationProxy
  : public vtkSMRepresentationProxy
{
public:
  static vtkSMDSMVolumeRepresentationProxy* New();
  vtkTypeMacro(vtkSMDSMVolumeRepresentationProxy, vtkSMRepresentationProxy);

  /**
   * After a render: slices that follow the data get the indices that were shown.
   */
  void TakeSlices();

protected:
  vtkSMDSMVolumeRepresentationProxy();
  ~vtkSMDSMVolumeRepresentationProxy() override;

  void CreateVTKObjects() override;
  void ViewUpdated(vtkSMProxy* view) override;

private:
  vtkSMDSMVolumeRepresentationProxy(const vtkSMDSMVolumeRepresentationProxy&) = delete;
  void operator=(const vtkSMDSMVolumeRepresentationProxy&) = delete;

  void ChooseArray(vtkSMPVRepresentationProxy* display);
  /// Warns of what the panels offer and a volume does not show, when the user has chosen it.
  void ReportIgnored(vtkSMPVRepresentationProxy* display);
  void ChooseSlices(vtkSMProxy* display);
  bool IsOfSlices();
  bool IsShown(vtkSMProxy* display);

  bool HasChosen = false; ///< an array
  std::string Reported;
};

#endif
