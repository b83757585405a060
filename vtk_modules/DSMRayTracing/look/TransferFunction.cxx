// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/look/TransferFunction.h"

#include "DSMBricks/base/ByteHash.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rt
{

namespace
{

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

/// In bins; FindFineBehavior.
constexpr double LeastWay = 1e-6;

double GetLargest(const glm::dvec4& numbers)
{
  return std::max({ numbers.x, numbers.y, numbers.z, numbers.w });
}

/// Emission and extinction of a way with such a look.
glm::dvec4 ToEmission(const glm::dvec4& look)
{
  return glm::dvec4(glm::dvec3(look) * look.w, look.w);
}

/// From one look to the next. If one end of a part is transparent, the part has the color of the other end.
double GetTinge(const glm::dvec4& before, const glm::dvec4& after)
{
  const glm::dvec3 change = glm::abs(glm::dvec3(after) - glm::dvec3(before));
  return before.w > 0.0 && after.w > 0.0 ? std::max({ change.x, change.y, change.z }) : 0.0;
}

Lanes ToLanes(const glm::dvec4& numbers)
{
  return { numbers.x, numbers.y, numbers.z, numbers.w };
}

glm::dvec4 ToVector(const Lanes& lanes)
{
  return { lanes[0], lanes[1], lanes[2], lanes[3] };
}

/// The value where the narrowest part begins.
double FindOrigin(const std::vector<FunctionSample>& samples)
{
  double origin = samples.front().Value;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t sample = 1; sample < samples.size(); ++sample)
  {
    const double width = samples[sample].Value - samples[sample - 1].Value;
    if (width > 0.0 && width < least)
    {
      least = width;
      origin = samples[sample - 1].Value;
    }
  }
  return origin;
}

/// As floats have it.
double Round(double place)
{
  return static_cast<double>(static_cast<float>(place));
}

std::vector<FunctionSample> ToSamples(
  double first, double last, const std::vector<glm::dvec4>& looks)
{
  std::vector<FunctionSample> samples;
  for (std::size_t number = 0; number < looks.size(); ++number)
  {
    const double part = static_cast<double>(number) / static_cast<double>(looks.size() - 1);
    samples.push_back({ first + part * (last - first), looks[number] });
  }
  samples.back().Value = last;
  return samples;
}

} // namespace

TransferFunction::TransferFunction(const std::vector<FunctionSample>& samples, double cellLength,
  const std::vector<std::vector<glm::dvec4>>& others)
  : Origin(FindOrigin(samples))
  , Scale(Bins / (samples.back().Value - samples.front().Value))
  , Begin(Round(this->GetPlace(samples.front().Value)))
{
  bricks::ByteHash hash;
  hash.Add(&cellLength, sizeof(cellLength));
  for (const FunctionSample& sample : samples)
  {
    hash.Add(&sample.Value, sizeof(sample.Value));
    hash.Add(&sample.Look, sizeof(sample.Look));
  }
  this->Digest = hash.Get();

  // The part below the range ends where the integral is 0.
  const Lanes start = ToLanes(ToEmission(samples.front().Look));
  this->Parts.push_back(
    { this->Begin, this->Begin, Lanes(0.0), start, Lanes(0.0), start[3], 0.0, { start[3] } });
  for (std::size_t sample = 1; sample < samples.size(); ++sample)
  {
    const std::size_t before = this->Parts.size();
    this->AddPart(samples[sample - 1], samples[sample], cellLength);
    for (std::size_t other = 0; this->Parts.size() > before && other < others.size(); ++other)
    {
      Part& part = this->Parts.back();
      part.Steepness = GetLarger(part.Steepness,
        GetSteepness(
          others[other][sample - 1], others[other][sample], part.End - part.Begin, cellLength));
    }
  }
  const Lanes end = ToLanes(ToEmission(samples.back().Look));
  const Part& last = this->Parts.back();
  const double width = last.End - last.Begin;
  this->Parts.push_back({ last.End, std::numeric_limits<double>::infinity(),
    last.Integral + (last.Look + Lanes(0.5 * width) * last.Growth) * Lanes(width), end, Lanes(0.0),
    end[3], 0.0, { end[3] } });
  this->SeenBefore.push_back(0);
  for (const Part& part : this->Parts)
  {
    this->SeenBefore.push_back(this->SeenBefore.back() + (part.Steepness.Extinction > 0.0 ? 1 : 0));
  }
  this->SetBins();
  this->SetWorst();
  this->SetTable();
}

TransferFunction::TransferFunction(
  double first, double last, const std::vector<glm::dvec4>& samples)
  : TransferFunction(ToSamples(first, last, samples))
{
}

