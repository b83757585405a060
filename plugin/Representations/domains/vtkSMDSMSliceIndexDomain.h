// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMSliceIndexDomain
 * @brief   the samples of the input along an axis, counted from 0; the default is the middle one
 *
 * The extent of one image tells them. Blocks, AMR, and images with ghost cells have extents that
 * say nothing of the volume that they make: their samples are unknown until they are rendered.
 *
 * The attribute `axis` (0, 1 or 2) is the axis. The name is what ParaView makes of the element DSMSliceIndexDomain.
 */

#ifndef vtkSMDSMSliceIndexDomain_h
#define vtkSMDSMSliceIndexDomain_h

#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSMIntRangeDomain.h"

class VTKREPRESENTATIONSDSM_EXPORT vtkSMDSMSliceIndexDomain : public vtkSMIntRangeDomain
{
public:
  static vtkSMDSMSliceIndexDomain* New();
  vtkTypeMacro(vtkSMDSMSliceIndexDomain, vtkSMIntRangeDomain);

  void Update(vtkSMProperty* property) override;
  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

  /**
   * Number of samples along the axis, when the data have been rendered.
   */
  void SetNumberOfSamples(int count);

  /**
   * Returns whether the property has the last default, or no index at all: then it follows the data.
   */
  bool IsAutomatic();

protected:
  vtkSMDSMSliceIndexDomain();
  ~vtkSMDSMSliceIndexDomain() override;

  int ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element) override;

private:
  vtkSMDSMSliceIndexDomain(const vtkSMDSMSliceIndexDomain&) = delete;
  void operator=(const vtkSMDSMSliceIndexDomain&) = delete;

  int Axis = 0;
  int Default = -1; ///< that was set last
};

#endif
