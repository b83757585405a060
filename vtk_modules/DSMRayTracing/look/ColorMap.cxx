// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/look/ColorMap.h"

#include "DSMRayTracing/look/FunctionSamples.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rt
{

glm::vec4 ColorMap::Map(double value) const
{
  if (this->Categories)
  {
    const auto found = std::lower_bound(this->Categories->begin(), this->Categories->end(), value,
      [](const Category& category, double sought) { return category.Value < sought; });
    return found != this->Categories->end() && found->Value == value ? found->Color
                                                                     : this->NotANumber;
  }
  if (std::isnan(value) || this->Table.empty())
  {
    return this->NotANumber;
  }
  if (value < this->First)
  {
    return this->Below;
  }
  if (value > this->Last)
  {
    return this->Above;
  }
  // A range that reaches to zero or below has no logarithm; it is read linearly.
  const bool logarithmic = this->Logarithmic && this->First > 0.0;
  const double first = logarithmic ? std::log10(this->First) : this->First;
  const double last = logarithmic ? std::log10(this->Last) : this->Last;
  const double place = logarithmic ? std::log10(value) : value;
  const double fraction = last > first ? (place - first) / (last - first) : 0.0;
  const auto entry = static_cast<std::size_t>(
    std::clamp(fraction, 0.0, 1.0) * static_cast<double>(this->Table.size() - 1) + 0.5);
  if (this->FirstNode.empty() || this->FirstNode[entry] == this->FirstNode[entry + 1])
  {
    return this->Table[entry];
  }
  const auto begin = this->Nodes.begin() + this->FirstNode[entry];
  const auto end = this->Nodes.begin() + this->FirstNode[entry + 1] - 1;
  const auto after = std::lower_bound(
    begin + 1, end, value, [](const Node& node, double sought) { return node.Value < sought; });
  const auto before = after - 1;
  const double part = (value - before->Value) / (after->Value - before->Value);
  return glm::mix(before->Color, after->Color, static_cast<float>(std::clamp(part, 0.0, 1.0)));
}

void ColorMap::Sample(std::size_t entries, const std::function<glm::vec4(double)>& color,
  const std::vector<double>& nodes)
{
  constexpr double tolerance = 1.0 / 512.0;
  const auto getDifference = [](const glm::dvec4& one, const glm::dvec4& other)
  {
    const glm::dvec4 all = glm::abs(one - other);
    // Colors of what is transparent do not count.
    const double ofColors = one.w > 0.0 || other.w > 0.0 ? std::max({ all.x, all.y, all.z }) : 0.0;
    return std::max(ofColors, all.w) / tolerance;
  };
  const auto getDeviation =
    [&](const FunctionSample& begin, const FunctionSample& end, const FunctionSample& between)
  {
    const double part = (between.Value - begin.Value) / (end.Value - begin.Value);
    return getDifference(between.Look, glm::mix(begin.Look, end.Look, part));
  };
  const auto look = [&](double value) { return glm::dvec4(color(value)); };
  const FunctionSamples samples(look, nodes, getDeviation);
  this->Table.resize(entries);
  FunctionSample begin = samples.Get(this->First);
  for (std::size_t entry = 0; entry < entries; ++entry)
  {
    this->FirstNode.push_back(static_cast<std::uint32_t>(this->Nodes.size()));
    const auto place = static_cast<double>(entry);
    const FunctionSample middle = samples.Get(this->GetValue(place));
    const FunctionSample end = samples.Get(this->GetValue(place + 0.5));
    this->Table[entry] = glm::vec4(middle.Look);
    const std::vector<FunctionSample> between = samples.FindBetween(begin, end);
    if (!between.empty() || getDifference(begin.Look, middle.Look) > 1.0 ||
      getDifference(middle.Look, end.Look) > 1.0)
    {
      this->Nodes.push_back({ begin.Value, glm::vec4(begin.Look) });
      for (const FunctionSample& sample : between)
      {
        this->Nodes.push_back({ sample.Value, glm::vec4(sample.Look) });
      }
      this->Nodes.push_back({ end.Value, glm::vec4(end.Look) });
    }
    begin = end;
  }
  this->FirstNode.push_back(static_cast<std::uint32_t>(this->Nodes.size()));
}

void ColorMap::SetOpaque()
{
  for (glm::vec4& color : this->Table)
  {
    color.w = 1.0f;
  }
  for (Node& node : this->Nodes)
  {
    node.Color.w = 1.0f;
  }
  this->Below.w = 1.0f;
  this->Above.w = 1.0f;
}

double ColorMap::GetValue(double entry) const
{
  const double part = entry / static_cast<double>(this->Table.size() - 1);
  const double value = this->Logarithmic ? this->First * std::pow(this->Last / this->First, part)
                                         : this->First + part * (this->Last - this->First);
  return std::min(std::max(value, this->First), this->Last);
}

double ColorMap::FindUnseenEnd(bool fromAbove) const
{
  const double end = fromAbove ? -HUGE_VAL : HUGE_VAL;
  const std::size_t count = this->Table.size();
  for (std::size_t number = 0; number < count; ++number)
  {
    const std::size_t entry = fromAbove ? count - 1 - number : number;
    if (this->IsSeen(entry))
    {
      const auto place = static_cast<double>(entry);
      return number == 0 ? -end : this->GetValue(fromAbove ? place + 1.0 : place - 1.0);
    }
  }
  return end;
}

bool ColorMap::IsSeen(std::size_t entry) const
{
  if (this->Table[entry].w > 0.0f || this->FirstNode.empty())
  {
    return this->Table[entry].w > 0.0f;
  }
  return std::any_of(this->Nodes.begin() + this->FirstNode[entry],
    this->Nodes.begin() + this->FirstNode[entry + 1],
    [](const Node& node) { return node.Color.w > 0.0f; });
}

bool ColorMap::IsOpaque() const
{
  const auto isOpaque = [](const glm::vec4& color) { return color.w >= 1.0f; };
  if (this->Categories)
  {
    return isOpaque(this->NotANumber) &&
      std::all_of(this->Categories->begin(), this->Categories->end(),
        [&](const Category& category) { return isOpaque(category.Color); });
  }
  return isOpaque(this->Below) && isOpaque(this->Above) && isOpaque(this->NotANumber) &&
    std::all_of(this->Table.begin(), this->Table.end(), isOpaque) &&
    std::all_of(this->Nodes.begin(), this->Nodes.end(),
      [&](const Node& node) { return isOpaque(node.Color); });
}

} // namespace rt
