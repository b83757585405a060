// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMCellPiece.h"

#include "vtkDSMImagePiece.h"

#include "vtkDataArray.h"
#include "vtkDataSet.h"

#include <cstring>
#include <utility>

vtkDSMCellPiece::vtkDSMCellPiece(vtkDataSet* image, vtkDataArray* array, int component,
  const bricks::LatticePlan::Member& place, bool hasMask, const bricks::ValidValues& valid,
  std::optional<vtkDSMCellMask> mask)
  : Array(array)
  , Component(component)
  , Masked(hasMask || valid.Exclude(vtkDSMImagePiece::GetScalarType(array, component)))
  , Valid(valid)
  , Mask(std::move(mask))
{
  const bool isOne = component >= 0 || array->GetNumberOfComponents() == 1;
  for (int part = 0; part < (isOne ? 1 : array->GetNumberOfComponents()); ++part)
  {
    this->Parts.emplace_back(
      image, array, isOne ? std::max(component, 0) : part, place, hasMask, true);
  }
}

vtkDSMCellPiece::~vtkDSMCellPiece() = default;

bricks::Box vtkDSMCellPiece::GetCells() const
{
  return this->Parts.front().GetCells();
}

bricks::Box vtkDSMCellPiece::GetReach() const
{
  return this->Parts.front().GetSamples();
}

void vtkDSMCellPiece::ReadStates(const bricks::Box& cells, std::uint8_t* out) const
{
  this->Parts.front().ReadCellStates(cells, out);
  if (this->Mask)
  {
    static_assert(NoData == 0, "what masks set");
    this->Mask->Apply(cells, out);
  }
  const bricks::ScalarType type = vtkDSMImagePiece::GetScalarType(this->Array, this->Component);
  if (!this->Valid.Exclude(type))
  {
    return;
  }
  const auto count = static_cast<std::size_t>(cells.GetCount());
  std::vector<std::byte> samples(count * bricks::GetBytes(type));
  vtkDSMImagePiece::ReadSamples(
    this->Array, this->Component, this->GetReach(), cells, samples.data());
  bricks::Dispatch(type,
    [&](auto zero)
    {
      using T = decltype(zero);
      const bricks::MissingTest<T> isMissing(this->Valid);
      const auto* const values = reinterpret_cast<const T*>(samples.data());
      for (std::size_t cell = 0; cell < count; ++cell)
      {
        out[cell] = isMissing(values[cell]) ? std::uint8_t{ NoData } : out[cell];
      }
    });
}

int vtkDSMCellPiece::CountComponents() const
{
  return static_cast<int>(this->Parts.size());
}

bricks::ScalarType vtkDSMCellPiece::GetType() const
{
  return vtkDSMImagePiece::GetScalarType(this->Array, 0);
}

void vtkDSMCellPiece::ReadValues(int component, const bricks::Box& cells, std::byte* out) const
{
  this->Parts[static_cast<std::size_t>(component)].ReadSamples(cells, out);
}

void vtkDSMCellPiece::Combine(std::size_t count, const std::byte* values, std::byte* samples) const
{
  const std::size_t size = bricks::GetBytes(this->GetType());
  const std::size_t components = this->Parts.size();
  if (components == 1 && this->Component != vtkDSMImagePiece::Color)
  {
    std::memcpy(samples, values, count * size);
    return;
  }
  const int type = this->Array->GetDataType();
  vtkSmartPointer<vtkDataArray> tuples;
  tuples.TakeReference(vtkDataArray::CreateDataArray(type == VTK_BIT ? VTK_UNSIGNED_CHAR : type));
  tuples->SetNumberOfComponents(static_cast<int>(components));
  tuples->SetNumberOfTuples(static_cast<vtkIdType>(count));
  auto* const out = static_cast<std::byte*>(tuples->GetVoidPointer(0));
  for (std::size_t tuple = 0; tuple < count; ++tuple)
  {
    for (std::size_t component = 0; component < components; ++component)
    {
      std::memcpy(out + (tuple * components + component) * size,
        values + (component * count + tuple) * size, size);
    }
  }
  const bricks::Box all{ bricks::Index3(0),
    bricks::Index3(static_cast<std::int64_t>(count), 1, 1) };
  vtkDSMImagePiece::ReadSamples(tuples, this->Component, all, all, samples);
}
