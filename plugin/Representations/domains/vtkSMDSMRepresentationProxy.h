// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMRepresentationProxy
 * @brief   lets what the user has not placed follow data that move
 *
 * The origins of planes and the cropping box begin with the defaults of their domains, which the data give. Where
 * they still have what the last data gave, other data (a time step, an edited source) give them anew, before the
 * view renders. A cropping box that was moved, turned or scaled stays.
 *
 * The name is what ParaView makes of the element DSMRepresentationProxy.
 */

#ifndef vtkSMDSMRepresentationProxy_h
#define vtkSMDSMRepresentationProxy_h

#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSMRepresentationProxy.h"

#include <map>    // for ivars
#include <string> // for ivars
#include <vector> // for ivars

class VTKREPRESENTATIONSDSM_EXPORT vtkSMDSMRepresentationProxy : public vtkSMRepresentationProxy
{
public:
  static vtkSMDSMRepresentationProxy* New();
  vtkTypeMacro(vtkSMDSMRepresentationProxy, vtkSMRepresentationProxy);

  /**
   * Called when the data have been updated, and with them the domains: before the view renders.
   */
  void FollowData();

protected:
  vtkSMDSMRepresentationProxy();
  ~vtkSMDSMRepresentationProxy() override;

  void ViewUpdated(vtkSMProxy* view) override;

private:
  vtkSMDSMRepresentationProxy(const vtkSMDSMRepresentationProxy&) = delete;
  void operator=(const vtkSMDSMRepresentationProxy&) = delete;

  /// Returns whether the property has changed.
  bool Follow(const std::string& name);

  std::map<std::string, std::vector<double>> Defaults; ///< that the last data gave, by property
};

#endif
