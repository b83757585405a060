// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMSliceRepresentation
 * @brief   shows slices of image data, ray traced by all ranks
 *
 * Which slices these are, the properties of vtkPVDSMImageRepresentation say.
 */

#ifndef vtkPVDSMSliceRepresentation_h
#define vtkPVDSMSliceRepresentation_h

#include "vtkPVDSMImageRepresentation.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSmartPointer.h"             // for ivars

#include <string> // for signatures

class vtkPiecewiseFunction;

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMSliceRepresentation : public vtkPVDSMImageRepresentation
{
public:
  static vtkPVDSMSliceRepresentation* New();
  vtkTypeMacro(vtkPVDSMSliceRepresentation, vtkPVDSMImageRepresentation);

  ///@{
  /**
   * The opacity function, and whether slices have its opacities; off by default.
   */
  void SetScalarOpacity(vtkPiecewiseFunction* function);
  void SetOpacityFromMap(bool fromMap);
  ///@}

  std::string GetExportObstacle() const override;

protected:
  vtkPVDSMSliceRepresentation();
  ~vtkPVDSMSliceRepresentation() override;

  bool IsTranslucent() override;

private:
  vtkPVDSMSliceRepresentation(const vtkPVDSMSliceRepresentation&) = delete;
  void operator=(const vtkPVDSMSliceRepresentation&) = delete;

  void ChooseOpacity();

  vtkSmartPointer<vtkPiecewiseFunction> ScalarOpacity;
  bool OpacityFromMap = false;
};

#endif
