// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFrameLayers_h
#define vtkDSMFrameLayers_h

#include "DSMRayTracing/frame/FrameGather.h"

#include <array>
#include <memory>
#include <vector>

class vtkInformation;
class vtkViewport;
class vtkWindow;

/// Draws the surfaces of a frame, one layer of pixels after the other, as translucent geometry of
/// VTK's: whatever the renderer does about the order of its translucent objects, such as depth
/// peeling, it does about these. Local.
class vtkDSMFrameLayers
{
public:
  vtkDSMFrameLayers();
  ~vtkDSMFrameLayers();
  vtkDSMFrameLayers(const vtkDSMFrameLayers&) = delete;
  void operator=(const vtkDSMFrameLayers&) = delete;

  /// Turns what each layer contributes to a pixel into its own color and opacity: what has to be
  /// blended, back to front, to get the same pixel.
  static void Separate(rt::Picture& picture);

  /// A picture that Separate has been called for; without pixels, nothing is drawn. Pixels of alpha 0
  /// are left out.
  void SetPicture(const rt::Picture& picture);
  bool IsEmpty() const { return this->Layers.empty(); }

  /// For RenderTranslucentPolygonalGeometry. `keys`: of the prop that is drawn, for render passes.
  /// `target`: the rectangle that the frame fills, in the coordinates of the clip space.
  void Render(vtkViewport* viewport, vtkInformation* keys, const std::array<double, 4>& target);

  void ReleaseGraphicsResources(vtkWindow* window);

private:
  class Layer;
  std::vector<std::unique_ptr<Layer>> Layers; ///< the nearest first
};

#endif
