// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMMeshContent.h"

#include "DSMBricks/base/ByteHash.h"
#include "vtkDSMContent.h"
#include "vtkDSMMeshColors.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkScalarsToColors.h"

#include <cstring>

void vtkDSMMeshContent::AddNumber(std::vector<std::uint64_t>& numbers, double number)
{
  std::uint64_t bits;
  std::memcpy(&bits, &number, sizeof(bits));
  numbers.push_back(bits);
}

std::vector<std::uint64_t> vtkDSMMeshContent::GetStamp(const vtkDSMMeshInput& input)
{
  // Times of change are unique in a process: the same place and time is the same array.
  std::vector<std::uint64_t> numbers = Describe(input,
    [](vtkAbstractArray* array)
    {
      const std::uint64_t identity[] = { reinterpret_cast<std::uintptr_t>(array),
        array ? array->GetMTime() : 0 };
      bricks::ByteHash hash;
      hash.Add(identity, sizeof(identity));
      return hash.Get();
    }).Whole;
  // A filter that writes new values to an old array may not mark the array as modified.
  for (const vtkDSMMeshBlock& block : input.CollectBlocks())
  {
    numbers.push_back(block.Data->GetMTime());
  }
  vtkDataObject* data = input.GetData();
  numbers.push_back(reinterpret_cast<std::uintptr_t>(data));
  numbers.push_back(data ? data->GetMTime() : 0);
  numbers.push_back(data ? data->GetUpdateTime() : 0);
  return numbers;
}

vtkDSMMeshContent vtkDSMMeshContent::Hash(const vtkDSMMeshInput& input, int threads)
{
  return Describe(
    input, [threads](vtkAbstractArray* array) { return vtkDSMContent::Hash(array, threads); });
}

std::vector<std::uint64_t> vtkDSMMeshContent::DescribeBlock(
  const vtkDSMMeshInput& input, const vtkDSMMeshBlock& block, const Identify& identify)
{
  vtkMapper* mapper = input.Mapper;
  std::vector<std::uint64_t> numbers;
  const auto addArray = [&](vtkAbstractArray* array) { numbers.push_back(identify(array)); };
  vtkScalarsToColors* table = mapper->GetLookupTable();
  vtkPolyData* data = block.Data;
  addArray(data->GetPoints()->GetData());
  for (vtkCellArray* cells :
    { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
  {
    addArray(cells->GetNumberOfCells() > 0 ? cells->GetOffsetsArray() : nullptr);
    addArray(cells->GetNumberOfCells() > 0 ? cells->GetConnectivityArray() : nullptr);
  }
  addArray(data->GetPointData()->GetNormals());
  addArray(data->GetPointData()->GetNormals() ? nullptr : data->GetCellData()->GetNormals());
  addArray(input.Wish.TextureCoordinates ? data->GetPointData()->GetTCoords() : nullptr);
  addArray(data->GetCellData()->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  addArray(data->GetPointData()->GetAttribute(vtkDataSetAttributes::EDGEFLAG));
  addArray(data->GetPointData()->GetAbstractArray(input.RadiusArray.c_str()));
  int field = 0;
  vtkAbstractArray* colors = vtkDSMMeshColors::FindArray(mapper, data, field);
  addArray(colors);
  if (colors)
  {
    AddNumber(numbers, field);
    AddNumber(numbers, mapper->GetColorMode());
    AddNumber(numbers, mapper->GetArrayComponent());
    AddNumber(numbers, static_cast<double>(mapper->GetFieldDataTupleId()));
    if (colors->GetNumberOfComponents() > 1)
    {
      AddNumber(numbers, table->GetVectorMode());
      AddNumber(numbers, table->GetVectorComponent());
    }
    if (vtkDSMMeshColors::DependsOnTable(mapper, colors))
    {
      numbers.push_back(reinterpret_cast<std::uintptr_t>(table));
      numbers.push_back(table->GetMTime());
    }
  }
  return numbers;
}

vtkDSMMeshContent vtkDSMMeshContent::Describe(
  const vtkDSMMeshInput& input, const Identify& identify)
{
  vtkMapper* mapper = input.Mapper;
  vtkDSMMeshContent content;
  std::vector<std::uint64_t>& numbers = content.Whole;
  AddNumber(numbers, input.LineRadius);
  AddNumber(numbers, input.PointRadius);
  if (mapper->GetScalarVisibility())
  {
    // Also when there is no such array: that must be said.
    AddNumber(numbers, mapper->GetScalarMode());
    const char* name = mapper->GetArrayName();
    numbers.push_back(std::hash<std::string>{}(name ? name : ""));
  }
  for (const vtkDSMMeshBlock& block : input.CollectBlocks())
  {
    numbers.push_back(block.Number);
    AddNumber(numbers, block.Appearance.Visible);
    AddNumber(numbers, block.Appearance.Opacity);
    for (const float channel : block.Appearance.Color)
    {
      AddNumber(numbers, channel);
    }
    content.Blocks.push_back(DescribeBlock(input, block, identify));
    numbers.insert(numbers.end(), content.Blocks.back().begin(), content.Blocks.back().end());
  }
  return content;
}