void TransferFunction::AddPart(
  const FunctionSample& begin, const FunctionSample& end, double cellLength)
{
  const Part& before = this->Parts.back();
  const double first = Round(this->GetPlace(begin.Value));
  const double last = Round(this->GetPlace(end.Value));
  if (!(first < last)) // a jump
  {
    return;
  }
  const double width = last - first;
  const glm::dvec4 one = ToEmission(begin.Look);
  const glm::dvec4 other = ToEmission(end.Look);
  const double beforeWidth = before.End - before.Begin;
  const Lanes integral =
    before.Integral + (before.Look + Lanes(0.5 * beforeWidth) * before.Growth) * Lanes(beforeWidth);
  const glm::dvec4 beforeEnd = ToVector(before.Look + Lanes(beforeWidth) * before.Growth);
  const double jump =
    GetLargest(glm::abs(GetSeen(one, cellLength) - GetSeen(beforeEnd, cellLength)));
  this->Brightest = std::max({ this->Brightest, GetLargest(glm::dvec4(glm::dvec3(one), 0.0)),
    GetLargest(glm::dvec4(glm::dvec3(other), 0.0)) });
  this->Parts.push_back({ first, last, integral, ToLanes(one), ToLanes((other - one) / width),
    end.Look.w, jump, GetSteepness(begin.Look, end.Look, width, cellLength) });
}

TransferFunction::Behavior TransferFunction::GetSteepness(
  const glm::dvec4& begin, const glm::dvec4& end, double width, double cellLength)
{
  const glm::dvec4 change =
    GetSeen(ToEmission(end), cellLength) - GetSeen(ToEmission(begin), cellLength);
  return { std::max(begin.w, end.w), GetLargest(glm::abs(change)) / width,
    GetTinge(begin, end) / width };
}

void TransferFunction::SetBins()
{
  std::vector<Behavior> bins(Bins + 2);
  bins.front() = this->Parts.front().Steepness;
  bins.back() = this->Parts.back().Steepness;
  for (std::size_t number = 1; number + 1 < this->Parts.size(); ++number)
  {
    const Part& part = this->Parts[number];
    const int first = std::clamp(this->GetBin(part.Begin), 1, Bins);
    bins[static_cast<std::size_t>(first)].Change += part.Jump;
    for (int bin = first; bin <= Bins && this->Begin + bin - 1 < part.End; ++bin)
    {
      const double lower = std::max(part.Begin, this->Begin + bin - 1);
      const double upper = std::min(part.End, this->Begin + bin);
      const auto getExtinction = [&part](double place)
      { return part.Look[3] + part.Growth[3] * (place - part.Begin); };
      Behavior& own = bins[static_cast<std::size_t>(bin)];
      own.Extinction = std::max({ own.Extinction, getExtinction(lower), getExtinction(upper) });
      own.Change += part.Steepness.Change * (upper - lower);
      own.Tinge += part.Steepness.Tinge * (upper - lower);
    }
  }
  this->SeenBins.push_back(0);
  for (const Behavior& bin : bins)
  {
    this->SeenBins.push_back(this->SeenBins.back() + (bin.Extinction > 0.0 ? 1 : 0));
  }
  this->Largest.push_back(bins);
  for (std::size_t width = 1; 2 * width <= bins.size(); width *= 2)
  {
    const std::vector<Behavior>& narrow = this->Largest.back();
    std::vector<Behavior> next(bins.size() - 2 * width + 1);
    for (std::size_t bin = 0; bin < next.size(); ++bin)
    {
      next[bin] = GetLarger(narrow[bin], narrow[bin + width]);
    }
    this->Largest.push_back(std::move(next));
  }
}

void TransferFunction::SetWorst()
{
  double jumps = 0.0;
  for (const Behavior& bin : this->Largest.front())
  {
    this->Worst = GetLarger(this->Worst, bin);
  }
  for (const Part& part : this->Parts)
  {
    this->Worst = GetLarger(this->Worst, part.Steepness);
    jumps += part.Jump;
  }
  this->Worst.Change += jumps / LeastWay;
}

void TransferFunction::SetTable()
{
  for (const Part& part : this->Parts)
  {
    this->Floats.Begin.push_back(static_cast<float>(part.Begin));
    for (const Lanes& row : { part.Look, part.Growth })
    {
      for (int channel = 0; channel < 4; ++channel)
      {
        this->Floats.Rows.push_back(static_cast<float>(row[channel]));
      }
    }
  }
  this->Floats.Begin.front() = -std::numeric_limits<float>::infinity();
  this->Floats.SeenFirst = std::numeric_limits<float>::infinity();
  this->Floats.SeenLast = -std::numeric_limits<float>::infinity();
  for (std::size_t part = 0; part < this->Parts.size(); ++part)
  {
    if (this->SeenBefore[part + 1] > this->SeenBefore[part])
    {
      this->Floats.SeenFirst = std::min(this->Floats.SeenFirst, this->Floats.Begin[part]);
      this->Floats.SeenLast = part + 1 < this->Parts.size()
        ? this->Floats.Begin[part + 1]
        : std::numeric_limits<float>::infinity();
    }
  }
  this->Floats.First = static_cast<float>(this->Begin);
  // Whatever rounding does to the bin of a place.
  constexpr double slack = 1e-3;
  const auto find = [this](double place)
  {
    const auto isBehind = [](double one, const Part& part) { return one < part.Begin; };
    const auto next = std::upper_bound(this->Parts.begin(), this->Parts.end(), place, isBehind);
    return std::max<std::ptrdiff_t>(next - this->Parts.begin() - 1, 0);
  };
  std::ptrdiff_t most = 0;
  for (int bin = 0; bin < Bins; ++bin)
  {
    const std::ptrdiff_t first = find(this->Begin + bin - slack);
    this->Floats.Index.push_back(static_cast<std::int32_t>(first));
    most = std::max(most, find(this->Begin + bin + 1 + slack) - first);
  }
  this->Floats.Steps = 0;
  for (; most >> this->Floats.Steps != 0; ++this->Floats.Steps)
  {
  }
  this->Floats.Begin.insert(this->Floats.Begin.end(), std::size_t{ 1 } << this->Floats.Steps,
    std::numeric_limits<float>::infinity());
}

