// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/CellAverages.h"
#include "DSMRayTracing/look/PackedColor.h"
#include "vtkDSMCellPiece.h"
#include "vtkDSMImagePiece.h"

#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkCellDataToPointData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkUniformGrid.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace
{

/// 4 x 3 x 3 points from (-1, 2, 5) on; the value of a point is 100 i + 10 j + k.
constexpr int Extent[6] = { -1, 2, 2, 4, 5, 7 };

double GetValue(std::int64_t i, std::int64_t j, std::int64_t k)
{
  return 100.0 * static_cast<double>(i) + 10.0 * static_cast<double>(j) + static_cast<double>(k);
}

vtkSmartPointer<vtkImageData> MakeImage()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(const_cast<int*>(Extent));
  return image;
}

template <class Set>
void ForEachPoint(Set&& set)
{
  vtkIdType tuple = 0;
  for (int k = Extent[4]; k <= Extent[5]; ++k)
  {
    for (int j = Extent[2]; j <= Extent[3]; ++j)
    {
      for (int i = Extent[0]; i <= Extent[1]; ++i)
      {
        set(tuple++, GetValue(i, j, k));
      }
    }
  }
}

/// The lattice starts at the image's first point.
bricks::LatticePlan::Member MakePlace(const bricks::PieceInfo& info)
{
  const bricks::Index3 shift(1, -2, -5);
  return { 0, shift,
    { bricks::Index3(info.Min[0], info.Min[1], info.Min[2]) + shift,
      bricks::Index3(info.Max[0], info.Max[1], info.Max[2]) + shift } };
}

template <class T>
std::vector<T> Read(
  vtkImageData* image, vtkDataArray* array, int component, const bricks::Box& points)
{
  const vtkDSMImagePiece piece(
    image, array, component, MakePlace(vtkDSMImagePiece::Describe(image, 0)), false);
  std::vector<T> samples(static_cast<std::size_t>(points.GetCount()));
  piece.ReadSamples(points, reinterpret_cast<std::byte*>(samples.data()));
  return samples;
}

const bricks::Box Some{ { 1, 0, 1 }, { 3, 2, 3 } };

/// What Some holds, through `change`.
template <class T, class Change>
std::vector<T> GetExpected(Change&& change)
{
  std::vector<T> expected;
  for (std::int64_t k = Some.Min.z; k < Some.Max.z; ++k)
  {
    for (std::int64_t j = Some.Min.y; j < Some.Max.y; ++j)
    {
      for (std::int64_t i = Some.Min.x; i < Some.Max.x; ++i)
      {
        expected.push_back(static_cast<T>(change(GetValue(i - 1, j + 2, k + 5))));
      }
    }
  }
  return expected;
}

TEST(ImagePiece, ReadsOneComponentOfInterleavedTuples)
{
  const auto image = MakeImage();
  vtkNew<vtkFloatArray> array;
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(image->GetNumberOfPoints());
  ForEachPoint([&](vtkIdType tuple, double value) { array->SetTuple3(tuple, 0.0, value, -1.0); });
  EXPECT_EQ(Read<float>(image, array, 1, Some), GetExpected<float>([](double v) { return v; }));
}

TEST(ImagePiece, KeepsAll64BitsOfIntegersInEitherLayout)
{
  const auto image = MakeImage();
  // Neighbors in int64 that a double cannot tell apart.
  const auto widen = [](double value)
  { return (std::int64_t(1) << 60) + static_cast<std::int64_t>(value); };
  const auto expected = GetExpected<std::int64_t>(widen);
  vtkSmartPointer<vtkDataArray> interleaved;
  interleaved.TakeReference(vtkDataArray::CreateDataArray(VTK_LONG_LONG));
  interleaved->SetNumberOfTuples(image->GetNumberOfPoints());
  auto* values = static_cast<long long*>(interleaved->GetVoidPointer(0));
  vtkNew<vtkSOADataArrayTemplate<long long>> separate;
  separate->SetNumberOfComponents(2);
  separate->SetNumberOfTuples(image->GetNumberOfPoints());
  ForEachPoint(
    [&](vtkIdType tuple, double value)
    {
      values[tuple] = widen(value);
      separate->SetTypedComponent(tuple, 0, 0);
      separate->SetTypedComponent(tuple, 1, widen(value));
    });
  EXPECT_EQ(vtkDSMImagePiece::GetScalarType(interleaved, 0), bricks::ScalarType::Int64);
  EXPECT_EQ(Read<std::int64_t>(image, interleaved, 0, Some), expected);
  EXPECT_EQ(Read<std::int64_t>(image, separate, 1, Some), expected);
}

