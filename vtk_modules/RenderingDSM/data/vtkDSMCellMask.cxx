// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMCellMask.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"

#include <algorithm>
#include <cstddef>

vtkDSMCellMask::vtkDSMCellMask(vtkDataSet* image, const vtkDSMImageArrays::Choice& choice,
  const bricks::LatticePlan::Member& place)
  : Shown(choice.Mask)
{
  std::sort(this->Shown.Values.begin(), this->Shown.Values.end());
  vtkDSMImageArrays::Info info;
  if (vtkDataArray* const array = vtkDSMImageArrays::Find(image, choice.GetMaskArray(), info))
  {
    this->Array.emplace(image, array, 0, place, false, this->Shown.OnCells);
    this->Type = info.Type;
  }
}

vtkDSMCellMask::~vtkDSMCellMask() = default;

void vtkDSMCellMask::Apply(const bricks::Box& cells, std::uint8_t* out) const
{
  using bricks::Index3;
  if (!this->Array)
  {
    std::fill_n(out, cells.GetCount(), std::uint8_t{ 0 });
    return;
  }
  const Index3 more(this->Shown.OnCells ? 0 : 1);
  const bricks::Box samples{ cells.Min, cells.Max + more };
  std::vector<std::byte> bytes(
    static_cast<std::size_t>(samples.GetCount()) * bricks::GetBytes(this->Type));
  this->Array->ReadSamples(samples, bytes.data());
  bricks::Dispatch(this->Type,
    [&](auto zero)
    {
      const auto* value = reinterpret_cast<const decltype(zero)*>(bytes.data());
      const Index3 size = cells.GetSize();
      bricks::ForEachIndex(samples,
        [&](const Index3& at)
        {
          if (this->Shown.Shows(static_cast<double>(*value++)))
          {
            return;
          }
          bricks::ForEachIndex(bricks::Intersect({ at - more, at + Index3(1) }, cells),
            [&](const Index3& cell)
            {
              const Index3 in = cell - cells.Min;
              out[in.x + size.x * (in.y + size.y * in.z)] = 0;
            });
        });
    });
}
