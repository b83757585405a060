// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/write/ReducedOrigin.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace vol
{

namespace
{

constexpr std::int64_t LeastPoints = 3;

bricks::Index3 FindFactors(const bricks::Index3& points)
{
  bricks::Index3 factors(1);
  for (int axis = 0; axis < 3; ++axis)
  {
    factors[axis] = points[axis] >= LeastPoints ? 2 : 1;
  }
  return factors;
}

/// Wide enough for the sum of eight.
template <class T>
using Sum = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, long double, double>;

template <class T>
T ToValue(Sum<T> sum, int count)
{
  const Sum<T> mean = sum / static_cast<Sum<T>>(count);
  if constexpr (std::is_integral_v<T>)
  {
    return static_cast<T>(std::nearbyint(mean));
  }
  return static_cast<T>(mean);
}

/// The samples of `fineBox` and `box` are dense; both begin where the factors say.
template <class T>
void Average(const T* fine, const bricks::Box& fineBox, const bricks::Index3& factors,
  int components, const bricks::ValidValues& valid, const bricks::Box& box, T* out)
{
  const bricks::MissingTest<T> isMissing(valid);
  const bricks::Index3 has = fineBox.GetSize();
  const bricks::Index3 size = box.GetSize();
  bricks::ForEachIndex({ bricks::Index3(0), size },
    [&](const bricks::Index3& at)
    {
      const bricks::Index3 first = at * factors;
      const auto get = [&](const bricks::Index3& from, int component)
      { return fine[((from.z * has.y + from.y) * has.x + from.x) * components + component]; };
      for (int component = 0; component < components; ++component)
      {
        Sum<T> sum = 0;
        int count = 0;
        bricks::ForEachIndex({ first, glm::min(first + factors, has) },
          [&](const bricks::Index3& from)
          {
            const T value = get(from, component);
            if (!isMissing(value))
            {
              sum += static_cast<Sum<T>>(value);
              ++count;
            }
          });
        // Without any value, the first one, which is missing, remains.
        *out++ = count > 0 ? ToValue<T>(sum, count) : get(first, component);
      }
    });
}

/// Every sample that the factors say; `fineBox` begins with the first.
void Pick(const std::byte* fine, const bricks::Box& fineBox, const bricks::Index3& factors,
  std::size_t sampleBytes, const bricks::Box& box, std::byte* out)
{
  const bricks::Index3 has = fineBox.GetSize();
  const bricks::Index3 size = box.GetSize();
  bricks::ForEachIndex({ bricks::Index3(0), size },
    [&](const bricks::Index3& at)
    {
      const bricks::Index3 from = at * factors;
      const std::int64_t number = (from.z * has.y + from.y) * has.x + from.x;
      const std::byte* const sample = fine + static_cast<std::size_t>(number) * sampleBytes;
      out = std::copy(sample, sample + sampleBytes, out);
    });
}

} // namespace

ReducedOrigin::ReducedOrigin(
  std::shared_ptr<const VolumeFile> file, std::string source, int ranks, std::size_t cacheBytes)
  : File(std::move(file))
  , Source(std::move(source))
  , Ranks(ranks)
  , Factors(FindFactors(this->File->GetGeometry().Points))
  , Geometry(this->File->GetGeometry())
  , Arrays(this->File->GetArrays())
  , Cache(cacheBytes)
{
  const FileGeometry& fine = this->File->GetGeometry();
  double shift[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double between = this->Factors[axis] == 2 ? 0.5 : 0.0;
    shift[axis] = fine.Spacing[axis] * (static_cast<double>(fine.First[axis]) + between);
    this->Geometry.Spacing[axis] *= static_cast<double>(this->Factors[axis]);
  }
  for (int row = 0; row < 3; ++row)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Geometry.Origin[row] += fine.Direction[3 * row + axis] * shift[axis];
    }
  }
  this->Geometry.First = bricks::Index3(0);
  this->Geometry.Points = (fine.Points + this->Factors - bricks::Index3(1)) / this->Factors;
  const bricks::Index3 cells =
    glm::max(this->Geometry.Points - bricks::Index3(1), bricks::Index3(1));
  for (FileArray& array : this->Arrays)
  {
    array.Grid.Samples = array.OnCells ? cells : this->Geometry.Points;
  }
}

bool ReducedOrigin::CanReduce(const FileGeometry& geometry)
{
  return FindFactors(geometry.Points) != bricks::Index3(1);
}

std::vector<int> ReducedOrigin::Deal(std::size_t, const std::vector<bricks::Box>& boxes)
{
  std::vector<int> ranks(boxes.size());
  for (std::size_t box = 0; box < boxes.size(); ++box)
  {
    ranks[box] = static_cast<int>(box * static_cast<std::size_t>(this->Ranks) / boxes.size());
  }
  return ranks;
}

bricks::Box ReducedOrigin::GetFineBox(std::size_t array, const bricks::Box& box) const
{
  if (!this->Arrays[array].OnCells)
  {
    const bricks::Index3 end = this->File->GetArrays()[array].Grid.Samples;
    return { box.Min * this->Factors, glm::min(box.Max * this->Factors, end) };
  }
  // The center of cell i of this array is that of cell 2 i + 1 of the file.
  const bricks::Index3 centre = this->Factors - bricks::Index3(1);
  return { box.Min * this->Factors + centre,
    (box.Max - bricks::Index3(1)) * this->Factors + centre + bricks::Index3(1) };
}

void ReducedOrigin::Read(std::size_t number, const bricks::Box& box, std::byte* out) const
{
  const FileArray& array = this->Arrays[number];
  const bricks::Box fineBox = this->GetFineBox(number, box);
  ByteBuffer fine(static_cast<std::size_t>(fineBox.GetCount()) * array.GetSampleBytes());
  this->Cache.ReadBox({ this->File, number, 0 }, fineBox, fine.data());
  if (array.OnCells)
  {
    Pick(fine.data(), fineBox, this->Factors, array.GetSampleBytes(), box, out);
    return;
  }
  bricks::Dispatch(array.Type,
    [&](auto zero)
    {
      using T = decltype(zero);
      Average(reinterpret_cast<const T*>(fine.data()), fineBox, this->Factors, array.Components,
        this->File->GetArrays()[number].Valid, box, reinterpret_cast<T*>(out));
    });
}

} // namespace vol
