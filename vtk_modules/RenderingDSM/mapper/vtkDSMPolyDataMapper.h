// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMPolyDataMapper
 * @brief   ray traces polygons, lines and points that are spread over the ranks
 *
 * Used by a vtkActor in place of any other vtkPolyDataMapper. The input is this rank's part of the dataset:
 * vtkPolyData, or a composite dataset of vtkPolyData, or nothing. Its look comes from the actor's property and
 * backface property and from the mapper's own settings, as usual: ScalarVisibility, ScalarMode, the color array
 * (SelectColorArray), ColorMode, LookupTable, UseLookupTableScalarRange and ScalarRange,
 * InterpolateScalarsBeforeMapping, Static. Culling, interpolation (flat, or by the points' normals), opacity and
 * lighting are the property's. A property's representation (points, wireframe) is not used. With EdgeVisibility,
 * the edges of the input's polygons are drawn on the surface, in EdgeColor and LineWidth pixels wide. The actor's
 * texture, whole on every rank, is laid on the surface by its texture coordinates.
 *
 * Values are mapped to colors where a ray meets the surface, so a change of the color map, the
 * material, the edges or the actor's matrix takes effect at once; a change of points, cells, the
 * color array or a block's look puts the mesh in bricks anew, and so does EdgeVisibility the first
 * time that it is on, where there are polygons other than triangles.
 *
 * vtkDSMMeshDisplayMapper has the settings that ParaView's displays have as properties.
 *
 * The mapper draws nothing itself: the renderer's vtkDSMScene traces all that it shows together when
 * the renderer starts to render, on all ranks at once. Every rank must have the same actors, in the
 * same order, with the same settings; only the input differs.
 */

#ifndef vtkDSMPolyDataMapper_h
#define vtkDSMPolyDataMapper_h

#include "vtkDSMMeshDisplayMapper.h"
#include "vtkRenderingDSMModule.h" // for the export macro
#include "vtkSmartPointer.h"       // for ivars

#include <memory> // for ivars

class vtkCompositeDataDisplayAttributes;
class vtkDSMKnownBounds;
class vtkDSMLightOptions;
class vtkDSMMemoryOptions;
class vtkDSMOriginalData;

class VTKRENDERINGDSM_EXPORT vtkDSMPolyDataMapper : public vtkDSMMeshDisplayMapper
{
public:
  static vtkDSMPolyDataMapper* New();
  vtkTypeMacro(vtkDSMPolyDataMapper, vtkDSMMeshDisplayMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Set this if the input is a copy or a part of a pipeline's data: the original, which is not kept alive. Once
   * that has changed, the mapper's data are old. If another mapper shows the new data, and there is room for one of
   * both only, the bricks of the old data go first.
   */
  void SetOriginalData(vtkDataObject* data);
  bool HasOldData() const;
  ///@}

  ///@{
  /**
   * Visibility, color and opacity of the blocks of a composite dataset, by their data objects, for
   * blocks in blocks as well. Null (the default): all blocks are alike.
   */
  void SetCompositeDataDisplayAttributes(vtkCompositeDataDisplayAttributes* attributes);
  vtkCompositeDataDisplayAttributes* GetCompositeDataDisplayAttributes() const;
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
   * Bounds of all ranks' data, without the actor's transform. Until the scene has taken in the data, and
   * when they have changed since, those of this rank's.
   */
  using vtkPolyDataMapper::GetBounds;
  double* GetBounds() VTK_SIZEHINT(6) override;
  ///@}

  /**
   * For the scene, which knows all ranks' bounds. Invokes vtkCommand::UpdateDataEvent.
   */
  void SetGlobalBounds(const double bounds[6]);

  /**
   * Brings the input up to date, unless the mapper is static. Each rank asks its pipeline for its own
   * piece, unless the application has chosen one with SetPiece and SetNumberOfPieces.
   */
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

  /**
   * Draws nothing: the scene's vtkDSMFrameProp does. The first time, see MakesScene.
   */
  void Render(vtkRenderer* renderer, vtkActor* actor) override;

  ///@{
  /**
   * Not OpenGL's to draw, neither before nor after translucent props.
   */
  bool HasOpaqueGeometry() override { return true; }
  bool HasTranslucentPolygonalGeometry() override { return false; }
  ///@}

  /**
   * Copies all that a mapper of this class has beyond vtkPolyDataMapper, too; shares its options and attributes of
   * blocks.
   */
  void ShallowCopy(vtkAbstractMapper* mapper) override;

protected:
  vtkDSMPolyDataMapper();
  ~vtkDSMPolyDataMapper() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkDSMPolyDataMapper(const vtkDSMPolyDataMapper&) = delete;
  void operator=(const vtkDSMPolyDataMapper&) = delete;

  vtkSmartPointer<vtkCompositeDataDisplayAttributes> BlockAttributes;
  bool MakesScene = true;
  vtkSmartPointer<vtkDSMLightOptions> LightOptions;
  vtkSmartPointer<vtkDSMMemoryOptions> MemoryOptions;
  std::unique_ptr<vtkDSMKnownBounds> GlobalBounds;
  std::unique_ptr<vtkDSMOriginalData> Original;
};

#endif
