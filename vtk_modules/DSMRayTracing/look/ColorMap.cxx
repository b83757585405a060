// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/look/ColorMap.h"

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
  return this->Table[entry];
}

double ColorMap::GetValue(std::size_t entry) const
{
  const double part = static_cast<double>(entry) / static_cast<double>(this->Table.size() - 1);
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
    if (this->Table[entry].w > 0.0f)
    {
      return number == 0 ? -end : this->GetValue(fromAbove ? entry + 1 : entry - 1);
    }
  }
  return end;
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
    std::all_of(this->Table.begin(), this->Table.end(), isOpaque);
}

} // namespace rt
