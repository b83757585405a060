// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMInputWatch_h
#define vtkPVDSMInputWatch_h

#include <memory>

/// Whether the user has pressed or released a mouse button or a key, turned the wheel or dragged, and the application has
/// not heard of it yet, because it is busy. The X server tells of each event, however short, by a connection of its
/// own. What is typed or pressed in another application does not count. Without X11 and its input extension, nobody ever
/// has. One thread.
class vtkPVDSMInputWatch
{
public:
  vtkPVDSMInputWatch();
  ~vtkPVDSMInputWatch();
  vtkPVDSMInputWatch(const vtkPVDSMInputWatch&) = delete;
  void operator=(const vtkPVDSMInputWatch&) = delete;

  /// What has happened until now does not count.
  void Begin();
  /// Whether anything has happened since. Takes microseconds.
  bool HasPressed();

private:
  class Internals;
  std::unique_ptr<Internals> Self; ///< from the first Begin on
};

#endif
