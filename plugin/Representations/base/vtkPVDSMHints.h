// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMHints_h
#define vtkPVDSMHints_h

class vtkPVXMLElement;
class vtkSMProperty;

/// Hints of a display's properties, for the panel and for ParaView's Python. Those in a definition are those of all
/// displays.
class vtkPVDSMHints
{
public:
  /// Gives the property hints of its own: those that it has, with another one before them and without one of them. Both
  /// may be null. The property does not count as modified.
  static void Change(vtkSMProperty* property, vtkPVXMLElement* added, vtkPVXMLElement* removed);
};

#endif
