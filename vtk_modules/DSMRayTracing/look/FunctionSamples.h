// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FunctionSamples_h
#define rt_FunctionSamples_h

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace rt
{

/// The look that a function of values has at one of them: red, green, blue, and opacity or extinction (w).
struct FunctionSample
{
  double Value;
  glm::dvec4 Look;
};

/// Finds which samples of a function are needed between two others, so that lines between all of
/// them show its peaks, steps and curves. Keeps references.
template <class Function, class Deviation>
class FunctionSamples
{
public:
  /// `function(value)`: the look there. `nodes`: the values where the function may bend or jump, in
  /// any order. `deviation(begin, end, sample)`: how far a sample is from the line between two
  /// others; at most 1 where the difference does not count.
  FunctionSamples(const Function& function, std::vector<double> nodes, const Deviation& deviation)
    : GetLook(function)
    , Nodes(std::move(nodes))
    , GetDeviation(deviation)
  {
    std::sort(this->Nodes.begin(), this->Nodes.end());
  }

  FunctionSample Get(double value) const { return { value, this->GetLook(value) }; }

  /// Ascending, without the two.
  std::vector<FunctionSample> FindBetween(
    const FunctionSample& begin, const FunctionSample& end) const
  {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const double step = (end.Value - begin.Value) * Step;
    std::vector<FunctionSample> corners{ begin };
    const auto last = std::upper_bound(this->Nodes.begin(), this->Nodes.end(), end.Value);
    for (auto node = std::lower_bound(this->Nodes.begin(), last, begin.Value); node != last; ++node)
    {
      // A jump at the node is between it and the value before or after it.
      const double jump = *node == 0.0 ? step : std::min(step, std::abs(*node) * NarrowJump);
      for (const double value : { std::min(*node - jump, std::nextafter(*node, -infinite)), *node,
             std::max(*node + jump, std::nextafter(*node, infinite)) })
      {
        if (corners.back().Value < value && value < end.Value)
        {
          corners.push_back(this->Get(value));
        }
      }
    }
    corners.push_back(end);
    std::vector<FunctionSample> all{ begin };
    for (std::size_t corner = 1; corner < corners.size(); ++corner)
    {
      this->AddCurve(corners[corner - 1], corners[corner], step, MostHalvings, all);
      all.push_back(corners[corner]);
    }
    std::vector<FunctionSample> needed;
    this->AddNeeded(all, 0, all.size() - 1, needed);
    return needed;
  }

private:
  /// The width of a jump, over that of the interval.
  static constexpr double Step = 1.0 / (1 << 28);
  /// The same over the value: logarithmic functions have decades in the width of any interval.
  static constexpr double NarrowJump = 1.0 / (1 << 20);
  static constexpr double NarrowCurve = 1.0 / (1 << 10);
  static constexpr int MostHalvings = 64;

  void AddCurve(const FunctionSample& begin, const FunctionSample& end, double step, int halvings,
    std::vector<FunctionSample>& all) const
  {
    const double width = end.Value - begin.Value;
    const double largest = std::max(std::abs(begin.Value), std::abs(end.Value));
    if (halvings == 0 || width <= std::min(2.0 * step, NarrowCurve * largest))
    {
      return;
    }
    const FunctionSample middle = this->Get(begin.Value + 0.5 * width);
    if (this->GetDeviation(begin, end, middle) > 1.0)
    {
      this->AddCurve(begin, middle, step, halvings - 1, all);
      all.push_back(middle);
      this->AddCurve(middle, end, step, halvings - 1, all);
    }
  }

  /// Leaves out samples between two of them that are on the line (Douglas and Peucker 1973).
  void AddNeeded(const std::vector<FunctionSample>& all, std::size_t begin, std::size_t end,
    std::vector<FunctionSample>& needed) const
  {
    double largest = 1.0;
    std::size_t farthest = begin;
    for (std::size_t sample = begin + 1; sample < end; ++sample)
    {
      const double deviation = this->GetDeviation(all[begin], all[end], all[sample]);
      if (deviation > largest)
      {
        largest = deviation;
        farthest = sample;
      }
    }
    if (farthest != begin)
    {
      this->AddNeeded(all, begin, farthest, needed);
      needed.push_back(all[farthest]);
      this->AddNeeded(all, farthest, end, needed);
    }
  }

  const Function& GetLook;
  std::vector<double> Nodes;
  const Deviation& GetDeviation;
};

} // namespace rt

#endif
