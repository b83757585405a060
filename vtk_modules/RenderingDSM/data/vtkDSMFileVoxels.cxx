// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFileVoxels.h"

#include "vtkDSMFileValues.h"
#include "vtkDSMImagePiece.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace
{

/// What samples of several components have.
struct Samples
{
  std::int64_t Count;
  int Components;
};

template <class Native>
void Pick(const Native* from, const Samples& samples, int component, Native* out)
{
  for (std::int64_t sample = 0; sample < samples.Count; ++sample)
  {
    out[sample] = from[sample * samples.Components + component];
  }
}

/// As vtkDSMImagePiece finds them.
template <class Native, class Result>
void FindMagnitudes(const Native* from, const Samples& samples, Result* out)
{
  for (std::int64_t sample = 0; sample < samples.Count; ++sample)
  {
    double sum = 0.0;
    for (int component = 0; component < samples.Components; ++component)
    {
      const auto value = static_cast<double>(from[sample * samples.Components + component]);
      sum += value * value;
    }
    out[sample] = static_cast<Result>(std::sqrt(sum));
  }
}

} // namespace

vtkDSMFileVoxels::vtkDSMFileVoxels(std::shared_ptr<const vtkDSMFileValues> values, int component,
  bricks::ScalarType type, bool scattered)
  : Values(std::move(values))
  , Component(component)
  , Type(type)
  , Scattered(scattered)
{
}

bricks::Box vtkDSMFileVoxels::GetCells() const
{
  return { bricks::Index3(0), this->Values->GetBox().GetSize() - bricks::Index3(1) };
}

void vtkDSMFileVoxels::ReadSamples(const bricks::Box& points, std::byte* out) const
{
  const vol::FileArray& array = this->Values->GetArray();
  if (array.Components == 1)
  {
    this->ReadBox(points, out);
    return;
  }
  const Samples count{ points.GetCount(), array.Components };
  std::vector<std::byte> samples(static_cast<std::size_t>(count.Count) * array.GetSampleBytes());
  this->ReadBox(points, samples.data());
  bricks::Dispatch(array.Type,
    [&](auto zero)
    {
      using Native = decltype(zero);
      const auto* from = reinterpret_cast<const Native*>(samples.data());
      if (this->Component != vtkDSMImagePiece::Magnitude)
      {
        Pick(from, count, this->Component, reinterpret_cast<Native*>(out));
      }
      else if (this->Type == bricks::ScalarType::Float32)
      {
        FindMagnitudes(from, count, reinterpret_cast<float*>(out));
      }
      else
      {
        FindMagnitudes(from, count, reinterpret_cast<double*>(out));
      }
    });
}

void vtkDSMFileVoxels::ReadBox(const bricks::Box& points, std::byte* out) const
{
  if (!this->Scattered)
  {
    this->Values->ReadBox(points, out);
    return;
  }
  this->Values->ReadScattered(points, out);
}
