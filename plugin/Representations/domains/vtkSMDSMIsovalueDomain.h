// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMIsovalueDomain
 * @brief   the range of an array, of which the default is the isovalue that the data suggest
 *
 * The panel's reset button takes it. The suggested value is known once the data have been shown; until then, and if
 * the data suggest none, the default is that of ParaView's ArrayRangeDomain. A display's single isovalue is
 * automatic by default, and begins with a number near the middle of the range that a user would hardly enter:
 * ParaView sends no event when a property is set to the number that it has. If the shown data have fill values that
 * nothing declares, the range is that of the other values: a slider over -3.4e38 to 1 is of no use. The name is
 * what ParaView makes of the element DSMIsovalueDomain.
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

  void Update(vtkSMProperty* property) override;

  /**
   * After a render: takes the range that the shown data suggest for the domain's property.
   */
  void TakeSuggestedRange();

protected:
  vtkSMDSMIsovalueDomain();
  ~vtkSMDSMIsovalueDomain() override;

private:
  int SetSingle(vtkSMProperty* property);

  double Suggested[2]; ///< not a number where all values count

  vtkSMDSMIsovalueDomain(const vtkSMDSMIsovalueDomain&) = delete;
  void operator=(const vtkSMDSMIsovalueDomain&) = delete;
};

#endif
