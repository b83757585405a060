// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMInputWatch_h
#define vtkPVDSMInputWatch_h

#include <memory>

/// Detects whether the user has pressed or released a mouse button or a key, turned the wheel or
/// dragged while the application is busy and has not received the event yet. The X server reports
/// each event, however short, over a separate connection. Input to another application is ignored.
/// Without X11 and its input extension, no input is ever detected. One thread.
/// has. One thread.
class vtkPVDSMInputWatch
{
public:
  vtkPVDSMInputWatch();
  ~vtkPVDSMInputWatch();
  vtkPVDSMInputWatch(const vtkPVDSMInputWatch&) = delete;
  void operator=(const vtkPVDSMInputWatch&) = delete;

  /// Ignores all input until now.
  void Begin();
  /// Returns whether there was any input since Begin. Takes microseconds.
  bool HasPressed();

private:
  class Internals;
  std::unique_ptr<Internals> Self; ///< from the first Begin on
};

#endif
