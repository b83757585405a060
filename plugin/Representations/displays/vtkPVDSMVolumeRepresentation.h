// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMVolumeRepresentation
 * @brief   shows image data as a volume, ray traced by all ranks
 *
 * Methods have the names of vtkImageVolumeRepresentation's.
 */

#ifndef vtkPVDSMVolumeRepresentation_h
#define vtkPVDSMVolumeRepresentation_h

#include "vtkNew.h" // for ivars
#include "vtkPVDSMImageRepresentation.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSmartPointer.h"             // for ivars

#include <string> // for ivars

class vtkPVTransferFunction2D;
class vtkPiecewiseFunction;
class vtkVolumeProperty;

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMVolumeRepresentation : public vtkPVDSMImageRepresentation
{
public:
  static vtkPVDSMVolumeRepresentation* New();
  vtkTypeMacro(vtkPVDSMVolumeRepresentation, vtkPVDSMImageRepresentation);

  int ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo) override;

  /**
   * Index 0: the point array that is shown.
   */
  void SetInputArrayToProcess(
    int index, int port, int connection, int association, const char* name) override;
  using Superclass::SetInputArrayToProcess;

  ///@{
  /**
   * Forwarded to the volume's property. The map's vector mode chooses the array's component. Any interpolation type
   * but nearest is linear.
   */
  void SetLookupTable(vtkScalarsToColors* table) override;
  void SetScalarOpacity(vtkPiecewiseFunction* function);
  void SetScalarOpacityUnitDistance(double distance);
  void SetShade(bool shade);
  void SetInterpolationType(int type);
  void SetVolumeAnisotropy(double anisotropy);
  ///@}

  /**
   * The part of the shading that is scattered light, while the view has shadows or ambient occlusion: these alone would
   * leave dense volumes nearly black.
   */
  void SetScattering(double part);

  ///@{
  /**
   * The array, and its component, that the opacity function maps, if it is used.
   */
  void SetUseSeparateOpacityArray(bool use);
  void SelectOpacityArray(int index, int port, int connection, int association, const char* name);
  void SelectOpacityArrayComponent(int component);
  ///@}

  ///@{
  /**
   * A function of the values and of a second number, in place of the color and opacity functions, if it is used. The
   * second number is the length of the gradient, or a value of another array of points.
   */
  void SetUseTransfer2D(bool use);
  void SetTransferFunction2D(vtkPVTransferFunction2D* function);
  void SetUseGradientForTransfer2D(bool use);
  void SelectColorArray2(int index, int port, int connection, int association, const char* name);
  void SelectColorArray2Component(int component);
  ///@}

  /**
   * One of vtkVolumeMapper's blend modes, but Slice, or vtkDSMVolumeMapper::INTEGRAL_BLEND.
   */
  void SetBlendMode(int mode);

  /**
   * If true, the first of two components is colored and the second gives the opacity; the first three of four are
   * the color and the fourth gives the opacity. The same holds if scalars are not mapped to colors.
   */
  void SetMultiComponentsMapping(bool maps);

  ///@{
  /**
   * Values of the blend mode Isosurface, forwarded to the volume's property.
   */
  void SetNumberOfIsosurfaces(int number);
  void SetIsosurfaceValue(int index, double value);
  ///@}

  std::string GetExportObstacle() const override;

protected:
  vtkPVDSMVolumeRepresentation();
  ~vtkPVDSMVolumeRepresentation() override;

  bool IsTranslucent() override { return true; }

private:
  vtkPVDSMVolumeRepresentation(const vtkPVDSMVolumeRepresentation&) = delete;
  void operator=(const vtkPVDSMVolumeRepresentation&) = delete;

  void UpdateOpacityArray();
  void UpdateSecondArray();
  double GetScatteredPart() const;

  vtkNew<vtkVolumeProperty> VolumeProperty;
  double Scattering = 0.0;
  bool UseSeparateOpacityArray = false;
  std::string OpacityArray;
  vtkSmartPointer<vtkPVTransferFunction2D> TransferFunction2D;
  bool UseGradientForTransfer2D = true;
  std::string SecondArray;
  bool MultiComponentsMapping = false;
};

#endif
