// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMVolumeMapper
 * @brief   ray traces a volume that is spread over the ranks, or isosurfaces of it
 *
 * Used by a vtkVolume, which gives its transform and visibility. The input is this rank's part of
 * the dataset: vtkImageData, vtkRectilinearGrid, vtkStructuredGrid, vtkUnstructuredGrid, vtkHyperTreeGrid, AMR, a
 * composite dataset whose blocks are any of these but AMR, or nothing. Ranks may have different ones. Other blocks, and
 * cells without a volume, are not shown.
 *
 * It stands in for vtkGPUVolumeRayCastMapper, for AMR for vtkAMRVolumeMapper, and for
 * vtkUnstructuredGridVolumeMapper: the blend mode Composite (the default) shows the volume as a medium, by the color
 * and opacity functions and the unit distance of the vtkVolume's vtkVolumeProperty. Maximum, minimum, average (of
 * AverageIPScalarRange) and additive show what they show there. ScalarMode and SelectScalarArray() choose the array.
 * In the blend mode Composite, the property's InterpolationType counts, and an IndexedLookup of its color function
 * makes categories; values of cells, of AMR and of hyper tree grids are trilinear always, and so are those of all other
 * modes. Curvilinear and unstructured grids are split into tetrahedra, in which values are linear always. Shading is
 * VTK's, also gradient opacity and two-dimensional transfer functions; with shadows and ambient occlusion of the light
 * options, volumes shade themselves.
 * The blend mode Slice is not supported; the mapper warns about it.
 *
 * With an isovalue, with AutomaticIsoValue or with SurfacesOnly, isosurfaces are shown instead. Isovalues and look are
 * the mapper's own: IsoArray, IsoValues, ColorArray, and a vtkProperty, the
 * surface property. After SetBlendModeToIsoSurface() they are instead where vtkGPUVolumeRayCastMapper
 * has them, which it then stands in for: ScalarMode and SelectScalarArray() choose the array, and
 * the vtkVolume's vtkVolumeProperty gives the isovalues (GetIsoSurfaceValues), and for each its color
 * and opacity by the transfer functions of the first component, and the shading. Interpolation is
 * trilinear always.
 *
 * With Slicing, planes through the volume are shown instead of the medium: AddSlice() and SlicePlanes. They are
 * colored as isosurfaces are: by the lookup table when ScalarVisibility is on. With Capping, the faces that clipping
 * planes cut out of isosurfaces and of the medium are shown, too.
 *
 * vtkVolumeMapper's cropping is honored; its planes are in the data's coordinates, without the volume's
 * transform. So are the mapper's clipping planes, which are in world coordinates.
 *
 * vtkDSMVolumeDisplayMapper has the settings that ParaView's displays have as properties.
 *
 * The mapper draws nothing itself: the renderer's vtkDSMScene traces all of its volumes together
 * when the renderer starts to render, on all ranks at once. Every rank must have the same volumes, in
 * the same order, with the same settings; only the input differs.
 */

#ifndef vtkDSMVolumeMapper_h
#define vtkDSMVolumeMapper_h

#include "vtkDSMVolumeDisplayMapper.h"
#include "vtkDSMVolumeSettings.h"  // for the base class
#include "vtkMath.h"               // for ivars
#include "vtkRenderingDSMModule.h" // for the export macro

#include <array>  // for SetSuggestedRange
#include <memory> // for ivars

class vtkDSMKnownBounds;
class vtkDSMOriginalData;
class vtkPlane;

