// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/look/TransferFunction.h"

#include "DSMBricks/base/ByteHash.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
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

/// The visible emission of a short way, over its length: two extinctions with which a cell is opaque look alike.
glm::dvec4 GetSeen(const glm::dvec4& emission, double cellLength)
{
  const double depth = emission.w * cellLength;
  return depth > 0.0 ? emission * (-std::expm1(-depth) / depth) : emission;
}

double GetLargest(const glm::dvec4& numbers)
{
  return std::max({ numbers.x, numbers.y, numbers.z, numbers.w });
}

/// Emission and extinction of a way with such a look.
glm::dvec4 ToEmission(const glm::dvec4& look)
{
  return glm::dvec4(glm::dvec3(look) * look.w, look.w);
}

/// From one look to the next. If one end of a bin is transparent, the bin has the color of the other end.
double GetTinge(const glm::dvec4& before, const glm::dvec4& after)
{
  const glm::dvec3 change = glm::abs(glm::dvec3(after) - glm::dvec3(before));
  return before.w > 0.0 && after.w > 0.0 ? std::max({ change.x, change.y, change.z }) : 0.0;
}

Lanes ToLanes(const glm::dvec4& numbers)
{
  return { numbers.x, numbers.y, numbers.z, numbers.w };
}

} // namespace

