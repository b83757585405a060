// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFrameNotes_h
#define vtkDSMFrameNotes_h

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/scene/DebugView.h"

#include <string>
#include <vector>

class vtkDSMStatistics;
class vtkRenderer;

/// Annotations in the image: the figures of the frame, and the legend of a debug view's colors.
/// They are pixels nearer than anything else, so they reach the screen the same way as the image.
class vtkDSMFrameNotes
{
public:
  /// An entry of a legend.
  struct Entry
  {
    glm::vec3 Color;
    std::string Text;
  };

  /// Creates the legend of a debug view's colors; ranks are those of `statistics`.
  static std::vector<Entry> CreateLegend(rt::DebugView view, const vtkDSMStatistics* statistics);

  /// Where a picture lies in its view, in pixels. They differ where a screenshot is larger than the window, so that the
  /// application renders it tile by tile.
  struct Place
  {
    int Width = 0; ///< of the whole view
    int Height = 0;
    int Left = 0; ///< lower left pixel of the picture in the whole view
    int Bottom = 0;
    int DotsPerInch = 72; ///< of the view: scales the text as VTK's own
  };
  /// Local.
  static Place FindPlace(vtkRenderer* renderer, const rt::Picture& picture);

  /// Each into a corner of the view on the left: the text above, the legend below; the picture gets its part of
  /// them. A part that is empty, or does not fit the view, is left out. Without a text renderer in the application
  /// (VTK's RenderingFreeType), both are.
  static void Draw(const std::string& text, const std::vector<Entry>& legend, const Place& place,
    rt::Picture& picture);
};

#endif
