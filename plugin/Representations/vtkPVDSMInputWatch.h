// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMInputWatch_h
#define vtkPVDSMInputWatch_h

#include <memory>

/// Whether the user has pressed a mouse button or a key that the application has not heard of yet,
/// because it is busy: asks the X server, by a connection of its own. What is typed or pressed in another
/// application does not count. Without X11, nobody ever has. One thread.
class vtkPVDSMInputWatch
{
public:
  vtkPVDSMInputWatch();
  ~vtkPVDSMInputWatch();
  vtkPVDSMInputWatch(const vtkPVDSMInputWatch&) = delete;
  void operator=(const vtkPVDSMInputWatch&) = delete;

  /// What is held down now does not count.
  void Begin();
  /// Whether anything was pressed since, and is still held down.
  bool HasPressed() const;

private:
  class Internals;
  std::unique_ptr<Internals> Self; ///< from the first Begin on
};

#endif
