// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/look/TransferFunction.h"

#include "DSMBricks/base/ByteHash.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace rt
{

namespace
{

constexpr int BinsOfGroup = 16;

/// Returns the larger of each number.
TransferFunction::Behavior GetLarger(
  const TransferFunction::Behavior& one, const TransferFunction::Behavior& other)
{
  return { std::max(one.Extinction, other.Extinction), std::max(one.Change, other.Change),
    std::max(one.Tinge, other.Tinge) };
}

} // namespace

TransferFunction::TransferFunction(
  double first, double last, const std::vector<glm::dvec4>& samples, double cellLength)
  : First(first)
  , Scale(static_cast<double>(samples.size() - 1) / (last - first))
  , Last(static_cast<double>(samples.size() - 1))
  , AllBins(static_cast<int>(samples.size()) + 1)
  , Table(samples.size() + 1)
  , SeenBefore(samples.size() + 2, 0)
{
  bricks::ByteHash hash;
  hash.Add(&first, sizeof(first));
  hash.Add(&last, sizeof(last));
  hash.Add(samples.data(), samples.size() * sizeof(glm::dvec4));
  hash.Add(&cellLength, sizeof(cellLength));
  this->Digest = hash.Get();

  const auto emit = [&](int sample)
  {
    const glm::dvec4& one =
      samples[static_cast<std::size_t>(std::clamp(sample, 0, this->AllBins - 2))];
    return glm::dvec4(glm::dvec3(one) * one.w, one.w);
  };
  // If one end of a bin is transparent, the bin has the color of the other end.
  const auto getTinge = [&](int bin)
  {
    const auto& before =
      samples[static_cast<std::size_t>(std::clamp(bin - 1, 0, this->AllBins - 2))];
    const auto& after = samples[static_cast<std::size_t>(std::clamp(bin, 0, this->AllBins - 2))];
    const glm::dvec3 change = glm::abs(glm::dvec3(after) - glm::dvec3(before));
    return before.w > 0.0 && after.w > 0.0 ? std::max({ change.x, change.y, change.z }) : 0.0;
  };
  // The bin below the range ends where the integral is 0.
  glm::dvec4 integral = -emit(0);
  const auto getSeen = [&](const glm::dvec4& slope)
  {
    const double depth = slope.w * cellLength;
    return depth > 0.0 ? slope * (-std::expm1(-depth) / depth) : slope;
  };
  glm::dvec4 before = getSeen(emit(0));
  const std::size_t groupCount = samples.size() / BinsOfGroup + 1;
  std::vector<Behavior> groups(groupCount);
  for (int bin = 0; bin < this->AllBins; ++bin)
  {
    const glm::dvec4 begin = emit(bin - 1);
    const glm::dvec4 growth = emit(bin) - begin;
    const glm::dvec4 slope = begin + 0.5 * growth;
    Bin& own = this->Table[static_cast<std::size_t>(bin)];
    Behavior& group = groups[static_cast<std::size_t>(bin / BinsOfGroup)];
    own.Integral = Lanes(integral.x, integral.y, integral.z, integral.w);
    own.Begin = Lanes(begin.x, begin.y, begin.z, begin.w);
    own.Growth = Lanes(growth.x, growth.y, growth.z, growth.w);
    // The first bin of a group changes from the last one of the group before.
    const glm::dvec4 seen = getSeen(slope);
    for (int channel = 0; channel < 4; ++channel)
    {
      group.Change = std::max(group.Change, std::abs(seen[channel] - before[channel]));
    }
    group.Extinction = std::max(group.Extinction, slope.w);
    group.Tinge = std::max(group.Tinge, getTinge(bin));
    this->SeenBefore[static_cast<std::size_t>(bin) + 1] =
      this->SeenBefore[static_cast<std::size_t>(bin)] + (slope.w > 0.0 ? 1 : 0);
    integral += slope;
    before = seen;
  }
  this->Largest.push_back(groups);
  for (std::size_t width = 1; 2 * width <= groupCount; width *= 2)
  {
    const std::vector<Behavior>& narrow = this->Largest.back();
    std::vector<Behavior> next(groupCount - 2 * width + 1);
    for (std::size_t group = 0; group < next.size(); ++group)
    {
      next[group] = GetLarger(narrow[group], narrow[group + width]);
    }
    this->Largest.push_back(std::move(next));
  }
}

TransferFunction::Behavior TransferFunction::FindBehavior(double begin, double end) const
{
  const int first = this->GetNumber(begin);
  const int last = this->GetNumber(end);
  if (!this->AnyIsSeen(first, last))
  {
    return {};
  }
  const int firstGroup = first / BinsOfGroup;
  const int count = last / BinsOfGroup - firstGroup + 1;
  const int level = 31 - __builtin_clz(static_cast<unsigned>(count));
  const std::vector<Behavior>& groups = this->Largest[static_cast<std::size_t>(level)];
  return GetLarger(groups[static_cast<std::size_t>(firstGroup)],
    groups[static_cast<std::size_t>(firstGroup + count - (1 << level))]);
}

} // namespace rt
