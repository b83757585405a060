// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMDrawing_h
#define vtkPVDSMDrawing_h

/// Since 6.0, ParaView says of every process that it can draw. It chooses how when it makes a window. Without a display
/// and EGL it chooses OSMesa, even if that is not installed.
class vtkPVDSMDrawing
{
public:
  /// Returns whether this process can draw, with any version of ParaView.
  static bool IsPossible();
};

#endif
