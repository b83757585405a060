// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMVolumeFunctions_h
#define vtkDSMVolumeFunctions_h

#include "DSMRayTracing/look/ColorMap.h"

#include <glm/vec4.hpp>

#include <optional>
#include <vector>

class vtkColorTransferFunction;
class vtkPiecewiseFunction;
class vtkScalarsToColors;
class vtkVolumeProperty;

/// The color and opacity functions of a volume property's component, which are finite for any finite
/// value. Keeps references.
class vtkDSMVolumeFunctions
{
public:
  /// `hasCategories`: each annotated value of the color function has a color and an opacity of its own, which
  /// multiplies that of the opacity function. All others have the color and opacity of NaN. Between two annotated
  /// values, the step is half way, but no more than 0.5 away from them.
  vtkDSMVolumeFunctions(vtkVolumeProperty* property, int component, bool hasCategories = false);

  /// The annotated values of a table that are numbers, ascending. The table must have been built.
  static std::vector<rt::ColorMap::Category> FindCategories(vtkScalarsToColors* table);

  /// If both functions are clamped, limits a range of values to that of the functions, with the next
  /// values beyond it where these have colors of their own. Categories have no range. The result is never empty.
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
  glm::dvec4 GetCategoryLook(double value) const;

  vtkPiecewiseFunction* Opacity;
  vtkPiecewiseFunction* Gray = nullptr;
  vtkColorTransferFunction* Colors = nullptr;
  std::optional<std::vector<rt::ColorMap::Category>> Categories;
};

#endif
