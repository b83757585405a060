// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMFrameProp
 * @brief   writes traced tiles, color and depth, into the frame buffer
 *
 * Belongs to a vtkDSMScene, which adds it to the renderer. Local: each rank draws what it was given;
 * the compositing of the application merges the ranks' pictures by depth. Draws in the opaque pass,
 * or, surfaces that other objects may be between, in the translucent one; and not at all during a
 * selection pass.
 */

#ifndef vtkDSMFrameProp_h
#define vtkDSMFrameProp_h

#include "vtkProp.h"
#include "vtkRenderingDSMModule.h" // for the export macro

#include <memory> // for ivars

namespace rt
{
struct Picture;
}
class vtkMatrix4x4;

class VTKRENDERINGDSM_EXPORT vtkDSMFrameProp : public vtkProp
{
public:
  static vtkDSMFrameProp* New();
  vtkTypeMacro(vtkDSMFrameProp, vtkProp);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum class Drawing
  {
    All,
    DepthOnly, ///< which hides what lies behind
    SharedEdges ///< the nearest of several ranks' pictures counts, and all of them have the pixels that are covered
    ///< in part: each blends these with what it has behind them, and leaves that one's depth
  };

  /**
   * The frame to draw from now on, the projection it was traced with (without the model-view), and
   * the bounds of what it shows, on all ranks. An empty frame draws nothing.
   */
  void SetFrame(rt::Picture frame, vtkMatrix4x4* projection, const double bounds[6],
    Drawing drawing = Drawing::All);

  /**
   * The same for a frame whose surfaces have been kept apart: they are drawn one by one. Colors and alpha are those
   * of the surfaces (not premultiplied).
   */
  void SetLayers(const rt::Picture& frame, vtkMatrix4x4* projection, const double bounds[6]);

  /**
   * Set this if the renderer has translucent geometry of other props, or FXAA: such surfaces are then drawn among it.
   * Otherwise they are drawn where VTK draws volumes, since VTK's pass for translucent geometry makes holes in the
   * window's alpha where opaque geometry is behind. Off by default.
   */
  void SetIsAmongTranslucent(bool isAmong);

  /**
   * Other bounds for the same frame. Nothing happens without a frame.
   */
  void SetBounds(const double bounds[6]);

  /**
   * Draw nothing from now on.
   */
  void Clear();

  double* GetBounds() VTK_SIZEHINT(6) override;
  int RenderOpaqueGeometry(vtkViewport* viewport) override;
  vtkTypeBool HasTranslucentPolygonalGeometry() override;
  int RenderTranslucentPolygonalGeometry(vtkViewport* viewport) override;
  int RenderVolumetricGeometry(vtkViewport* viewport) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkDSMFrameProp();
  ~vtkDSMFrameProp() override;

private:
  int DrawLayers(vtkViewport* viewport);

  vtkDSMFrameProp(const vtkDSMFrameProp&) = delete;
  void operator=(const vtkDSMFrameProp&) = delete;

  class Internals;
  std::unique_ptr<Internals> Self;
};

#endif
