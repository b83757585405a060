// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMImageRepresentation
 * @brief   shows isosurfaces of image data, ray traced by all ranks
 *
 * Holds the input and a vtkVolume with a vtkDSMVolumeMapper, and keeps the view's vtkDSMScene alive
 * on the processes that render. The data never leave the rank: what is delivered is an empty
 * placeholder, and the view is asked to render where the data are.
 *
 * Of ParaView's volume representation, it needs nothing but the method GetActor, which Python asks all that shows data
 * for when a scene is exported for vtk.js. The actor is in no view.
 */

#ifndef vtkPVDSMImageRepresentation_h
#define vtkPVDSMImageRepresentation_h

#include "vtkGeometryRepresentationWithFaces.h" // for ivars
#include "vtkNew.h"                             // for ivars
#include "vtkPVDSMExportSource.h"
#include "vtkPVDSMSlicing.h"             // for ivars
#include "vtkPVDSMTracedDisplay.h"       // for ivars
#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkVolumeRepresentation.h"

#include <array>   // for ivars
#include <memory>  // for ivars
#include <string>  // for ivars
#include <utility> // for ivars
#include <vector>  // for ivars

class vtkDSMVolumeMapper;
class vtkDataObject;
class vtkPVDSMFrameReport;
class vtkPVDSMLightOptions;
class vtkPVDSMMemoryOptions;
class vtkPVDSMVolumePlaces;
class vtkPolyData;
class vtkProperty;
class vtkScalarsToColors;
class vtkVolume;

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMImageRepresentation
  : public vtkVolumeRepresentation
  , public vtkPVDSMExportSource
{
public:
  static vtkPVDSMImageRepresentation* New();
  vtkTypeMacro(vtkPVDSMImageRepresentation, vtkVolumeRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo) override;
  void SetVisibility(bool visible) override;
  void SetPickable(bool pickable) { this->Display->SetPickable(pickable); }
  /**
   * The blocks that are shown, with ParaView's numbers of them: what the panel offers to color by.
   */
  vtkDataObject* GetRenderedDataObject(int port) override;

  ///@{
  /**
   * What is shown of a dataset of several blocks: those that one of these paths leads to, as ParaView's
   * Multiblock Inspector chooses them; without any, all.
   */
  void AddBlockSelector(const char* selector);
  void RemoveAllBlockSelectors();
  ///@}

  ///@{
  /**
   * Colors and opacities of the blocks that a path leads to, in place of the surfaces'; later ones count.
   */
  void SetBlockColor(const char* selector, double r, double g, double b);
  void RemoveAllBlockColors();
  void SetBlockOpacity(const char* selector, double opacity);
  void RemoveAllBlockOpacities();
  ///@}

  /**
   * So many colors take turns where ParaView's array vtkBlockColors colors the blocks, as it numbers them.
   */
  void SetBlockColorsDistinctValues(int number);
  /**
   * Index 0: the array that colors the surfaces, of points or of cells; one of the whole dataset colors each block by
   * the first value that it has there.
   */
  void SetInputArrayToProcess(
    int index, int port, int connection, int association, const char* name) override;
  using Superclass::SetInputArrayToProcess;

  ///@{
  /**
   * Forwarded to vtkDSMVolumeMapper.
   */
  void SelectIsoArray(int index, int port, int connection, int association, const char* name);
  void SetIsoComponent(int component);
  void SetLookupTable(vtkScalarsToColors* table);
  void SetMapScalars(bool map);
  ///@}

  ///@{
  /**
   * What isosurfaces are shown: those of a list of values; while it is empty, the one of a value that the data suggest
   * (default), or, where it is not automatic, the one of the single value.
   */
  void SetNumberOfIsoValues(int number);
  void SetIsoValue(int index, double value);
  void SetSingleIsoValue(double value);
  void SetAutomaticIsoValue(bool automatic);
  ///@}

  ///@{
  /**
   * Forwarded to the surfaces' vtkProperty.
   */
  void SetAmbientColor(double r, double g, double b);
  void SetDiffuseColor(double r, double g, double b);
  void SetSpecularColor(double r, double g, double b);
  void SetAmbient(double value);
  void SetDiffuse(double value);
  void SetSpecular(double value);
  void SetSpecularPower(double value);
  void SetOpacity(double value);
  void SetInterpolation(int value);
  ///@}

  ///@{
  /**
   * How the sides of the surfaces look where values are above the isovalue, as of vtkGeometryRepresentationWithFaces: as the
   * others, not at all, they alone, or in a color and with an opacity of their own.
   */
  void SetBackfaceRepresentation(int representation);
  void SetBackfaceAmbientColor(double r, double g, double b);
  void SetBackfaceDiffuseColor(double r, double g, double b);
  void SetBackfaceOpacity(double value);
  ///@}

  ///@{
  /**
   * Forwarded to vtkVolume.
   */
  void SetPosition(double x, double y, double z);
  void SetOrientation(double x, double y, double z);
  void SetOrigin(double x, double y, double z);
  void SetScale(double x, double y, double z);
  void SetUserTransform(const double matrix[16]);
  ///@}

  ///@{
  /**
   * What is shown of the dataset: the side of a plane (world coordinates) that its normal points to,
   * the inside of a box (x, y and z from, to; in the dataset's coordinates), which may be moved, turned
   * and scaled.
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
   * Whether the faces that the plane and the box cut are shown, of isosurfaces on which side (vtkDSMVolumeMapper::CapSides),
   * of volumes whether with the opacities of their opacity function.
   */
  void SetCap(bool cap);
  void SetCapSide(int side);
  void SetCapOpacityFromMap(bool fromMap);
  ///@}

  ///@{
  /**
   * The slices that vtkPVDSMSliceRepresentation shows: for each axis one by its index (of the samples, from 0), and a list
   * of further ones; and a plane in world coordinates.
   */
  void SetSliceX(bool isShown) { this->Slicing.Axes[0].IsShown = isShown; }
  void SetSliceY(bool isShown) { this->Slicing.Axes[1].IsShown = isShown; }
  void SetSliceZ(bool isShown) { this->Slicing.Axes[2].IsShown = isShown; }
  void SetSliceXIndex(int index) { this->Slicing.Axes[0].Index = index; }
  void SetSliceYIndex(int index) { this->Slicing.Axes[1].Index = index; }
  void SetSliceZIndex(int index) { this->Slicing.Axes[2].Index = index; }
  void AddSliceX(int index) { this->Slicing.Axes[0].Further.push_back(index); }
  void AddSliceY(int index) { this->Slicing.Axes[1].Further.push_back(index); }
  void AddSliceZ(int index) { this->Slicing.Axes[2].Further.push_back(index); }
  void RemoveSlicesX() { this->Slicing.Axes[0].Further.clear(); }
  void RemoveSlicesY() { this->Slicing.Axes[1].Further.clear(); }
  void RemoveSlicesZ() { this->Slicing.Axes[2].Further.clear(); }
  void SetSlicePlane(bool isShown) { this->Slicing.HasPlane = isShown; }
  void SetSliceOrigin(double x, double y, double z) { this->Slicing.Origin = { x, y, z }; }
  void SetSliceNormal(double x, double y, double z) { this->Slicing.Normal = { x, y, z }; }
  ///@}

  ///@{
  /**
   * Shadows, ambient occlusion, mirrors and samples; memory organization, sizes and threads.
   */
  void SetLightOptions(vtkPVDSMLightOptions* options);
  void SetMemoryOptions(vtkPVDSMMemoryOptions* options);
  ///@}

  /**
   * The isosurfaces of this rank's data as triangles, with the array that colors them; those of blocks that look alike
   * together, with a vtkPVDSMExportLook.
   */
  std::vector<vtkSmartPointer<vtkPolyData>> GetTriangles() override;

  /**
   * What shall tell of the view's frames; null on the client.
   */
  void SetFrameReport(vtkPVDSMFrameReport* report);

protected:
  vtkPVDSMImageRepresentation();
  ~vtkPVDSMImageRepresentation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  bool AddToView(vtkView* view) override;
  bool RemoveFromView(vtkView* view) override;
  /// Returns whether any shown data let light through: the same on every rank.
  virtual bool IsTranslucent() const;
  /// For constructors: selections find the places that the pixels of a picture show, and no isosurfaces.
  void SelectByPlaces();

  vtkNew<vtkVolume> Volume;
  vtkNew<vtkDSMVolumeMapper> Mapper;

private:
  vtkPVDSMImageRepresentation(const vtkPVDSMImageRepresentation&) = delete;
  void operator=(const vtkPVDSMImageRepresentation&) = delete;

  /// Shows a copy of the structure of `source`, which may be null.
  void TakeInput(vtkDataObject* source);
  /// Implements ProcessViewRequest, and returns its result.
  int Process(vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo);
  /// What selections draw, of this rank's part of the dataset, which may be null.
  vtkSmartPointer<vtkDataObject> MakeSelectable(vtkDataObject* data);
  void ChooseIsoValues();
  /// Tells the mapper, whose surfaces' look may have changed since.
  void ChooseBackfaces();
  void RemoveHiddenBlocks(vtkDataObject* data) const;
  /// Tells the mapper how the blocks look that its data have now.
  void ChooseBlockLooks();
  void ColorBlocksByArray(vtkDataObject* data);

  vtkNew<vtkProperty> BackfaceProperty;
  int BackfaceRepresentation = vtkGeometryRepresentationWithFaces::FOLLOW_FRONTFACE;
  std::vector<std::string> BlockSelectors;
  std::vector<std::pair<std::string, std::array<double, 3>>> BlockColors;
  std::vector<std::pair<std::string, double>> BlockOpacities;
  int BlockColorsDistinctValues = 7;
  std::string BlockArray; ///< that colors whole blocks; empty: none
  bool BlockLooksAreOld = true;
  std::vector<double> IsoValues;
  double SingleIsoValue = 0.0;
  bool AutomaticIsoValue = true;
  vtkPVDSMSlicing Slicing;
  std::unique_ptr<vtkPVDSMTracedDisplay> Display;
  std::unique_ptr<vtkPVDSMVolumePlaces> Places; ///< null: selections draw isosurfaces
};

#endif