std::shared_ptr<const TransferFunction> TransferFunction::Create(double first, double last,
  const std::function<glm::dvec4(double)>& look, const std::vector<double>& nodes, double least,
  double cellLength)
{
  constexpr double tolerance = 1.0 / 2048.0;
  constexpr int evenSamples = 256; // find curves whose middles are on the lines between their ends
  std::vector<double> places = nodes;
  glm::dvec4 scale(0.0, 0.0, 0.0, 1.0);
  for (int sample = 0; sample <= evenSamples; ++sample)
  {
    const double value = sample == evenSamples
      ? last
      : first + (last - first) * (static_cast<double>(sample) / evenSamples);
    places.push_back(value);
    scale = glm::max(scale, glm::dvec4(glm::dvec3(look(value)), 1.0));
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
  const FunctionSamples samples(look, places, getDeviation);
  const FunctionSample begin = samples.Get(first);
  const FunctionSample end = samples.Get(last);
  std::vector<FunctionSample> all{ begin };
  const std::vector<FunctionSample> between = samples.FindBetween(begin, end);
  all.insert(all.end(), between.begin(), between.end());
  all.push_back(end);
  return std::make_shared<const TransferFunction>(all, cellLength);
}

std::size_t TransferFunction::FindPart(double place) const
{
  if (!(place >= this->Begin))
  {
    return 0;
  }
  const auto bin = static_cast<std::size_t>(std::min<double>(place - this->Begin, Bins - 1));
  auto part = static_cast<std::size_t>(this->Floats.Index[bin]);
  for (int step = this->Floats.Steps; step-- > 0;)
  {
    const std::size_t next = part + (std::size_t{ 1 } << step);
    part = static_cast<double>(this->Floats.Begin[next]) <= place ? next : part;
  }
  return part;
}

bool TransferFunction::IsPlaceSeen(double begin, double end) const
{
  const std::size_t first = this->FindPart(begin);
  const std::size_t last = this->FindPart(end);
  const auto isSeen = [&](std::size_t number, double place)
  {
    const Part& part = this->Parts[number];
    return part.Look[3] + part.Growth[3] * (place - part.Begin) > 0.0;
  };
  if (isSeen(first, begin) || isSeen(last, end))
  {
    return true;
  }
  // What is between two places of a part that are not seen is not seen either.
  return first < last &&
    (this->Parts[first].LastExtinction > 0.0 || this->Parts[last].Look[3] > 0.0 ||
      this->SeenBefore[last] > this->SeenBefore[first + 1]);
}

TransferFunction::Behavior TransferFunction::FindBinBehavior(int first, int last) const
{
  const int count = last - first + 1;
  const int level = 31 - __builtin_clz(static_cast<unsigned>(count));
  const std::vector<Behavior>& bins = this->Largest[static_cast<std::size_t>(level)];
  return GetLarger(bins[static_cast<std::size_t>(first)],
    bins[static_cast<std::size_t>(first + count - (1 << level))]);
}

TransferFunction::Behavior TransferFunction::FindBehavior(double begin, double end) const
{
  return end - begin < 1.0 ? this->FindFineBehavior(begin, end)
                           : this->FindBinBehavior(GetBin(begin), GetBin(end));
}

TransferFunction::Behavior TransferFunction::FindFineBehavior(double begin, double end) const
{
  const std::size_t last = this->FindPart(end);
  Behavior largest;
  double jumps = 0.0;
  for (std::size_t number = this->FindPart(begin); number <= last; ++number)
  {
    const Part& part = this->Parts[number];
    largest = GetLarger(largest, part.Steepness);
    if (number < last)
    {
      jumps += this->Parts[number + 1].Jump;
    }
  }
  // A jump is passed at one place of the way between the two.
  largest.Change += jumps / std::max(end - begin, LeastWay);
  return largest;
}

} // namespace rt
