// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMMeshColors.h"

#include "vtkDSMColorBytes.h"

#include "vtkDataArray.h"
#include "vtkMapper.h"
#include "vtkPolyData.h"
#include "vtkScalarsToColors.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{

/// Values of vtkAbstractMapper::GetAbstractScalars for the owner of an array.
constexpr int CellField = 1;
constexpr int WholeField = 2;

/// Returns whether the array's numbers already are colors.
bool HoldsColors(vtkMapper* mapper, vtkAbstractArray* array)
{
  switch (mapper->GetColorMode())
  {
    case VTK_COLOR_MODE_DIRECT_SCALARS:
      return vtkDataArray::SafeDownCast(array) != nullptr;
    case VTK_COLOR_MODE_DEFAULT:
      return vtkUnsignedCharArray::SafeDownCast(array) != nullptr;
    default:
      return false;
  }
}

int GetComponent(vtkMapper* mapper, vtkDataArray* array)
{
  vtkScalarsToColors* table = mapper->GetLookupTable();
  const int last = array->GetNumberOfComponents() - 1;
  if (mapper->GetArrayComponent() >= 0)
  {
    return std::min(mapper->GetArrayComponent(), last);
  }
  if (last == 0)
  {
    return 0;
  }
  return table->GetVectorMode() == vtkScalarsToColors::COMPONENT
    ? std::clamp(table->GetVectorComponent(), 0, last)
    : -1;
}

} // namespace

vtkAbstractArray* vtkDSMMeshColors::FindArray(vtkMapper* mapper, vtkPolyData* data, int& field)
{
  field = 0;
  const bool byName = mapper->GetScalarMode() >= VTK_SCALAR_MODE_USE_POINT_FIELD_DATA &&
    mapper->GetArrayAccessMode() == VTK_GET_ARRAY_BY_NAME;
  return mapper->GetScalarVisibility() && !(byName && !mapper->GetArrayName())
    ? vtkAbstractMapper::GetAbstractScalars(data, mapper->GetScalarMode(),
        mapper->GetArrayAccessMode(), mapper->GetArrayId(), mapper->GetArrayName(), field)
    : nullptr;
}

bool vtkDSMMeshColors::DependsOnTable(vtkMapper* mapper, vtkAbstractArray* array)
{
  if (HoldsColors(mapper, array))
  {
    return false;
  }
  vtkScalarsToColors* table = mapper->GetLookupTable();
  return table->GetIndexedLookup() || !vtkDataArray::SafeDownCast(array) ||
    (table->GetVectorMode() == vtkScalarsToColors::RGBCOLORS && array->GetNumberOfComponents() > 1);
}

vtkDSMMeshColors::vtkDSMMeshColors(vtkMapper* mapper, vtkPolyData* data)
{
  if (!mapper->GetScalarVisibility())
  {
    return;
  }
  int field = 0;
  vtkAbstractArray* array = FindArray(mapper, data, field);
  if (!array)
  {
    // As in VTK, requesting the active scalars is not an error if there are none.
    const bool named = mapper->GetScalarMode() == VTK_SCALAR_MODE_USE_POINT_FIELD_DATA ||
      mapper->GetScalarMode() == VTK_SCALAR_MODE_USE_CELL_FIELD_DATA ||
      mapper->GetScalarMode() == VTK_SCALAR_MODE_USE_FIELD_DATA;
    this->Found = named ? State::Missing : State::NotAsked;
    return;
  }
  this->Length = array->GetNumberOfTuples();
  this->ExpectedLength = this->Length;
  if (field == WholeField)
  {
    this->OnlyElement = mapper->GetFieldDataTupleId() >= 0 ? mapper->GetFieldDataTupleId() : 0;
    this->ExpectedLength = std::max(this->Length, this->OnlyElement + 1);
  }
  else
  {
    this->ExpectedLength =
      field == CellField ? data->GetNumberOfCells() : data->GetNumberOfPoints();
  }
  if (this->Length != this->ExpectedLength)
  {
    this->Found = State::WrongLength;
    return;
  }
  auto* numbers = vtkDataArray::SafeDownCast(array);
  if (!numbers && !mapper->GetLookupTable()->GetIndexedLookup())
  {
    this->Found = State::Text;
    return;
  }
  const bool holdsColors = HoldsColors(mapper, array);
  if (holdsColors || DependsOnTable(mapper, array))
  {
    vtkSmartPointer<vtkAbstractArray> values = array;
    if (holdsColors)
    {
      values = vtkDSMColorBytes::Convert(numbers);
    }
    this->Colors.TakeReference(mapper->GetLookupTable()->MapScalars(
      values, mapper->GetColorMode(), mapper->GetArrayComponent()));
  }
  else
  {
    this->Values = numbers;
    this->Component = GetComponent(mapper, numbers);
  }
  this->Attached = field == 0 ? bricks::Attachment::Points : bricks::Attachment::Triangles;
  this->Found = State::Usable;
}

bricks::Attachment vtkDSMMeshColors::GetValues() const
{
  return this->Values ? this->Attached : bricks::Attachment::None;
}

bricks::Attachment vtkDSMMeshColors::GetColors() const
{
  return this->Colors ? this->Attached : bricks::Attachment::None;
}

double vtkDSMMeshColors::GetValue(vtkIdType element) const
{
  const vtkIdType tuple = this->OnlyElement >= 0 ? this->OnlyElement : element;
  if (this->Component >= 0)
  {
    return this->Values->GetComponent(tuple, this->Component);
  }
  double sum = 0.0;
  for (int component = 0; component < this->Values->GetNumberOfComponents(); ++component)
  {
    const double number = this->Values->GetComponent(tuple, component);
    sum += number * number;
  }
  return std::sqrt(sum);
}

void vtkDSMMeshColors::GetColor(vtkIdType element, std::uint8_t rgba[4]) const
{
  const vtkIdType tuple = this->OnlyElement >= 0 ? this->OnlyElement : element;
  std::copy_n(this->Colors->GetPointer(4 * tuple), 4, rgba);
}