TEST(ImagePiece, ReadsBits)
{
  const auto image = MakeImage();
  vtkNew<vtkBitArray> array;
  array->SetNumberOfTuples(image->GetNumberOfPoints());
  const auto toBit = [](double value) { return std::fmod(value, 2.0) != 0.0 ? 1 : 0; };
  ForEachPoint([&](vtkIdType tuple, double value) { array->SetValue(tuple, toBit(value)); });
  EXPECT_EQ(vtkDSMImagePiece::GetScalarType(array, 0), bricks::ScalarType::UInt8);
  EXPECT_EQ(Read<std::uint8_t>(image, array, 0, Some), GetExpected<std::uint8_t>(toBit));
}

TEST(ImagePiece, ComputesTheMagnitude)
{
  const auto image = MakeImage();
  vtkNew<vtkFloatArray> array;
  array->SetNumberOfComponents(2);
  array->SetNumberOfTuples(image->GetNumberOfPoints());
  ForEachPoint(
    [&](vtkIdType tuple, double value) { array->SetTuple2(tuple, 3.0 * value, 4.0 * value); });
  EXPECT_EQ(Read<float>(image, array, vtkDSMImagePiece::Magnitude, Some),
    GetExpected<float>([](double v) { return 5.0 * std::abs(v); }));
}

TEST(ImagePiece, TypesKeepSizeAndSign)
{
  const std::vector<std::pair<int, bricks::ScalarType>> types = { { VTK_SIGNED_CHAR,
                                                                    bricks::ScalarType::Int8 },
    { VTK_UNSIGNED_CHAR, bricks::ScalarType::UInt8 }, { VTK_SHORT, bricks::ScalarType::Int16 },
    { VTK_UNSIGNED_SHORT, bricks::ScalarType::UInt16 }, { VTK_INT, bricks::ScalarType::Int32 },
    { VTK_UNSIGNED_INT, bricks::ScalarType::UInt32 }, { VTK_LONG_LONG, bricks::ScalarType::Int64 },
    { VTK_UNSIGNED_LONG_LONG, bricks::ScalarType::UInt64 },
    { VTK_FLOAT, bricks::ScalarType::Float32 }, { VTK_DOUBLE, bricks::ScalarType::Float64 } };
  for (const auto& [number, type] : types)
  {
    vtkSmartPointer<vtkDataArray> array;
    array.TakeReference(vtkDataArray::CreateDataArray(number));
    EXPECT_EQ(vtkDSMImagePiece::GetScalarType(array, 0), type) << array->GetClassName();
  }
}

/// VTK's own conversion takes numbers modulo 256.
TEST(ImagePiece, ColorsDoNotWrapAround)
{
  const auto read = [](int type, const std::vector<double>& values)
  {
    const auto image = MakeImage();
    vtkSmartPointer<vtkDataArray> array;
    array.TakeReference(vtkDataArray::CreateDataArray(type));
    array->SetNumberOfComponents(4);
    array->SetNumberOfTuples(image->GetNumberOfPoints());
    for (vtkIdType tuple = 0; tuple < array->GetNumberOfTuples(); ++tuple)
    {
      array->SetTuple(tuple, values.data());
    }
    const glm::vec4 color =
      rt::PackedColor::Get(Read<std::uint32_t>(image, array, vtkDSMImagePiece::Color, Some)[0]);
    return std::vector<int>{ static_cast<int>(color.x * 255.0f + 0.5f),
      static_cast<int>(color.y * 255.0f + 0.5f), static_cast<int>(color.z * 255.0f + 0.5f),
      static_cast<int>(color.w * 255.0f + 0.5f) };
  };
  EXPECT_EQ(read(VTK_UNSIGNED_CHAR, { 0, 7, 254, 255 }), (std::vector<int>{ 0, 7, 254, 255 }));
  EXPECT_EQ(
    read(VTK_UNSIGNED_SHORT, { 0, 255, 32896, 65535 }), (std::vector<int>{ 0, 1, 128, 255 }));
  EXPECT_EQ(read(VTK_INT, { -5, 130, 255, 1000 }), (std::vector<int>{ 0, 130, 255, 255 }));
  EXPECT_EQ(read(VTK_CHAR, { -5, 1, 100, 127 }), (std::vector<int>{ 0, 1, 100, 127 }));
  EXPECT_EQ(read(VTK_FLOAT, { -0.5, 0.5, 1.0, 1.5 }), (std::vector<int>{ 0, 128, 255, 255 }));
  EXPECT_EQ(
    read(VTK_DOUBLE, { NAN, 1e300, -INFINITY, INFINITY }), (std::vector<int>{ 0, 255, 0, 255 }));
}