TransferFunction::TransferFunction(double first, double last,
  const std::vector<glm::dvec4>& samples, double cellLength,
  const std::vector<FunctionSample>& between)
  : First(first)
  , Scale(static_cast<double>(samples.size() - 1) / (last - first))
  , Last(static_cast<double>(samples.size() - 1))
  , AllBins(static_cast<int>(samples.size()) + 1)
  , Table(samples.size() + 1)
  , Divisions(samples.size() + 1, 0)
  , Divided(1)
  , SeenBefore(samples.size() + 2, 0)
{
  bricks::ByteHash hash;
  hash.Add(&first, sizeof(first));
  hash.Add(&last, sizeof(last));
  hash.Add(samples.data(), samples.size() * sizeof(glm::dvec4));
  hash.Add(&cellLength, sizeof(cellLength));
  for (const FunctionSample& sample : between)
  {
    hash.Add(&sample.Value, sizeof(sample.Value));
    hash.Add(&sample.Look, sizeof(sample.Look));
  }
  this->Digest = hash.Get();

  const auto getSample = [&](int sample)
  { return samples[static_cast<std::size_t>(std::clamp(sample, 0, this->AllBins - 2))]; };
  const auto emit = [&](int sample) { return ToEmission(getSample(sample)); };
  // The bin below the range ends where the integral is 0.
  glm::dvec4 integral = -emit(0);
  glm::dvec4 before = GetSeen(emit(0), cellLength);
  const std::size_t groupCount = samples.size() / BinsOfGroup + 1;
  std::vector<Behavior> groups(groupCount);
  auto inner = between.begin();
  for (int bin = 0; bin < this->AllBins; ++bin)
  {
    const glm::dvec4 begin = emit(bin - 1);
    const glm::dvec4 growth = emit(bin) - begin;
    const glm::dvec4 slope = begin + 0.5 * growth;
    Bin& own = this->Table[static_cast<std::size_t>(bin)];
    Behavior& group = groups[static_cast<std::size_t>(bin / BinsOfGroup)];
    own = { ToLanes(integral), ToLanes(begin), ToLanes(growth) };
    std::vector<Corner> corners{ { bin - 1.0, getSample(bin - 1) } };
    for (; inner != between.end(); ++inner)
    {
      const double place = (inner->Value - first) * this->Scale;
      if (place >= bin)
      {
        break;
      }
      if (place > corners.back().Place)
      {
        corners.push_back({ place, inner->Look });
      }
    }
    Whole whole{ slope, 0.0, GetTinge(getSample(bin - 1), getSample(bin)) };
    if (corners.size() > 1)
    {
      corners.push_back({ static_cast<double>(bin), getSample(bin) });
      whole = this->Divide(bin, corners, integral, cellLength);
    }
    // The first bin of a group changes from the last one of the group before.
    const glm::dvec4 seen = GetSeen(whole.Slope, cellLength);
    group.Change = std::max({ group.Change, whole.Change, GetLargest(glm::abs(seen - before)) });
    group.Extinction = std::max(group.Extinction, whole.Slope.w);
    group.Tinge = std::max(group.Tinge, whole.Tinge);
    this->SeenBefore[static_cast<std::size_t>(bin) + 1] =
      this->SeenBefore[static_cast<std::size_t>(bin)] + (whole.Slope.w > 0.0 ? 1 : 0);
    integral += whole.Slope;
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

std::shared_ptr<const TransferFunction> TransferFunction::Create(double first, double last,
  const std::function<glm::dvec4(double)>& look, const std::vector<double>& nodes, double least,
  double cellLength)
{
  constexpr double tolerance = 1.0 / 512.0;
  std::vector<FunctionSample> even;
  glm::dvec4 scale(0.0, 0.0, 0.0, 1.0);
  for (int sample = 0; sample <= Bins; ++sample)
  {
    const double value =
      sample == Bins ? last : first + (last - first) * (static_cast<double>(sample) / Bins);
    even.push_back({ value, look(value) });
    scale = glm::max(scale, glm::dvec4(glm::dvec3(even.back().Look), 1.0));
  }
  const auto getDeviation =
    [&](const FunctionSample& begin, const FunctionSample& end, const FunctionSample& between)
  {
    const double part = (between.Value - begin.Value) / (end.Value - begin.Value);
    const glm::dvec4 line = glm::mix(ToEmission(begin.Look), ToEmission(end.Look), part);
    const glm::dvec4 difference = glm::abs(ToEmission(between.Look) - line);
    const double most = tolerance * std::max(between.Look.w, line.w) + least;
    return most > 0.0 ? GetLargest(difference / scale) / most : 0.0;
  };
  const FunctionSamples samples(look, nodes, getDeviation);
  std::vector<glm::dvec4> looks{ even.front().Look };
  std::vector<FunctionSample> between;
  for (std::size_t sample = 1; sample < even.size(); ++sample)
  {
    looks.push_back(even[sample].Look);
    const std::vector<FunctionSample> some = samples.FindBetween(even[sample - 1], even[sample]);
    between.insert(between.end(), some.begin(), some.end());
  }
  return std::make_shared<const TransferFunction>(first, last, looks, cellLength, between);
}

TransferFunction::Whole TransferFunction::Divide(
  int number, const std::vector<Corner>& corners, const glm::dvec4& integral, double cellLength)
{
  this->Divisions[static_cast<std::size_t>(number)] =
    static_cast<std::uint32_t>(this->Divided.size());
  const std::size_t first = this->Places.size();
  Whole whole;
  for (std::size_t corner = 1; corner < corners.size(); ++corner)
  {
    const Corner& begin = corners[corner - 1];
    const Corner& end = corners[corner];
    const double width = end.Place - begin.Place;
    const glm::dvec4 one = ToEmission(begin.Look);
    const glm::dvec4 other = ToEmission(end.Look);
    const glm::dvec4 mean = 0.5 * (one + other);
    const double change =
      GetLargest(glm::abs(GetSeen(other, cellLength) - GetSeen(one, cellLength)));
    const double tinge = GetTinge(begin.Look, end.Look);
    this->Places.push_back(begin.Place);
    this->Table.push_back(
      { ToLanes(integral + whole.Slope), ToLanes(one), ToLanes((other - one) / width) });
    this->Parts.push_back({ mean.w, change / width, tinge / width });
    whole.Slope += width * mean;
    whole.Change += change;
    whole.Tinge += tinge;
  }
  this->Divided.push_back({ first, this->Places.size() });
  this->Table[static_cast<std::size_t>(number)].Begin =
    Lanes(std::numeric_limits<double>::quiet_NaN());
  return whole;
}

Lanes TransferFunction::IntegratePart(int number, double place, Lanes& slope) const
{
  const Division& division = this->Divided[this->Divisions[static_cast<std::size_t>(number)]];
  const std::size_t part = this->FindPart(division, place);
  return Integrate(
    this->Table[static_cast<std::size_t>(this->AllBins) + part], place - this->Places[part], slope);
}

std::size_t TransferFunction::FindPart(const Division& division, double place) const
{
  // The first part begins where the bin does.
  const auto begin = this->Places.begin() + static_cast<std::ptrdiff_t>(division.First) + 1;
  const auto end = this->Places.begin() + static_cast<std::ptrdiff_t>(division.Last);
  return static_cast<std::size_t>(std::upper_bound(begin, end, place) - this->Places.begin() - 1);
}

TransferFunction::Behavior TransferFunction::FindBinBehavior(int first, int last) const
{
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

TransferFunction::Behavior TransferFunction::FindBehavior(double begin, double end) const
{
  const int first = this->GetNumber(begin);
  const int last = this->GetNumber(end);
  return this->IsFine(first, last) && end - begin < 1.0 ? this->FindFineBehavior(begin, end)
                                                        : this->FindBinBehavior(first, last);
}

TransferFunction::Behavior TransferFunction::FindFineBehavior(double begin, double end) const
{
  Behavior largest;
  const int last = this->GetNumber(end);
  for (int number = this->GetNumber(begin); number <= last; ++number)
  {
    const std::uint32_t division = this->Divisions[static_cast<std::size_t>(number)];
    if (division == 0)
    {
      largest = GetLarger(largest, this->FindBinBehavior(number, number));
      continue;
    }
    const std::size_t lastPart = this->FindPart(this->Divided[division], end);
    for (std::size_t part = this->FindPart(this->Divided[division], begin); part <= lastPart;
         ++part)
    {
      largest = GetLarger(largest, this->Parts[part]);
    }
  }
  return largest;
}

} // namespace rt
