// SPDX-License-Identifier: BSD-3-Clause
// Whether arrays are told to hold what they held.
#include "vtkDSMContent.h"

#include "tests/support/FixedSizeCells.h"

#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkStringArray.h"

#include <gtest/gtest.h>

#include <array>

namespace
{

template <class Array>
vtkSmartPointer<Array> MakePairs(int tuples)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(2);
  array->SetNumberOfTuples(tuples);
  for (int tuple = 0; tuple < tuples; ++tuple)
  {
    array->SetComponent(tuple, 0, tuple);
    array->SetComponent(tuple, 1, 0.5 * tuple);
  }
  return array;
}

/// False where VTK has no such cells.
bool FillTriangles(vtkCellArray* cells, int count)
{
  if (!FixedSizeCells::Use(cells, 3, true))
  {
    return false;
  }
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    cells->InsertNextCell({ cell, cell + 1, cell + 2 });
  }
  return true;
}

} // namespace

TEST(Content, ArraysAreAlikeWhoseValuesAreAlike)
{
  const auto array = MakePairs<vtkFloatArray>(100);
  const auto same = MakePairs<vtkFloatArray>(100);
  const std::uint64_t hash = vtkDSMContent::Hash(array, 2);
  EXPECT_EQ(vtkDSMContent::Hash(same, 1), hash);
  same->SetComponent(99, 1, -1.0);
  EXPECT_NE(vtkDSMContent::Hash(same, 1), hash);
  EXPECT_NE(vtkDSMContent::Hash(MakePairs<vtkFloatArray>(99), 1), hash);
}

TEST(Content, ComponentsMayLieApart)
{
  std::array<float, 100> first{};
  std::array<float, 100> second{};
  vtkNew<vtkSOADataArrayTemplate<float>> array;
  array->SetNumberOfComponents(2);
  array->SetArray(0, first.data(), 100, true, true);
  array->SetArray(1, second.data(), 100, true, true);
  const std::uint64_t hash = vtkDSMContent::Hash(array, 2);
  EXPECT_EQ(vtkDSMContent::Hash(array, 1), hash);
  second[99] = -1.0f;
  EXPECT_NE(vtkDSMContent::Hash(array, 1), hash);
}

TEST(Content, ComponentsOfArraysForApartOnesMayLieTogether)
{
  const auto array = MakePairs<vtkSOADataArrayTemplate<float>>(100);
  const std::uint64_t hash = vtkDSMContent::Hash(array, 2);
  EXPECT_EQ(vtkDSMContent::Hash(array, 1), hash);
  array->SetComponent(99, 1, -1.0);
  EXPECT_NE(vtkDSMContent::Hash(array, 1), hash);
}

TEST(Content, WhatIsNoNumberIsUnlikeItself)
{
  vtkNew<vtkStringArray> array;
  array->InsertNextValue("one");
  EXPECT_NE(vtkDSMContent::Hash(array, 1), vtkDSMContent::Hash(array, 1));
}

TEST(Content, OffsetsThatAreStoredNowhereAreAlikeToo)
{
  vtkNew<vtkCellArray> cells;
  if (!FillTriangles(cells, 100))
  {
    GTEST_SKIP() << "this VTK has no such storage";
  }
  vtkNew<vtkCellArray> same;
  FillTriangles(same, 100);
  vtkNew<vtkCellArray> fewer;
  FillTriangles(fewer, 99);
  const std::uint64_t hash = vtkDSMContent::Hash(cells->GetOffsetsArray(), 2);
  EXPECT_EQ(vtkDSMContent::Hash(cells->GetOffsetsArray(), 1), hash);
  EXPECT_EQ(vtkDSMContent::Hash(same->GetOffsetsArray(), 1), hash);
  EXPECT_NE(vtkDSMContent::Hash(fewer->GetOffsetsArray(), 1), hash);
}
