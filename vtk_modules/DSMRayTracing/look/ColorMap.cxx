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
