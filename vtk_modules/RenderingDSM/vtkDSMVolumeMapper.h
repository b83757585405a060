// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMVolumeMapper
 * @brief   ray traces isosurfaces of a volume that is spread over the ranks
 *
 * Used by a vtkVolume, which gives its transform and visibility. The input is this rank's part of
 * the dataset: vtkImageData, or a composite dataset of images, or nothing. What the surfaces look
 * like comes from the mapper's surface property, a vtkProperty; the vtkVolume's own vtkVolumeProperty
 * is not used.
 *
 * The mapper draws nothing itself: the renderer's vtkDSMScene traces all of its volumes together
 * when the renderer starts to render, on all ranks at once. Every rank must have the same volumes, in
 * the same order, with the same settings; only the input differs.
 */

#ifndef vtkDSMVolumeMapper_h
#define vtkDSMVolumeMapper_h

#include "vtkAbstractVolumeMapper.h"
#include "vtkRenderingDSMModule.h" // for the export macro
#include "vtkSmartPointer.h"       // for ivars

#include <string> // for ivars
#include <vector> // for ivars

class vtkDSMLightOptions;
class vtkDSMMemoryOptions;
class vtkProperty;
class vtkScalarsToColors;

class VTKRENDERINGDSM_EXPORT vtkDSMVolumeMapper : public vtkAbstractVolumeMapper
{
public:
  static vtkDSMVolumeMapper* New();
  vtkTypeMacro(vtkDSMVolumeMapper, vtkAbstractVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * This rank's part of the dataset; null where there is none.
   */
  void SetInputData(vtkDataObject* data);

  ///@{
  /**
   * The point array whose isosurfaces are drawn. Empty (the default) means the active scalars.
   */
  vtkSetMacro(IsoArray, std::string);
  vtkGetMacro(IsoArray, std::string);
  ///@}

  ///@{
  /**
   * The array's component; -1, or the number of components, is the magnitude. Default 0.
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
   * The point array that colours the surfaces through the lookup table, when ScalarVisibility is on
   * (off by default). For an array of several components, the lookup table's vector mode and vector
   * component choose what is shown.
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
   * As in vtkVolumeMapper: whether surfaces are shown in some of 27 boxes only, the planes that
   * separate them (x min, x max, y min, y max, z min, z max, in the data's coordinates, without the
   * volume's transform), and which boxes those are (bit x + 3 y + 9 z; by default the middle one).
   * Off by default. The mapper's clipping planes, which are in world coordinates, cut as well.
   */
  vtkSetMacro(Cropping, bool);
  vtkGetMacro(Cropping, bool);
  vtkBooleanMacro(Cropping, bool);
  vtkSetVector6Macro(CroppingRegionPlanes, double);
  vtkGetVectorMacro(CroppingRegionPlanes, double, 6);
  vtkSetClampMacro(CroppingRegionFlags, int, 0x0, 0x7ffffff);
  vtkGetMacro(CroppingRegionFlags, int);
  ///@}

  /**
   * Colours and coefficients of the surfaces; never null.
   */
  vtkProperty* GetSurfaceProperty() const;

  ///@{
  /**
   * Shadows, ambient occlusion, mirrors and samples; never null. Null makes new ones.
   */
  void SetLightOptions(vtkDSMLightOptions* options);
  vtkDSMLightOptions* GetLightOptions() const;
  ///@}

  ///@{
  /**
   * Memory organisation, sizes and threads; never null. Null makes new ones.
   */
  void SetMemoryOptions(vtkDSMMemoryOptions* options);
  vtkDSMMemoryOptions* GetMemoryOptions() const;
  ///@}

  ///@{
  /**
   * Bounds of all ranks' data, without the volume's transform. Until the scene has taken in the data,
   * those of this rank's; null where there are none.
   */
  using vtkAbstractVolumeMapper::GetBounds;
  double* GetBounds() VTK_SIZEHINT(6) override;
  ///@}

  /**
   * For the scene, which knows all ranks' bounds.
   */
  void SetGlobalBounds(const double bounds[6]);

  /**
   * Brings the input up to date; each rank asks its pipeline for its own piece.
   */
  using vtkAbstractVolumeMapper::Update;
  void UpdatePiece(int piece, int numberOfPieces);

  /**
   * Does nothing: the scene's vtkDSMFrameProp draws.
   */
  void Render(vtkRenderer* renderer, vtkVolume* volume) override;

  vtkMTimeType GetMTime() override;

protected:
  vtkDSMVolumeMapper();
  ~vtkDSMVolumeMapper() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkDSMVolumeMapper(const vtkDSMVolumeMapper&) = delete;
  void operator=(const vtkDSMVolumeMapper&) = delete;

  std::string IsoArray;
  int IsoComponent = 0;
  std::vector<double> IsoValues;
  std::string ColorArray;
  bool ScalarVisibility = false;
  bool Cropping = false;
  double CroppingRegionPlanes[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  int CroppingRegionFlags = 1 << 13; // the middle box
  vtkSmartPointer<vtkScalarsToColors> LookupTable;
  vtkSmartPointer<vtkProperty> SurfaceProperty;
  vtkSmartPointer<vtkDSMLightOptions> LightOptions;
  vtkSmartPointer<vtkDSMMemoryOptions> MemoryOptions;
  double GlobalBounds[6];
};

#endif
