// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMGeometryRepresentation
 * @brief   shows the surface of any dataset, ray traced by all ranks
 *
 * A Surface representation (the same geometry filter, properties, blocks and coloring) whose mapper
 * is a vtkDSMPolyDataMapper. The geometry never leaves the rank: what is delivered is an empty
 * placeholder, and the view is asked to render where the data are. Keeps the view's vtkDSMScene alive
 * on the processes that render.
 */

#ifndef vtkPVDSMGeometryRepresentation_h
#define vtkPVDSMGeometryRepresentation_h

#include "vtkPVDSMExportSource.h"
#include "vtkPVDSMMeshDisplay.h"
#include "vtkPVDSMTracedDisplay.h"       // for ivars
#include "vtkRepresentationsDSMModule.h" // for the export macro

#include <memory> // for ivars
#include <vector>

class vtkActor;
class vtkBoundingBox;
class vtkDSMPolyDataMapper;
class vtkDataObject;
class vtkMapper;
class vtkPVDSMFrameReport;
class vtkPVDSMLightOptions;
class vtkPVDSMMemoryOptions;

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMGeometryRepresentation
  : public vtkPVDSMMeshDisplay
  , public vtkPVDSMExportSource
{
public:
  static vtkPVDSMGeometryRepresentation* New();
  vtkTypeMacro(vtkPVDSMGeometryRepresentation, vtkPVDSMMeshDisplay);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo) override;
  void SetArrayIdNames(const char* pointArray, const char* cellArray) override;
  void SetVisibility(bool visible) override;
  void SetPickable(int pickable) override;

  /**
   * Draws the edges of polygons on the surface; off by default.
   */
  void SetShowEdges(bool show);

  ///@{
  /**
   * The visible part of the dataset: the side of a plane (world coordinates) that its normal points to, the inside
   * of a box (x, y and z from, to; in the dataset's coordinates), which may be moved, turned and scaled.
   */
  void SetClip(bool clip) { this->Display->Clipping.Clips = clip; }
  void SetClipOrigin(double x, double y, double z) { this->Display->Clipping.Origin = { x, y, z }; }
  void SetClipNormal(double x, double y, double z) { this->Display->Clipping.Normal = { x, y, z }; }
  void SetCropping(bool crop) { this->Display->Clipping.Crops = crop; }
  void SetCroppingBox(const double box[6])
  {
    this->Display->Clipping.Box = { box[0], box[1], box[2], box[3], box[4], box[5] };
  }
  void SetCroppingUsesBox(bool uses) { this->Display->Clipping.UsesBox = uses; }
  void SetCroppingPosition(double x, double y, double z)
  {
    this->Display->Clipping.BoxPosition = { x, y, z };
  }
  void SetCroppingRotation(double x, double y, double z)
  {
    this->Display->Clipping.BoxRotation = { x, y, z };
  }
  void SetCroppingScale(double x, double y, double z)
  {
    this->Display->Clipping.BoxScale = { x, y, z };
  }
  ///@}

  ///@{
  /**
   * Shadows, ambient occlusion, mirrors and samples; memory organization, sizes and threads.
   */
  void SetLightOptions(vtkPVDSMLightOptions* options);
  void SetMemoryOptions(vtkPVDSMMemoryOptions* options);
  ///@}

  /**
   * This rank's part of the surface; polygons of blocks that are hidden are left out, those of blocks that look
   * alike are together, with a vtkPVDSMExportLook.
   */
  std::vector<vtkSmartPointer<vtkPolyData>> GetTriangles() override;

  /**
   * Sets the object that reports the view's frames; null on the client.
   */
  void SetFrameReport(vtkPVDSMFrameReport* report);

protected:
  vtkPVDSMGeometryRepresentation();
  ~vtkPVDSMGeometryRepresentation() override;

  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  bool AddToView(vtkView* view) override;
  bool RemoveFromView(vtkView* view) override;
  void UpdateColoringParameters() override;
  /// Its data are not redistributed.
  bool NeedsOrderedCompositing() override { return false; }

  ///@{
  /// Parts of ProcessViewRequest.
  virtual void PrepareUpdate(vtkInformation* inInfo, vtkInformation* outInfo);
  virtual void PrepareRender(vtkInformation* inInfo);
  ///@}
  /// Gives the mapper the surface, and the look of its blocks.
  void PrepareSurface();
  /// Returns this rank's surface, in blocks; may be null.
  vtkDataObject* GetSurface() { return this->vtkGeometryRepresentation::GetRenderedDataObject(0); }
  /// Returns the bounds of what is shown of this rank's data, without the transform.
  virtual vtkBoundingBox GetShownBounds();
  /// Returns whether any shown data let light through: the same on every rank.
  virtual bool IsTranslucent();
  /// Returns what selections draw of this rank's data; may be null.
  virtual vtkSmartPointer<vtkDataObject> MakeSelectable();
  /// Gives an actor, which exporters are to have, the look of what is traced.
  virtual void SetExportLook(vtkActor* actor, vtkMapper* mapper);
  vtkDSMPolyDataMapper* GetMapper() const;
  vtkDSMMeshDisplayMapper* GetMeshMapper() const override;

  std::unique_ptr<vtkPVDSMTracedDisplay> Display;

private:
  vtkPVDSMGeometryRepresentation(const vtkPVDSMGeometryRepresentation&) = delete;
  void operator=(const vtkPVDSMGeometryRepresentation&) = delete;

  bool ShowEdges = false;
};

#endif
