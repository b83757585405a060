// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeFunctions.h"

#include "vtkColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
#include "vtkScalarsToColors.h"
#include "vtkVariant.h"
#include "vtkVolumeProperty.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace
{

bool IsLogarithmic(vtkColorTransferFunction* colors)
{
  return colors && colors->GetScale() == VTK_CTF_LOG10 && colors->GetRange()[0] > 0.0;
}

/// Adds the nodes of a function, and where curves between two of them are steepest. `middle`: index
/// of the midpoint among the numbers of a VTK node.
template <class Function, int Numbers>
void AddFunctionNodes(
  Function* function, bool isLogarithmic, int middle, std::vector<double>& nodes)
{
  double before[Numbers];
  for (int index = 0; index < function->GetSize(); ++index)
  {
    double node[Numbers];
    function->GetNodeValue(index, node);
    if (index > 0)
    {
      const bool isLog = isLogarithmic && before[0] > 0.0;
      nodes.push_back(isLog ? before[0] * std::pow(node[0] / before[0], before[middle])
                            : before[0] + before[middle] * (node[0] - before[0]));
    }
    nodes.push_back(node[0]);
    std::copy_n(node, Numbers, before);
  }
}

/// The most that a value may differ from its category: labels are integers.
constexpr double MostFromCategory = 0.5;

} // namespace

vtkDSMVolumeFunctions::vtkDSMVolumeFunctions(
  vtkVolumeProperty* property, int component, bool hasCategories)
  : Opacity(property->GetScalarOpacity(component))
{
  // To ask for the other one would make it the one that counts.
  if (property->GetColorChannels(component) == 1)
  {
    this->Gray = property->GetGrayTransferFunction(component);
  }
  else
  {
    this->Colors = property->GetRGBTransferFunction(component);
    if (hasCategories)
    {
      this->Colors->Build();
      this->Categories = FindCategories(this->Colors);
    }
  }
}

std::vector<rt::ColorMap::Category> vtkDSMVolumeFunctions::FindCategories(vtkScalarsToColors* table)
{
  std::vector<rt::ColorMap::Category> categories;
  for (vtkIdType index = 0; index < table->GetNumberOfAnnotatedValues(); ++index)
  {
    bool isNumber = false;
    const double value = table->GetAnnotatedValue(index).ToDouble(&isNumber);
    if (isNumber && !std::isnan(value))
    {
      double color[4];
      table->GetIndexedColor(index, color);
      categories.push_back({ value, { color[0], color[1], color[2], color[3] } });
    }
  }
  std::sort(categories.begin(), categories.end(),
    [](const auto& a, const auto& b) { return a.Value < b.Value; });
  return categories;
}

void vtkDSMVolumeFunctions::Narrow(double& first, double& last) const
{
  const bool areClamped = !this->Categories && this->Opacity->GetClamping() != 0 &&
    (this->Gray ? this->Gray->GetClamping() : this->Colors->GetClamping()) != 0;
  if (areClamped)
  {
    const double* const range = this->Gray ? this->Gray->GetRange() : this->Colors->GetRange();
    const double step = 1e-12 * (range[1] - range[0]);
    const bool hasBelow = this->Colors && this->Colors->GetUseBelowRangeColor();
    const bool hasAbove = this->Colors && this->Colors->GetUseAboveRangeColor();
    const double ofColors[] = {
      hasBelow ? std::min(range[0] - step, std::nextafter(range[0], -HUGE_VAL)) : range[0],
      hasAbove ? std::max(range[1] + step, std::nextafter(range[1], HUGE_VAL)) : range[1]
    };
    const double* const ofOpacity = this->Opacity->GetRange();
    const double low = std::max(first, std::min(ofColors[0], ofOpacity[0]));
    const double high = std::min(last, std::max(ofColors[1], ofOpacity[1]));
    first = low < high ? low : first;
    last = low < high ? high : last;
  }
  Widen(first, last);
}

void vtkDSMVolumeFunctions::Widen(double& first, double& last)
{
  if (!(first < last))
  {
    const double half = std::max(1.0, std::abs(first)) * 1e-3;
    first -= half;
    last += half;
  }
}

