// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMMixedRepresentation
 * @brief   shows isosurfaces of some blocks of a dataset, and the outer surface of the others, ray traced by all ranks
 *
 * Blocks in three dimensions that are image data, rectilinear, structured, unstructured or hyper tree grids have
 * isosurfaces. All other blocks show their surface at the same time. With SHOW_SURFACE, all blocks show it.
 */

#ifndef vtkPVDSMMixedRepresentation_h
#define vtkPVDSMMixedRepresentation_h

#include "vtkPVDSMImageRepresentation.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSmartPointer.h"             // for ivars

#include <vector>

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMMixedRepresentation : public vtkPVDSMImageRepresentation
{
public:
  static vtkPVDSMMixedRepresentation* New();
  vtkTypeMacro(vtkPVDSMMixedRepresentation, vtkPVDSMImageRepresentation);

  /// Requests ghost cells while isosurfaces are shown, too: the outer surfaces of other blocks need them. Off by
  /// default, because on several ranks, sources of hyper tree grids make trees twice if ghost cells are requested.
  void SetNeedsGhostCells(bool needs) { this->NeedsGhostCells = needs; }

  void SetVisibility(bool visible) override;
  vtkDataObject* GetRenderedDataObject(int port) override;
  /// The triangles of outer surfaces are included only if no actor of the view's renderer has them.
  std::vector<vtkSmartPointer<vtkPolyData>> GetTriangles() override;

protected:
  vtkPVDSMMixedRepresentation();
  ~vtkPVDSMMixedRepresentation() override;

  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  void PrepareRender(vtkInformation* inInfo) override;
  bool IsTranslucent() override;
  vtkBoundingBox GetShownBounds() override;
  vtkSmartPointer<vtkDataObject> MakeSelectable() override;
  void ShowVolume() override;
  vtkSmartPointer<vtkDataObject> ChooseVolumes(vtkDataObject* shown) override;

private:
  vtkPVDSMMixedRepresentation(const vtkPVDSMMixedRepresentation&) = delete;
  void operator=(const vtkPVDSMMixedRepresentation&) = delete;

  /// A color array that isosurfaces or surfaces do not have is one of the others.
  void OnWarning(vtkObject* mapper, unsigned long event, void* text);

  bool NeedsGhostCells = false;
  vtkSmartPointer<vtkDataObject> AllShown; ///< the blocks that are not hidden, of all kinds
};

#endif
