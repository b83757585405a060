// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMImageRepresentation
 * @brief   shows isosurfaces of grids of values, or their outer surface, ray traced by all ranks
 *
 * The outer surface is its superclass's. Isosurfaces are those of a vtkVolume with a vtkDSMVolumeMapper, which has a
 * shallow copy of the input. One of the two is shown; the other takes no time and holds no data.
 */

#ifndef vtkPVDSMImageRepresentation_h
#define vtkPVDSMImageRepresentation_h

#include "vtkNew.h"          // for ivars
#include "vtkPVDSMSlicing.h" // for ivars
#include "vtkPVDSMVolumeDisplay.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro

#include <array>   // for ivars
#include <memory>  // for ivars
#include <string>  // for ivars
#include <utility> // for ivars
#include <vector>  // for ivars

class vtkDSMVolumeMapper;
class vtkDataObject;
class vtkPVDSMVolumePlaces;
class vtkScalarsToColors;
class vtkVolume;

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMImageRepresentation : public vtkPVDSMVolumeDisplay
{
public:
  static vtkPVDSMImageRepresentation* New();
  vtkTypeMacro(vtkPVDSMImageRepresentation, vtkPVDSMVolumeDisplay);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum ShownParts
  {
    SHOW_ISOSURFACES = 0,
    SHOW_SURFACE = 1
  };
  /**
   * Shows the dataset's isosurfaces (the default) or its outer surface.
   */
  void SetShow(int part);

  void SetVisibility(bool visible) override;
  /**
   * The blocks that are shown, with ParaView's numbers of them: what the panel offers to color by.
   */
  vtkDataObject* GetRenderedDataObject(int port) override;

  ///@{
  /**
   * The visible blocks of a dataset: those that one of these paths leads to, as ParaView's Multiblock Inspector
   * chooses them. Without any path, all blocks are visible.
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
   * Number of colors that take turns if ParaView's array vtkBlockColors colors the blocks, as it numbers them.
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
  void SetLookupTable(vtkScalarsToColors* table) override;
  void SetMapScalars(int map) override;
  ///@}

  ///@{
  /**
   * The visible isosurfaces: those of a list of values. If the list is empty, the one isosurface of a value that
   * the data suggest (default), or of the single value if that is not automatic.
   */
  void SetNumberOfIsoValues(int number);
  void SetIsoValue(int index, double value);
  void SetSingleIsoValue(double value);
  void SetAutomaticIsoValue(bool automatic);
  ///@}

  ///@{
  /**
   * Forwarded to vtkVolume, too.
   */
  void SetPosition(double x, double y, double z) override;
  void SetOrientation(double x, double y, double z) override;
  void SetOrigin(double x, double y, double z) override;
  void SetScale(double x, double y, double z) override;
  void SetUserTransform(const double matrix[16]) override;
  ///@}

  ///@{
  /**
   * The slices that vtkPVDSMSliceRepresentation shows: for each axis one by its index (of the samples, from 0), and
   * a list of further ones; and a plane in world coordinates.
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
   * Sets the object that reports the view's frames; null on the client.
   */
  void SetFrameReport(vtkPVDSMFrameReport* report);

protected:
  vtkPVDSMImageRepresentation();
  ~vtkPVDSMImageRepresentation() override;

  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  void PrepareUpdate(vtkInformation* inInfo, vtkInformation* outInfo) override;
  void PrepareRender(vtkInformation* inInfo) override;
  bool IsTranslucent() override;
  vtkSmartPointer<vtkDataObject> MakeSelectable() override;
  void SetExportLook(vtkActor* actor, vtkMapper* mapper) override;
  vtkBoundingBox GetShownBounds() override;
  bool ShowsSurface() const { return this->Shown == SHOW_SURFACE; }
  virtual void ShowVolume();
  /// Shows a copy of the structure of `source`, which may be null.
  void TakeInput(vtkDataObject* source);
  /// Returns the part of the shown blocks, which may be null, that the volume's mapper gets. May be null.
  virtual vtkSmartPointer<vtkDataObject> ChooseVolumes(vtkDataObject* shown);
  /// Fills the superclass's copy of the input, which ReleaseSurface has emptied.
  void RestoreSurfaceInput(vtkDataObject* data);
  /// For constructors: selections find the places that the pixels of a picture show, and no isosurfaces.
  void SelectByPlaces();
  vtkDSMVolumeDisplayMapper* GetVolumeMapper() const override;

  vtkNew<vtkVolume> Volume;
  vtkNew<vtkDSMVolumeMapper> VolumeMapper;

private:
  vtkPVDSMImageRepresentation(const vtkPVDSMImageRepresentation&) = delete;
  void operator=(const vtkPVDSMImageRepresentation&) = delete;

  void ReleaseSurface();
  void ChooseIsoValues();
  /// Gives the surfaces the coefficients of the superclass, and their backs their look.
  void ChooseLook();
  void RemoveHiddenBlocks(vtkDataObject* data) const;
  /// Gives the mapper the looks of the blocks in its current data.
  void ChooseBlockLooks();
  void ColorBlocksByArray(vtkDataObject* data);
  /// Null without an input.
  vtkDataObject* FindInput();
  void PrepareSelection(vtkDSMScene* scene, bool selecting);

  int Shown = SHOW_ISOSURFACES;
  // The isosurfaces' own blocks: a later choice for a block replaces an earlier one.
  std::vector<std::string> ShownBlocks;
  std::vector<std::pair<std::string, std::array<double, 3>>> ColorsOfBlocks;
  std::vector<std::pair<std::string, double>> OpacitiesOfBlocks;
  int BlockColorsDistinctValues = 7;
  std::string BlockArray; ///< that colors whole blocks; empty: none
  bool BlockLooksAreOld = true;
  std::vector<double> IsoValues;
  double SingleIsoValue = 0.0;
  bool AutomaticIsoValue = true;
  vtkPVDSMSlicing Slicing;
  std::unique_ptr<vtkPVDSMVolumePlaces> Places; ///< null: selections draw isosurfaces
  vtkSmartPointer<vtkDataObject> Selectable;    ///< isosurfaces, while ParaView selects
};

#endif
