// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/cache/FileSamples.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

/// Number of samples, and of their components.
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

FileSamples::FileSamples(const ArrayStep& of, const Part& part, ChunkCache& cache, bool scattered)
  : Of(of)
  , Read(part)
  , Cache(cache)
  , Scattered(scattered)
{
}

FileSamples::FileSamples(const ArrayStep& of, ChunkCache& cache, bool scattered)
  : FileSamples(of, { { bricks::Index3(0), of.File->GetGeometry().Points }, 0, of.Get().Type },
      cache, scattered)
{
}

bricks::Box FileSamples::GetCells() const
{
  return { bricks::Index3(0), this->Read.Samples.GetSize() - bricks::Index3(1) };
}

void FileSamples::ReadSamples(const bricks::Box& points, std::byte* out) const
{
  const FileArray& array = this->Of.Get();
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
      if (this->Read.Component != Magnitude)
      {
        Pick(from, count, this->Read.Component, reinterpret_cast<Native*>(out));
      }
      else if (this->Read.Type == bricks::ScalarType::Float32)
      {
        FindMagnitudes(from, count, reinterpret_cast<float*>(out));
      }
      else
      {
        FindMagnitudes(from, count, reinterpret_cast<double*>(out));
      }
    });
}

bool FileSamples::IsFill(const bricks::Box& points) const
{
  const bricks::Index3& first = this->Read.Samples.Min;
  return this->Of.File->IsFill(
    this->Of.Array, this->Of.Step, { points.Min + first, points.Max + first });
}

void FileSamples::ReadBox(const bricks::Box& points, std::byte* out) const
{
  const bricks::Index3& first = this->Read.Samples.Min;
  const bricks::Box box{ points.Min + first, points.Max + first };
  this->Scattered ? this->Cache.ReadScattered(this->Of, box, out)
                  : this->Cache.ReadBox(this->Of, box, out);
}

} // namespace vol
