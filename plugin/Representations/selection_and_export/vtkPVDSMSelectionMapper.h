// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMSelectionMapper
 * @brief   draws what a traced dataset shows as geometry, while ParaView selects
 *
 * ParaView finds what is under the pointer by drawing numbers of cells and points, after the depth of what is in
 * front. For that each rank draws the triangles of its own data, so that a selection is what it is for a Surface.
 * The triangles are there only as long as it takes: they are made when the first pass asks for them, and freed by
 * the next picture. Other pictures show nothing of it.
 */

#ifndef vtkPVDSMSelectionMapper_h
#define vtkPVDSMSelectionMapper_h

#include "vtkSmartPointer.h" // for ivars

#include <functional> // for ivars

// Since 9.3, VTK's mapper of blocks does what this other one did, which 9.6 no longer has.
#if __has_include("vtkCompositePolyDataMapperDelegator.h")
#include "vtkCompositePolyDataMapper.h"
using vtkPVDSMBlockMapper = vtkCompositePolyDataMapper;
#else
#include "vtkCompositePolyDataMapper2.h"
using vtkPVDSMBlockMapper = vtkCompositePolyDataMapper2;
#endif

class vtkDataObject;

class vtkPVDSMSelectionMapper : public vtkPVDSMBlockMapper
{
public:
  static vtkPVDSMSelectionMapper* New();
  vtkTypeMacro(vtkPVDSMSelectionMapper, vtkPVDSMBlockMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Makes the geometry: a vtkMultiBlockDataSet of vtkPolyData that have vtkOriginalCellIds and
   * vtkOriginalPointIds; null where there is nothing.
   */
  void SetSource(std::function<vtkSmartPointer<vtkDataObject>()> source);

  /**
   * Set while ParaView is selecting; otherwise the mapper draws nothing.
   */
  void SetSelecting(bool selecting);

  void Render(vtkRenderer* renderer, vtkActor* actor) override;

  ///@{
  /**
   * Where the geometry will be, without the actor's transform: outside of the view it is not drawn.
   * Null where there is none.
   */
  void SetShownBounds(const double* bounds);
  using vtkPVDSMBlockMapper::GetBounds;
  double* GetBounds() VTK_SIZEHINT(6) override;
  ///@}

  ///@{
  /**
   * Nothing to draw in order.
   */
  bool HasOpaqueGeometry() override { return true; }
  bool HasTranslucentPolygonalGeometry() override { return false; }
  ///@}

protected:
  vtkPVDSMSelectionMapper();
  ~vtkPVDSMSelectionMapper() override;

private:
  vtkPVDSMSelectionMapper(const vtkPVDSMSelectionMapper&) = delete;
  void operator=(const vtkPVDSMSelectionMapper&) = delete;

  std::function<vtkSmartPointer<vtkDataObject>()> Source;
  bool Selecting = false;
  bool Filled = false;
  double ShownBounds[6];
};

#endif
