// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/cache/FileCells.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vol
{

FileCells::FileCells(
  const ArrayStep& of, const FileSamples::Part& part, ChunkCache& cache, bool scattered)
  : Cells{ bricks::Index3(0), part.Samples.GetSize() }
  , Type(of.Get().Type)
  , ResultType(part.Type)
  , IsMagnitude(part.Component == FileSamples::Magnitude && of.Get().Components > 1)
{
  const int count = this->IsMagnitude ? of.Get().Components : 1;
  for (int number = 0; number < count; ++number)
  {
    const int component = this->IsMagnitude ? number : std::max(part.Component, 0);
    this->Components.emplace_back(
      of, FileSamples::Part{ part.Samples, component, this->Type }, cache, scattered);
  }
}

void FileCells::ReadStates(const bricks::Box& cells, std::uint8_t* out) const
{
  std::fill_n(out, cells.GetCount(), std::uint8_t(Own));
}

void FileCells::ReadValues(int component, const bricks::Box& cells, std::byte* out) const
{
  this->Components[static_cast<std::size_t>(component)].ReadSamples(cells, out);
}

void FileCells::Combine(std::size_t count, const std::byte* values, std::byte* samples) const
{
  if (!this->IsMagnitude)
  {
    std::memcpy(samples, values, count * bricks::GetBytes(this->Type));
    return;
  }
  std::vector<double> sums(count, 0.0);
  bricks::Dispatch(this->Type,
    [&](auto zero)
    {
      const auto* from = reinterpret_cast<const decltype(zero)*>(values);
      for (std::size_t component = 0; component < this->Components.size(); ++component)
      {
        for (double& sum : sums)
        {
          const auto value = static_cast<double>(*from++);
          sum += value * value;
        }
      }
    });
  bricks::Dispatch(this->ResultType,
    [&](auto zero)
    {
      auto* const out = reinterpret_cast<decltype(zero)*>(samples);
      for (std::size_t sample = 0; sample < count; ++sample)
      {
        out[sample] = static_cast<decltype(zero)>(std::sqrt(sums[sample]));
      }
    });
}

} // namespace vol
