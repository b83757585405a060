// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFrameNotes_h
#define vtkDSMFrameNotes_h

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/scene/DebugView.h"

#include <string>
#include <vector>

class vtkDSMStatistics;

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

  /// Each into a corner on the left: the text above, the legend below. What is empty, or does not fit,
  /// is left out, all of it where the application has no text renderer (VTK's RenderingFreeType).
  static void Draw(const std::string& text, const std::vector<Entry>& legend, rt::Picture& picture);
};

#endif
