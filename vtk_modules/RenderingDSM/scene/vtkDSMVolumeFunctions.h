// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMVolumeFunctions_h
#define vtkDSMVolumeFunctions_h

#include <glm/vec4.hpp>

#include <vector>

class vtkColorTransferFunction;
class vtkPiecewiseFunction;
class vtkVolumeProperty;

/// The color and opacity functions of a volume property's component, which are finite for any finite
/// value. Keeps references.
class vtkDSMVolumeFunctions
{
public:
  vtkDSMVolumeFunctions(vtkVolumeProperty* property, int component);

  /// If both functions are clamped, limits a range of values to that of the functions, with the next
  /// values beyond it where these have colors of their own. The result is never empty.
  void Narrow(double& first, double& last) const;
  /// Widens a range of a single value.
  static void Widen(double& first, double& last);

  /// Returns whether the functions are spread over the decades of values from `first` on.
  bool AreLogarithmic(double first) const;

  /// Color (not premultiplied) and opacity (w) of a value.
  glm::dvec4 GetLook(double value) const;
  /// The values where the functions may bend or jump.
  std::vector<double> GetNodes() const;

  /// The same of one function.
  static double GetValue(vtkPiecewiseFunction* function, double value);
  static void AddNodes(vtkPiecewiseFunction* function, std::vector<double>& nodes);
  static void AddNodes(vtkColorTransferFunction* colors, std::vector<double>& nodes);
  /// The value for which to ask a color function instead: with a logarithmic scale, it knows none
  /// below 0, and takes the ends of its range as beyond it.
  static double ToKnown(vtkColorTransferFunction* colors, double value);

private:
  vtkPiecewiseFunction* Opacity;
  vtkPiecewiseFunction* Gray = nullptr;
  vtkColorTransferFunction* Colors = nullptr;
};

#endif
