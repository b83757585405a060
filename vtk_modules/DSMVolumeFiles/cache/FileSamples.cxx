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

FileSamples::FileSamples(std::shared_ptr<const VolumeFile> file, std::size_t array, int step,
  const Part& part, ChunkCache& cache, bool scattered)
  : File(std::move(file))
  , Array(array)
  , Step(step)
  , Read(part)
  , Cache(cache)
  , Scattered(scattered)
{
}

FileSamples::FileSamples(std::shared_ptr<const VolumeFile> file, std::size_t array, int step,
  ChunkCache& cache, bool scattered)
  : FileSamples(file, array, step,
      { { bricks::Index3(0), file->GetGeometry().Points }, 0, file->GetArrays()[array].Type },
      cache, scattered)
{
}

bricks::Box FileSamples::GetCells() const
{
  return { bricks::Index3(0), this->Read.Samples.GetSize() - bricks::Index3(1) };
}

void FileSamples::ReadSamples(const bricks::Box& points, std::byte* out) const
{
  const FileArray& array = this->File->GetArrays()[this->Array];
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
  return this->File->IsFill(this->Array, this->Step, { points.Min + first, points.Max + first });
}

void FileSamples::ReadBox(const bricks::Box& points, std::byte* out) const
{
  const bricks::Index3& first = this->Read.Samples.Min;
  const bricks::Box box{ points.Min + first, points.Max + first };
  this->Scattered ? this->Cache.ReadScattered(this->File, this->Array, this->Step, box, out)
                  : this->Cache.ReadBox(this->File, this->Array, this->Step, box, out);
}

} // namespace vol
