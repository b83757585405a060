// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMShowDomain
 * @brief   the parts of a dataset that a display can show, of which the default depends on the data
 *
 * The default is the first entry, isosurfaces, where the data are not flat and have an array that can have them;
 * else the second one, the outer surface. The name is what ParaView makes of the element DSMShowDomain.
 */

#ifndef vtkSMDSMShowDomain_h
#define vtkSMDSMShowDomain_h

#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSMEnumerationDomain.h"

class VTKREPRESENTATIONSDSM_EXPORT vtkSMDSMShowDomain : public vtkSMEnumerationDomain
{
public:
  static vtkSMDSMShowDomain* New();
  vtkTypeMacro(vtkSMDSMShowDomain, vtkSMEnumerationDomain);

  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMDSMShowDomain();
  ~vtkSMDSMShowDomain() override;

private:
  vtkSMDSMShowDomain(const vtkSMDSMShowDomain&) = delete;
  void operator=(const vtkSMDSMShowDomain&) = delete;
};

#endif
