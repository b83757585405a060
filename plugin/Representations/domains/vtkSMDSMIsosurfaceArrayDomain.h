// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMIsosurfaceArrayDomain
 * @brief   the arrays that have isosurfaces, of which the default is the data's scalars, or the first of one component
 *
 * ParaView's ArrayListDomain takes the first of all by name where the data have no active scalars, such as a velocity
 * before a pressure; its magnitude has isosurfaces, too, but is seldom what is wanted. Ghost flags and ids, such as an
 * Exodus file's GlobalNodeId, are never the default while there is another array. The name is what ParaView makes of
 * the element DSMIsosurfaceArrayDomain.
 */

#ifndef vtkSMDSMIsosurfaceArrayDomain_h
#define vtkSMDSMIsosurfaceArrayDomain_h

#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSMArrayListDomain.h"

class VTKREPRESENTATIONSDSM_EXPORT vtkSMDSMIsosurfaceArrayDomain : public vtkSMArrayListDomain
{
public:
  static vtkSMDSMIsosurfaceArrayDomain* New();
  vtkTypeMacro(vtkSMDSMIsosurfaceArrayDomain, vtkSMArrayListDomain);

  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMDSMIsosurfaceArrayDomain();
  ~vtkSMDSMIsosurfaceArrayDomain() override;

  /// Arrays of neither points nor cells, such as an OpenFOAM case's path, are left out.
  bool IsFilteredArray(vtkPVDataInformation* data, int association, const char* arrayName) override;

private:
  int SetDefault(vtkSMProperty* property, bool useUncheckedValues);

  vtkSMDSMIsosurfaceArrayDomain(const vtkSMDSMIsosurfaceArrayDomain&) = delete;
  void operator=(const vtkSMDSMIsosurfaceArrayDomain&) = delete;
};

#endif
