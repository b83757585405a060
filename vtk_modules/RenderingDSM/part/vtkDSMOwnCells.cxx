// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMOwnCells.h"

#include "vtkDataObject.h"

#include <algorithm>
#include <utility>

namespace
{

using bricks::Index3;

bool HasAny(const double values[8], const std::vector<double>& isovalues)
{
  const auto [least, greatest] = std::minmax_element(values, values + 8);
  return std::any_of(isovalues.begin(), isovalues.end(),
    [low = *least, high = *greatest](double isovalue)
    { return low < isovalue && isovalue <= high; });
}

} // namespace

vtkDSMOwnCells::vtkDSMOwnCells(Datasets datasets)
  : Sets(std::move(datasets))
{
}

vtkDSMOwnCells::~vtkDSMOwnCells() = default;

vtkIdType vtkDSMOwnCells::FindBricks(const std::vector<double>& isovalues)
{
  this->Isovalues = isovalues;
  this->AddBricks(rt::IsovaluePredicate(isovalues));
  return static_cast<vtkIdType>(this->Ids.size()) * (this->Edge.x * this->Edge.y * this->Edge.z);
}

void vtkDSMOwnCells::ForEach(rt::FieldReader& reader, dsm::FunctionRef<void(const Cell&)> visit)
{
  std::size_t number = 0;
  Cell cell;
  reader.ReadBricks(*this->Segment, this->Type, this->Ids,
    [&](dsm::BlockId, const rt::FieldReader::Brick& brick)
    {
      this->Begin(number++, brick.Cells);
      const Index3 row = brick.Cells + Index3(1);
      auto holdsData = brick.HoldsData.begin();
      bricks::ForEachIndex({ Index3(0), brick.Cells },
        [&](const Index3& in)
        {
          if (*holdsData++ == 0)
          {
            return;
          }
          ForEachCorner(
            [&](int corner, const Index3& more)
            {
              const Index3 at = in + more;
              cell.Values[corner] =
                brick.Samples[static_cast<std::size_t>(at.x + row.x * (at.y + row.y * at.z))];
            });
          if (HasAny(cell.Values, this->Isovalues) && this->Complete(in, cell))
          {
            visit(cell);
          }
        });
    });
}
