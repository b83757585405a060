// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMNestedSource.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace
{

using bricks::Box;
using bricks::Index3;

/// Values at the points of a box, x fastest, become those at other places along one axis. `getPlace(number)`: where the
/// new point `number` lies, in indices of the old ones along the axis.
template <class GetPlace>
std::vector<double> Resample(const std::vector<double>& values, Index3& size, int axis,
  std::int64_t count, const GetPlace& getPlace)
{
  const Index3 strides(1, size.x, size.x * size.y);
  Index3 newSize = size;
  newSize[axis] = count;
  std::vector<std::pair<std::int64_t, double>> places;
  for (std::int64_t number = 0; number < count; ++number)
  {
    const double place = getPlace(number);
    const auto below = std::min(static_cast<std::int64_t>(place), size[axis] - 1);
    places.emplace_back(below, place - static_cast<double>(below));
  }
  std::vector<double> result(static_cast<std::size_t>(newSize.x * newSize.y * newSize.z));
  auto* out = result.data();
  bricks::ForEachIndex({ Index3(0), newSize },
    [&](const Index3& point)
    {
      Index3 at = point;
      const auto& [below, rest] = places[static_cast<std::size_t>(point[axis])];
      at[axis] = below;
      const double* const value = values.data() + at.x + strides.y * at.y + strides.z * at.z;
      *out++ = rest > 0.0 ? value[0] + rest * (value[strides[axis]] - value[0]) : value[0];
    });
  size = newSize;
  return result;
}

} // namespace

vtkDSMNestedSource::vtkDSMNestedSource(const Level& level, const bricks::Box& box,
  bricks::ScalarType type, std::shared_ptr<const vtkDSMNestedSource> coarser, const Index3& ratio)
  : Of(level)
  , Box(box)
  , Type(type)
  , Coarser(std::move(coarser))
  , Ratio(ratio)
{
}

void vtkDSMNestedSource::ReadSamples(const bricks::Box& points, std::byte* out) const
{
  const Values values = this->Find({ points.Min + this->Box.Min, points.Max + this->Box.Min });
  if (this->Type == bricks::ScalarType::Float32)
  {
    std::transform(values.begin(), values.end(), reinterpret_cast<float*>(out),
      [](double value) { return static_cast<float>(value); });
  }
  else
  {
    std::memcpy(out, values.data(), values.size() * sizeof(double));
  }
}

bricks::Box vtkDSMNestedSource::GetSamples(const bricks::Box& points) const
{
  return this->GetSamplesAt({ points.Min + this->Box.Min, points.Max + this->Box.Min });
}

/// The place of a point along an axis among the file's samples. A last cell may reach over the last one.
double vtkDSMNestedSource::GetSample(int axis, std::int64_t point) const
{
  return glm::clamp(this->Of.First[axis] + this->Of.Step[axis] * static_cast<double>(point), 0.0,
    static_cast<double>(this->Of.Count[axis] - 1));
}

bricks::Box vtkDSMNestedSource::GetSamplesAt(const bricks::Box& points) const
{
  bricks::Box samples;
  for (int axis = 0; axis < 3; ++axis)
  {
    samples.Min[axis] =
      static_cast<std::int64_t>(std::floor(this->GetSample(axis, points.Min[axis])));
    samples.Max[axis] =
      static_cast<std::int64_t>(std::ceil(this->GetSample(axis, points.Max[axis] - 1))) + 1;
  }
  return samples;
}

vtkDSMNestedSource::Values vtkDSMNestedSource::FindWithin(const bricks::Box& points) const
{
  const bricks::Box samples = this->GetSamplesAt(points);
  Index3 size = samples.GetSize();
  std::vector<std::byte> read(
    static_cast<std::size_t>(samples.GetCount()) * bricks::GetBytes(this->Of.Type));
  this->Of.Samples->ReadSamples(samples, read.data());
  Values values(static_cast<std::size_t>(samples.GetCount()));
  bricks::Dispatch(this->Of.Type,
    [&](auto zero)
    {
      using Native = decltype(zero);
      const auto* const first = reinterpret_cast<const Native*>(read.data());
      std::transform(first, first + values.size(), values.begin(),
        [](Native value) { return static_cast<double>(value); });
    });
  const Index3 wanted = points.GetSize();
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->Of.First[axis] == 0.0 && this->Of.Step[axis] == 1.0 && size[axis] == wanted[axis])
    {
      continue; // the samples are at the points
    }
    values = Resample(values, size, axis, wanted[axis],
      [&](std::int64_t number)
      {
        return this->GetSample(axis, points.Min[axis] + number) -
          static_cast<double>(samples.Min[axis]);
      });
  }
  return values;
}

vtkDSMNestedSource::Values vtkDSMNestedSource::Find(const bricks::Box& points) const
{
  Values values = this->FindWithin(points);
  const Index3 size = points.GetSize();
  for (int side = 0; this->Coarser && side < 6; ++side)
  {
    const int axis = side / 2;
    const std::int64_t face = side % 2 == 0 ? this->Box.Min[axis] : this->Box.Max[axis];
    const bool isOfDataset = face == (side % 2 == 0 ? 0 : this->Of.Cells[axis]);
    if (isOfDataset || face < points.Min[axis] || face >= points.Max[axis])
    {
      continue;
    }
    bricks::Box on = points;
    on.Min[axis] = face;
    on.Max[axis] = face + 1;
    const Values coarser = this->Coarser->Interpolate(on, this->Ratio);
    auto next = coarser.begin();
    bricks::ForEachIndex(on,
      [&](const Index3& point)
      {
        const Index3 at = point - points.Min;
        values[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))] = *next++;
      });
  }
  return values;
}

vtkDSMNestedSource::Values vtkDSMNestedSource::Interpolate(
  const bricks::Box& points, const Index3& ratio) const
{
  const bricks::Box own{ points.Min / ratio,
    (points.Max - Index3(1) + ratio - Index3(1)) / ratio + Index3(1) };
  Values values = this->Find(own);
  Index3 size = own.GetSize();
  const Index3 wanted = points.GetSize();
  for (int axis = 0; axis < 3; ++axis)
  {
    values = Resample(values, size, axis, wanted[axis],
      [&](std::int64_t number)
      {
        return static_cast<double>(points.Min[axis] + number) / static_cast<double>(ratio[axis]) -
          static_cast<double>(own.Min[axis]);
      });
  }
  return values;
}
