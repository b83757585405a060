// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMSharedOptions_h
#define vtkPVDSMSharedOptions_h

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkCommand;
class vtkObjectBase;
class vtkPVRenderView;
class vtkSMProxy;

/// Keeps the properties of displays alike that belong to a view (its light) or to a session (its memory, which the
/// settings page has, too). A display or page that gets a value passes it on to all others at once, so every panel
/// shows the value that applies: the most recent one. On processes that have proxies: the client, and rank 0 of
/// pvbatch.
///
/// A display joins when it enters its view, with all the ways in which it can be shown: the panel shows the values
/// of one of them, whichever is traced. It gets the current values. It passes on its own where they are neither the
/// defaults nor the settings page's. While a state file is being loaded, a display that is traced passes on all of
/// its light, and one that is not passes on nothing. The look of a view (DSMLook) is shared by the displays that
/// are traced in it only: a display begins with that of the settings page.
class vtkPVDSMSharedOptions
{
public:
  ~vtkPVDSMSharedOptions();
  vtkPVDSMSharedOptions(const vtkPVDSMSharedOptions&) = delete;
  vtkPVDSMSharedOptions& operator=(const vtkPVDSMSharedOptions&) = delete;

  /// The display with these options is in the view, and traced or not. Does nothing where there are no proxies.
  static void Join(
    vtkPVRenderView* view, vtkObjectBase* light, vtkObjectBase* memory, bool isTraced);

  /// The display with these options is no longer in the view.
  static void Leave(vtkPVRenderView* view, vtkObjectBase* light, vtkObjectBase* memory);

private:
  struct Registry;
  enum class Part
  {
    All,
    AllButLook,
    Look
  };
  /// The values of its own that a display passes on when it joins.
  enum class Word
  {
    None,
    Given, ///< those that are neither the defaults nor the settings page's
    All
  };

  /// `values` has the values while no display has joined. A part of the properties of `like` is shared, without those
  /// that have the hint DSMOfDataset.
  vtkPVDSMSharedOptions(vtkSMProxy* values, vtkSMProxy* like, Part part);

  void Add(vtkSMProxy* proxy, Word word);
  void Remove(vtkObjectBase* object);
  void OnChange(vtkSMProxy* proxy, const char* name);
  /// Copies one proxy's value to all others.
  void Spread(vtkSMProxy* from, const std::string& name);
  void UpdateObjects();

  std::vector<std::string> Names; ///< names of the properties
  /// The first keeps the values while displays join and leave.
  std::vector<vtkSmartPointer<vtkSMProxy>> Proxies;
  vtkSmartPointer<vtkCommand> Observer;
  bool IsSpreading = false;
};

#endif
