// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMIsovalueDomain
 * @brief   the range of an array, of which the default is the isovalue that the data suggest
 *
 * The panel's reset button takes it. What the data suggest is known once they have been shown; until then, and where
 * they suggest none, the default is that of ParaView's ArrayRangeDomain. The name is what ParaView makes of the
 * element DSMIsovalueDomain.
 */

#ifndef vtkSMDSMIsovalueDomain_h
#define vtkSMDSMIsovalueDomain_h

#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSMArrayRangeDomain.h"

class VTKREPRESENTATIONSDSM_EXPORT vtkSMDSMIsovalueDomain : public vtkSMArrayRangeDomain
{
public:
  static vtkSMDSMIsovalueDomain* New();
  vtkTypeMacro(vtkSMDSMIsovalueDomain, vtkSMArrayRangeDomain);

  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMDSMIsovalueDomain();
  ~vtkSMDSMIsovalueDomain() override;

private:
  vtkSMDSMIsovalueDomain(const vtkSMDSMIsovalueDomain&) = delete;
  void operator=(const vtkSMDSMIsovalueDomain&) = delete;
};

#endif
