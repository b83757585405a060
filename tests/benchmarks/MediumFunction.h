// SPDX-License-Identifier: BSD-3-Clause
#ifndef MediumFunction_h
#define MediumFunction_h

#include "DSMBricks/base/ValueRange.h"
#include "DSMRayTracing/look/TransferFunction.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// A transfer function over the range of a volume's values: blue to red, and opacities by its kind.
class MediumFunction
{
public:
  enum class Kind
  {
    Shell, ///< 0.8 in the middle of the range, 0 beyond 2 % of the range from there, lines in between
    Fog,   ///< 0.01 everywhere
    Ramp   ///< from 0 to 0.05
  };
  static const std::map<std::string, Kind>& GetKinds()
  {
    static const std::map<std::string, Kind> kinds{ { "shell", Kind::Shell }, { "fog", Kind::Fog },
      { "ramp", Kind::Ramp } };
    return kinds;
  }

  /// `cell`: length of the shortest edge of a cell, the unit of opacity.
  MediumFunction(Kind kind, const bricks::ValueRange& range, double cell)
    : Shape(kind)
    , First(range.First)
    , Width(static_cast<double>(range.Last) - range.First)
    , Cell(cell)
  {
  }

  /// Red, green, blue, and optical depth in a unit of length.
  glm::dvec4 GetLook(double value) const
  {
    const double part = std::clamp((value - this->First) / this->Width, 0.0, 1.0);
    return { part, 0.3, 1.0 - part, -std::log1p(-this->GetOpacity(part)) / this->Cell };
  }

  /// `diagonal`: length of the longest ray.
  std::shared_ptr<const rt::TransferFunction> Create(double diagonal) const
  {
    std::vector<double> nodes{ this->First, this->First + this->Width };
    for (const double part : { 0.5 - HalfWidth, 0.5, 0.5 + HalfWidth })
    {
      nodes.push_back(this->First + part * this->Width);
    }
    constexpr double leastDepth = 1.0 / 4096.0; // as the renderer's own
    return rt::TransferFunction::Create(
      this->First, this->First + this->Width, [this](double value) { return this->GetLook(value); },
      nodes, leastDepth / diagonal, this->Cell);
  }

private:
  static constexpr double HalfWidth = 0.02;

  double GetOpacity(double part) const
  {
    switch (this->Shape)
    {
      case Kind::Shell:
        return 0.8 * std::max(1.0 - std::abs(part - 0.5) / HalfWidth, 0.0);
      case Kind::Fog:
        return 0.01;
      default:
        return 0.05 * part;
    }
  }

  Kind Shape;
  double First;
  double Width;
  double Cell;
};

#endif
