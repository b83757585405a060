// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/ValidSource.h"

#include <utility>
#include <vector>

namespace bricks
{

std::shared_ptr<const VoxelSource> ValidSource::Make(
  std::shared_ptr<const VoxelSource> source, const BrickLattice& lattice, const ValidValues& valid)
{
  return valid.Exclude(lattice.GetScalarType())
    ? std::make_shared<ValidSource>(std::move(source), lattice, valid)
    : source;
}

ValidSource::ValidSource(
  std::shared_ptr<const VoxelSource> source, const BrickLattice& lattice, const ValidValues& valid)
  : Source(std::move(source))
  , Type(lattice.GetScalarType())
  , OfCells(lattice.IsOfCells())
  , Valid(valid)
{
}

void ValidSource::ReadCellMask(const Box& cells, std::uint8_t* out) const
{
  this->Source->ReadCellMask(cells, out);
  const Index3 more(this->OfCells ? 0 : 1);
  const Box points{ cells.Min, cells.Max + more };
  std::vector<std::byte> samples(
    static_cast<std::size_t>(points.GetCount()) * GetBytes(this->Type));
  this->Source->ReadSamples(points, samples.data());
  Dispatch(this->Type,
    [&](auto zero)
    {
      using T = decltype(zero);
      const MissingTest<T> isMissing(this->Valid);
      const auto* value = reinterpret_cast<const T*>(samples.data());
      const Index3 size = cells.GetSize();
      ForEachIndex(points,
        [&](const Index3& at)
        {
          if (!isMissing(*value++))
          {
            return;
          }
          ForEachIndex(Intersect({ at - more, at + Index3(1) }, cells),
            [&](const Index3& cell)
            {
              const Index3 in = cell - cells.Min;
              out[in.x + size.x * (in.y + size.y * in.z)] = 0;
            });
        });
    });
}

} // namespace bricks