class VTKRENDERINGDSM_EXPORT vtkDSMVolumeMapper
  : public vtkDSMVolumeDisplayMapper
  , private vtkDSMVolumeSettings
{
public:
  static vtkDSMVolumeMapper* New();
  vtkTypeMacro(vtkDSMVolumeMapper, vtkDSMVolumeDisplayMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * This rank's part of the dataset; null where there is none.
   */
  void SetInputData(vtkDataObject* data);

  /**
   * Returns whether a dataset that is not composite is a grid of values in three dimensions: what this mapper shows.
   */
  static bool IsVolume(vtkDataObject* data);

  ///@{
  /**
   * Set this if the input is a copy or a part of a pipeline's data: the original, which is not kept alive. Once
   * that has changed, the mapper's data are old. If another mapper shows the new data, and there is room for one of
   * both only, the bricks of the old data go first. Arrays that only left-out blocks have are not reported as
   * missing.
   */
  void SetOriginalData(vtkDataObject* data);
  vtkDataObject* GetOriginalData() const;
  bool HasOldData() const;
  ///@}

  /**
   * A blend mode beside those of vtkVolumeMapper: the integral of the values along each ray, over its length in world
   * space. vtkDSMScene::TraceImage gives the numbers. The colors that the color function has over the array's range
   * are spread over the integrals that there can be: from 0, or the smallest value if it is negative, to the largest
   * value, both times the diagonal of the bounds. The opacity function has no effect.
   */
  static constexpr int INTEGRAL_BLEND = 100;
  void SetBlendModeToIntegral() { this->SetBlendMode(INTEGRAL_BLEND); }

  ///@{
  /**
   * The array whose isosurfaces are drawn. Empty (the default) means the active scalars of the points or, without
   * any, those of the cells.
   */
  vtkSetMacro(IsoArray, std::string);
  vtkGetMacro(IsoArray, std::string);
  ///@}

  ///@{
  /**
   * If true, IsoArray names an array of the cells, not of the points. Off by default. The value of a point is the
   * mean of the cells around it, as vtkCellDataToPointData makes it.
   */
  vtkSetMacro(IsoArrayOnCells, bool);
  vtkGetMacro(IsoArrayOnCells, bool);
  ///@}

  ///@{
  /**
   * The array's component; -1, or the number of components, is the magnitude. Default 0: for a volume, in the blend
   * mode composite, all components as its property's IndependentComponents and ComponentWeight say, as
   * vtkGPUVolumeRayCastMapper does. With three, or more than four, that depend on one another, an error says so.
   */
  vtkSetMacro(IsoComponent, int);
  vtkGetMacro(IsoComponent, int);
  ///@}

  ///@{
  /**
   * The isovalues, in any order.
   */
  void SetNumberOfIsoValues(int number);
  int GetNumberOfIsoValues() const;
  void SetIsoValue(int index, double value);
  double GetIsoValue(int index) const;
  ///@}

  ///@{
  /**
   * If true, the mapper draws the surface of a value that the data suggest while there are no isovalues. Off by
   * default. The same value for any number of ranks. When the array's data change, the value stays if the new data
   * have a surface there, and share at least half of their range of values with the data that suggested it. Time
   * steps usually do. Otherwise the new data suggest another.
   */
  vtkSetMacro(AutomaticIsoValue, bool);
  vtkGetMacro(AutomaticIsoValue, bool);
  vtkBooleanMacro(AutomaticIsoValue, bool);
  ///@}

  /**
   * The value that the data of the last frame suggest, whether it is drawn or not. Not a number before
   * the first frame, and where the data have no surface at any value.
   */
  vtkGetMacro(SuggestedIsoValue, double);

  /**
   * Range of the values of the last frame, if the array has fill values that nothing declares (such as 1e20, or
   * -32768 where the others are far from it). They do not count for SuggestedIsoValue. Not a number before the
   * first frame, and where there are none.
   */
  vtkGetVector2Macro(SuggestedRange, double);

  ///@{
  /**
   * If true, the mapper shows nothing but isosurfaces, also while there are no isovalues. Off by default: then a
   * mapper without isovalues shows the volume as its blend mode says.
   */
  vtkSetMacro(SurfacesOnly, bool);
  vtkGetMacro(SurfacesOnly, bool);
  vtkBooleanMacro(SurfacesOnly, bool);
  ///@}

  ///@{
  /**
   * The array, of points or of cells, and its component (-1: its magnitude), whose values the opacity function
   * maps; the color function maps those that are shown else. Empty (the default): both map the same.
   */
  vtkSetMacro(OpacityArray, std::string);
  vtkGetMacro(OpacityArray, std::string);
  vtkSetMacro(OpacityArrayOnCells, bool);
  vtkGetMacro(OpacityArrayOnCells, bool);
  vtkSetMacro(OpacityComponent, int);
  vtkGetMacro(OpacityComponent, int);
  ///@}

  ///@{
  /**
   * The array that is the second axis of the property's two-dimensional transfer function, and its component (-1: its
   * magnitude). An array of points comes before one of cells of the same name. Null (the default): the length of the
   * gradient is the second axis. As in vtkGPUVolumeRayCastMapper, the function's image covers the ranges of both
   * arrays. It covers gradients by which values grow in a cell of mean size by up to a quarter of their range.
   * Ranges are those of all ranks. Opacities are those of the unit distance.
   */
  void SetTransfer2DYAxisArray(const char* name);
  const char* GetTransfer2DYAxisArray() const;
  vtkSetMacro(Transfer2DYAxisComponent, int);
  vtkGetMacro(Transfer2DYAxisComponent, int);
  ///@}

  ///@{
  /**
   * The part of a volume's look that is light scattered once towards the viewer, from 0 to 1; the rest is as the
   * property says: shaded, or the color itself. The property's ScatteringAnisotropy tells where light is scattered
   * to. Shadows are those of the light options. 0 by default.
   */
  vtkSetClampMacro(Scattering, double, 0.0, 1.0);
  vtkGetMacro(Scattering, double);
  ///@}

  ///@{
  /**
   * If true, the mapper shows planes through the volume, and not the medium. Off by default. Isosurfaces are shown
   * with them if there are isovalues. Planes have the color of the array ColorArray; while ScalarVisibility is on
   * and ColorArray is empty, of the array IsoArray; while it is off, of the surface property, which gives their
   * opacity in any case.
   */
  vtkSetMacro(Slicing, bool);
  vtkGetMacro(Slicing, bool);
  vtkBooleanMacro(Slicing, bool);
  ///@}

  ///@{
  /**
   * Slices along the volume's axes, through its samples: `axis` is 0, 1 or 2, and `index` counts samples along it,
   * from 0; a negative one is the middle of the volume. Slices of the same place are one. A slice
   * outside of the volume is reported and not shown.
   */
  void AddSlice(int axis, int index);
  void RemoveAllSlices();
  int GetNumberOfSlices() const { return static_cast<int>(this->Slices.size()); }
  int GetSliceAxis(int number) const { return this->Slices.at(number).first; }
  int GetSliceIndex(int number) const { return this->Slices.at(number).second; }
  ///@}

  /**
   * Number of samples along each axis that the slices of the last frame may have the index of: the
   * most of all parts of the data. Zeros before the first frame with slices.
   */
  vtkGetVector3Macro(SlicePoints, int);

  ///@{
  /**
   * Planes in world coordinates that are slices, too; their transforms as functions are ignored, as those of clipping
   * planes are. Null (the default): none. Kept, not copied.
   */
  void SetSlicePlanes(vtkPlaneCollection* planes);
  vtkPlaneCollection* GetSlicePlanes() const;
  void AddSlicePlane(vtkPlane* plane);
  void RemoveAllSlicePlanes();
  ///@}

  ///@{
  /**
   * The opacity of slices by the values that color them, times that of the surface property. Null (the default): that
   * of the lookup table.
   */
  void SetSliceOpacity(vtkPiecewiseFunction* function);
  vtkPiecewiseFunction* GetSliceOpacity() const;
  ///@}

  ///@{
  /**
   * The array that colors the surfaces through the lookup table, when ScalarVisibility is on
   * (off by default). For an array of several components, the lookup table's vector mode and vector
   * component choose what is shown. Values of points are interpolated.
   */
  vtkSetMacro(ColorArray, std::string);
  vtkGetMacro(ColorArray, std::string);
  vtkSetMacro(ScalarVisibility, bool);
  vtkGetMacro(ScalarVisibility, bool);
  vtkBooleanMacro(ScalarVisibility, bool);
  void SetLookupTable(vtkScalarsToColors* table);
  vtkScalarsToColors* GetLookupTable() const;
  ///@}

  ///@{
  /**
   * If true, ColorArray names an array of the cells, not of the points. Off by default. A surface has in each cell
   * that it goes through the color of the cell's value.
   */
  vtkSetMacro(ColorArrayOnCells, bool);
  vtkGetMacro(ColorArrayOnCells, bool);
  ///@}

  ///@{
  /**
   * If true (the default), the color array's values become colors by the lookup table. Otherwise they are colors:
   * gray, gray and opacity, red, green and blue, or those and opacity, as vtkMapper takes them directly.
   */
  vtkSetMacro(MapScalars, bool);
  vtkGetMacro(MapScalars, bool);
  vtkBooleanMacro(MapScalars, bool);
  ///@}

  ///@{
  /**
   * How blocks of a composite dataset look that are not to look like the rest: their color, in place of that of the
   * surface property and of the color array; their opacity, in place of the property's; a value, by which the
   * lookup table colors the block while BlockScalarVisibility is on (off by default) and it has no color of its
   * own; and whether they are shown at all (the default). Blocks are numbered as vtkCompositeDataIterator does
   * (GetCurrentFlatIndex) in this rank's part of the dataset; a dataset that is one image is block 0. All of AMR
   * has the color and the opacity of block 0; where a block of AMR is hidden, cells of coarser ones are shown.
   */
  void SetBlockColor(unsigned int block, double r, double g, double b);
  void SetBlockOpacity(unsigned int block, double opacity);
  void SetBlockValue(unsigned int block, double value);
  void SetBlockVisibility(unsigned int block, bool visible);
  void RemoveBlockLooks();
  const vtkDSMBlockLooks& GetBlockLooks() const { return this->BlockLooks; }
  vtkSetMacro(BlockScalarVisibility, bool);
  vtkGetMacro(BlockScalarVisibility, bool);
  vtkBooleanMacro(BlockScalarVisibility, bool);
  ///@}

  ///@{
  /**
   * Colors and coefficients of the surfaces; never null. Null makes a new one. With flat interpolation, they are
   * lit by the normals of the surface that is in each cell; else by smooth ones. Front faces are the sides where
   * values are below the isovalue; what is culled lets light through, too.
   */
  void SetSurfaceProperty(vtkProperty* property);
  vtkProperty* GetSurfaceProperty() const;
  ///@}

  ///@{
  /**
   * Colors and coefficients of back faces; null (the default): they are as the others. Opacities of blocks count
   * for both.
   */
  void SetBackfaceProperty(vtkProperty* property);
  vtkProperty* GetBackfaceProperty() const;
  ///@}

  ///@{
  /**
   * Shadows, ambient occlusion, mirrors and samples; never null. Null makes new ones. All but the reflectivity are
   * forwarded to the scenes that draw the mapper (vtkDSMScene::GetLightOptions).
   */
  void SetLightOptions(vtkDSMLightOptions* options);
  vtkDSMLightOptions* GetLightOptions() const;
  ///@}

  ///@{
  /**
   * Memory organization, sizes and threads; never null. Null makes new ones. They are forwarded to the ranks that draw
   * the mapper.
   */
  void SetMemoryOptions(vtkDSMMemoryOptions* options);
  vtkDSMMemoryOptions* GetMemoryOptions() const;
  ///@}

  ///@{
  /**
   * Bounds of all ranks' data, without the volume's transform. Until the scene has taken in the data, and when they
   * have changed since, those of this rank's, or of the whole image that the pipeline announces before it makes it;
   * null if there are none.
   */
  using vtkVolumeMapper::GetBounds;
  double* GetBounds() VTK_SIZEHINT(6) override;
  ///@}

  /**
   * For the scene, which knows all ranks' bounds. Invokes vtkCommand::UpdateDataEvent.
   */
  void SetGlobalBounds(const double bounds[6]);
  void SetSuggestedIsoValue(double value);
  void SetSuggestedRange(const std::array<double, 2>& range);
  void SetSlicePoints(const std::array<int, 3>& points);

  /**
   * Brings the input up to date; each rank asks its pipeline for its own piece.
   */
  using vtkVolumeMapper::Update;
  void UpdatePiece(int piece, int numberOfPieces);

  ///@{
  /**
   * If true, the mapper makes the renderer's vtkDSMScene when it is first drawn and there is none; on by default.
   * In one process only: ranks must make it together, before the first frame.
   */
  vtkSetMacro(MakesScene, bool);
  vtkGetMacro(MakesScene, bool);
  vtkBooleanMacro(MakesScene, bool);
  ///@}

  ///@{
  /**
   * Settings of vtkGPUVolumeRayCastMapper (samples, graphics card) and of vtkAMRVolumeMapper (the uniform grid that
   * it resamples AMR to, the mapper that shows it). The mapper keeps them, and they have no effect: a ray finds the
   * exact place of the surface, vtkDSMMemoryOptions limits the memory, and AMR is shown at all of its levels.
   */
  enum RenderModes
  {
    DefaultRenderMode,
    RayCastAndTextureRenderMode,
    RayCastRenderMode,
    TextureRenderMode,
    GPURenderMode
  };
  void SetRequestedRenderModeToDefault() { this->SetRequestedRenderMode(DefaultRenderMode); }
  void SetRequestedRenderModeToRayCastAndTexture()
  {
    this->SetRequestedRenderMode(RayCastAndTextureRenderMode);
  }
  void SetRequestedRenderModeToRayCast() { this->SetRequestedRenderMode(RayCastRenderMode); }
  void SetRequestedRenderModeToTexture() { this->SetRequestedRenderMode(TextureRenderMode); }
  void SetRequestedRenderModeToGPU() { this->SetRequestedRenderMode(GPURenderMode); }
  void SetInterpolationModeToNearestNeighbor()
  {
    this->SetInterpolationMode(VTK_NEAREST_INTERPOLATION);
  }
  void SetInterpolationModeToLinear() { this->SetInterpolationMode(VTK_LINEAR_INTERPOLATION); }
  void SetInterpolationModeToCubic() { this->SetInterpolationMode(VTK_CUBIC_INTERPOLATION); }
  vtkSetVector3Macro(NumberOfSamples, int);
  vtkGetVector3Macro(NumberOfSamples, int);
  vtkBooleanMacro(AutoAdjustSampleDistances, vtkTypeBool);
  vtkBooleanMacro(LockSampleDistanceToInputSpacing, vtkTypeBool);
  vtkBooleanMacro(UseJittering, vtkTypeBool);
#define vtkDSMSetting(name, type, value)                                                           \
  vtkSetMacro(name, type);                                                                         \
  vtkGetMacro(name, type);
  VTK_DSM_KEPT_SETTINGS(vtkDSMSetting)
#undef vtkDSMSetting
  ///@}

  /**
   * Draws nothing: the scene's vtkDSMFrameProp does. The first time, see MakesScene.
   */
  void Render(vtkRenderer* renderer, vtkVolume* volume) override;

  vtkMTimeType GetMTime() override;

  /**
   * Copies all settings and the input of a mapper of this class, and shares its table of colors, properties and
   * options; copies from other volume mappers what they have as well.
   */
  void ShallowCopy(vtkAbstractMapper* mapper) override;

protected:
  vtkDSMVolumeMapper();
  ~vtkDSMVolumeMapper() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkDSMVolumeMapper(const vtkDSMVolumeMapper&) = delete;
  void operator=(const vtkDSMVolumeMapper&) = delete;

  void CopyVolumeMapper(vtkVolumeMapper* other);

  double SuggestedIsoValue = vtkMath::Nan();
  double SuggestedRange[2] = { vtkMath::Nan(), vtkMath::Nan() };
  int SlicePoints[3] = { 0, 0, 0 };
  int Pieces = 1; ///< as many as the input was last asked for
  std::unique_ptr<vtkDSMKnownBounds> GlobalBounds;
  std::unique_ptr<vtkDSMOriginalData> Original;
};

#endif
