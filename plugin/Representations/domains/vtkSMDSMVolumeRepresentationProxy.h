// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMVolumeRepresentationProxy
 * @brief   chooses the array of a volume when the user first asks for one
 *
 * A volume shows the array that colors its dataset. ParaView chooses one for its own Volume where there is none yet; this
 * does it for DSM Volume, before the view renders: once for each dataset, so that the user can choose none.
 *
 * The name is what ParaView makes of the element DSMVolumeRepresentationProxy.
 */

#ifndef vtkSMDSMVolumeRepresentationProxy_h
#define vtkSMDSMVolumeRepresentationProxy_h

#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSMRepresentationProxy.h"

class VTKREPRESENTATIONSDSM_EXPORT vtkSMDSMVolumeRepresentationProxy
  : public vtkSMRepresentationProxy
{
public:
  static vtkSMDSMVolumeRepresentationProxy* New();
  vtkTypeMacro(vtkSMDSMVolumeRepresentationProxy, vtkSMRepresentationProxy);

protected:
  vtkSMDSMVolumeRepresentationProxy();
  ~vtkSMDSMVolumeRepresentationProxy() override;

  void ViewUpdated(vtkSMProxy* view) override;

private:
  vtkSMDSMVolumeRepresentationProxy(const vtkSMDSMVolumeRepresentationProxy&) = delete;
  void operator=(const vtkSMDSMVolumeRepresentationProxy&) = delete;

  bool HasChosen = false;
};

#endif