TEST(ImagePiece, DuplicateCellsAreTrimmedAndHiddenPointsMasked)
{
  const auto image = MakeImage();
  vtkNew<vtkUnsignedCharArray> cells;
  cells->SetName(vtkDataSetAttributes::GhostArrayName());
  cells->SetNumberOfTuples(image->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
  {
    // The first of three cells along x belongs to another piece.
    cells->SetValue(cell, cell % 3 == 0 ? vtkDataSetAttributes::DUPLICATECELL : 0);
  }
  image->GetCellData()->AddArray(cells);
  bricks::PieceInfo info = vtkDSMImagePiece::Describe(image, 7);
  EXPECT_EQ(info.Leaf, 7);
  EXPECT_EQ(info.Min[0], 0);
  EXPECT_EQ(info.Max[0], 2);
  EXPECT_EQ(info.Min[1], 2);
  EXPECT_EQ(info.HasMask, 0);

  vtkNew<vtkUnsignedCharArray> points;
  points->SetName(vtkDataSetAttributes::GhostArrayName());
  points->SetNumberOfTuples(image->GetNumberOfPoints());
  points->FillValue(0);
  points->SetValue(image->GetNumberOfPoints() - 1, vtkDataSetAttributes::HIDDENPOINT);
  image->GetPointData()->AddArray(points);
  info = vtkDSMImagePiece::Describe(image, 0);
  EXPECT_EQ(info.Max[0], 2);
  EXPECT_EQ(info.HasMask, 1);

  const vtkDSMImagePiece piece(image, points, 0, MakePlace(info), true);
  std::vector<std::uint8_t> mask(2 * 2 * 2);
  piece.ReadCellMask(piece.GetCells(), mask.data());
  EXPECT_EQ(mask, (std::vector<std::uint8_t>{ 1, 1, 1, 1, 1, 1, 1, 0 }));
}

/// Values of all points of a grid, from a cell array.
std::vector<double> Average(vtkImageData* image, vtkDataArray* array, int component)
{
  const bricks::PieceInfo info = vtkDSMImagePiece::Describe(image, 0);
  const bricks::LatticePlan::Member place = MakePlace(info);
  const bricks::CellAverages averages(
    std::make_shared<vtkDSMCellPiece>(image, array, component, place, info.HasMask != 0));
  const bricks::Box points{ place.Cells.Min, place.Cells.Max + bricks::Index3(1) };
  const bricks::ScalarType type = vtkDSMImagePiece::GetScalarType(array, component);
  std::vector<std::byte> samples(
    static_cast<std::size_t>(points.GetCount()) * bricks::GetBytes(type));
  averages.ReadSamples(points, samples.data());
  return bricks::Dispatch(type,
    [&](auto sample)
    {
      const auto* values = reinterpret_cast<const decltype(sample)*>(samples.data());
      return std::vector<double>(values, values + points.GetCount());
    });
}

TEST(CellPiece, AveragesAreThoseOfCellDataToPointData)
{
  for (const bool isBlanked : { false, true })
  {
    for (const int type : { VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_INT,
           VTK_LONG_LONG, VTK_FLOAT, VTK_DOUBLE })
    {
      vtkNew<vtkUniformGrid> grid;
      grid->SetExtent(const_cast<int*>(Extent));
      vtkSmartPointer<vtkDataArray> array;
      array.TakeReference(vtkDataArray::CreateDataArray(type));
      array->SetName("values");
      array->SetNumberOfComponents(3);
      array->SetNumberOfTuples(grid->GetNumberOfCells());
      for (vtkIdType value = 0; value < 3 * grid->GetNumberOfCells(); ++value)
      {
        array->SetComponent(value / 3, value % 3, (value * 37 + value / 5) % 99 / 0.7 - 30.0);
      }
      grid->GetCellData()->AddArray(array);
      if (isBlanked)
      {
        grid->BlankCell(0, 1, 1);
        grid->BlankCell(1, 0, 0);
        grid->BlankPoint(3, 2, 2);
      }
      vtkNew<vtkUniformGrid> copy; // the filter takes the blanked points out of its input
      copy->DeepCopy(grid);
      vtkNew<vtkCellDataToPointData> filter;
      filter->SetInputData(copy);
      filter->Update();
      vtkDataArray* expected =
        vtkDataSet::SafeDownCast(filter->GetOutput())->GetPointData()->GetArray("values");
      ASSERT_EQ(expected->GetDataType(), type);
      for (int component = vtkDSMImagePiece::Magnitude; component < 3; ++component)
      {
        const std::vector<double> averages = Average(grid, array, component);
        for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
        {
          const double* const tuple = expected->GetTuple(point);
          const double length =
            std::sqrt(tuple[0] * tuple[0] + tuple[1] * tuple[1] + tuple[2] * tuple[2]);
          const bool isDouble =
            vtkDSMImagePiece::GetScalarType(array, component) == bricks::ScalarType::Float64;
          EXPECT_EQ(averages[static_cast<std::size_t>(point)],
            component >= 0 ? tuple[component]
              : isDouble   ? length
                           : static_cast<float>(length))
            << expected->GetClassName() << " component " << component << " point " << point;
        }
      }
    }
  }
}

} // namespace