bool vtkDSMVolumeFunctions::AreLogarithmic(double first) const
{
  return first > 0.0 && (this->Opacity->GetUseLogScale() || IsLogarithmic(this->Colors));
}

glm::dvec4 vtkDSMVolumeFunctions::GetCategoryLook(double value) const
{
  const auto next = std::lower_bound(this->Categories->begin(), this->Categories->end(), value,
    [](const auto& category, double sought) { return category.Value < sought; });
  auto nearest = next;
  if (next != this->Categories->begin())
  {
    const auto before = std::prev(next);
    const bool isBefore =
      next == this->Categories->end() || value - before->Value < next->Value - value;
    nearest = isBefore ? before : next;
  }
  if (nearest != this->Categories->end() && std::abs(nearest->Value - value) <= MostFromCategory)
  {
    glm::dvec4 look(nearest->Color);
    look.w *= GetValue(this->Opacity, nearest->Value);
    return look;
  }
  double color[3];
  this->Colors->GetNanColor(color);
  return { color[0], color[1], color[2],
    this->Colors->GetNanOpacity() * GetValue(this->Opacity, value) };
}

glm::dvec4 vtkDSMVolumeFunctions::GetLook(double value) const
{
  if (this->Categories)
  {
    return this->GetCategoryLook(value);
  }
  const double opacity = GetValue(this->Opacity, value);
  if (this->Gray)
  {
    return glm::dvec4(glm::dvec3(GetValue(this->Gray, value)), opacity);
  }
  const double known = ToKnown(this->Colors, value);
  double color[3];
  this->Colors->GetTable(known, known, 1, color);
  return { color[0], color[1], color[2], opacity };
}

std::vector<double> vtkDSMVolumeFunctions::GetNodes() const
{
  std::vector<double> nodes;
  AddNodes(this->Opacity, nodes);
  if (this->Categories)
  {
    const rt::ColorMap::Category* before = nullptr;
    for (const rt::ColorMap::Category& category : *this->Categories)
    {
      nodes.push_back(category.Value - MostFromCategory);
      nodes.push_back(category.Value + MostFromCategory);
      if (before && category.Value - before->Value < 2.0 * MostFromCategory)
      {
        nodes.push_back(0.5 * (before->Value + category.Value));
      }
      before = &category;
    }
    return nodes;
  }
  if (this->Gray)
  {
    AddNodes(this->Gray, nodes);
  }
  else
  {
    AddNodes(this->Colors, nodes);
  }
  return nodes;
}

double vtkDSMVolumeFunctions::GetValue(vtkPiecewiseFunction* function, double value)
{
  const double found = function->GetValue(value);
  if (!std::isnan(found))
  {
    return found;
  }
  // In a logarithmic scale, a node at 0 or below is infinitely far away.
  double node[4] = {};
  for (int index = 0; index < function->GetSize() && node[0] < value; ++index)
  {
    function->GetNodeValue(index, node);
  }
  return node[1];
}

void vtkDSMVolumeFunctions::AddNodes(vtkPiecewiseFunction* function, std::vector<double>& nodes)
{
  AddFunctionNodes<vtkPiecewiseFunction, 4>(function, function->GetUseLogScale(), 2, nodes);
}

void vtkDSMVolumeFunctions::AddNodes(vtkColorTransferFunction* colors, std::vector<double>& nodes)
{
  AddFunctionNodes<vtkColorTransferFunction, 6>(colors, IsLogarithmic(colors), 4, nodes);
}

double vtkDSMVolumeFunctions::ToKnown(vtkColorTransferFunction* colors, double value)
{
  if (!IsLogarithmic(colors))
  {
    return value;
  }
  constexpr double next = 1.0 + 1e-9;
  const double* const range = colors->GetRange();
  return value < range[0] ? range[0] / next
    : value > range[1]
    ? range[1] * next
    : std::clamp(value, range[0] * next, std::max(range[0] * next, range[1] / next));
}
