// SPDX-License-Identifier: BSD-3-Clause
// The cells of vtkPolyData as triangles.
#include "vtkDSMTriangleList.h"

#include "DSMCore/base/Error.h"
#include "tests/support/FixedSizeCells.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace
{

using Corners = std::array<std::uint64_t, 3>;

/// Points in the plane z = 0.
vtkSmartPointer<vtkPolyData> MakePoints(const std::vector<std::array<double, 2>>& places)
{
  vtkNew<vtkPoints> points;
  for (const auto& place : places)
  {
    points->InsertNextPoint(place[0], place[1], 0.0);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  return data;
}

std::vector<Corners> GetAll(const vtkDSMTriangleList& list)
{
  std::vector<Corners> all(list.GetCount());
  for (std::uint64_t triangle = 0; triangle < list.GetCount(); ++triangle)
  {
    list.GetTriangle(triangle, all[triangle].data());
  }
  return all;
}

/// Twice the signed area.
double GetArea(vtkPolyData* data, const Corners& corners)
{
  double p[3][3];
  for (int corner = 0; corner < 3; ++corner)
  {
    data->GetPoint(static_cast<vtkIdType>(corners[corner]), p[corner]);
  }
  return (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
}

} // namespace

TEST(TriangleList, TrianglesAreReadInPlaceFromBothStorages)
{
  for (const bool wide : { false, true })
  {
    const auto data = MakePoints({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
    vtkNew<vtkCellArray> vertices;
    vertices->InsertNextCell({ 2 });
    vtkNew<vtkCellArray> polygons;
    if (wide)
    {
      polygons->Use64BitStorage();
    }
    else
    {
      polygons->Use32BitStorage();
    }
    polygons->InsertNextCell({ 0, 1, 2 });
    polygons->InsertNextCell({ 0, 2, 3 });
    data->SetVerts(vertices);
    data->SetPolys(polygons);
    const vtkDSMTriangleList list(data);
    EXPECT_EQ(GetAll(list), (std::vector<Corners>{ { 0, 1, 2 }, { 0, 2, 3 } })) << wide;
    // The vertex is cell 0.
    EXPECT_EQ(list.GetCell(0), 1);
    EXPECT_EQ(list.GetCell(1), 2);
    EXPECT_EQ(vtkDSMTriangleList::GetLargestCount(data), 2u);
  }
}

TEST(TriangleList, TrianglesAreReadFromStorageWithoutOffsets)
{
  for (const bool wide : { false, true })
  {
    const auto data = MakePoints({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
    vtkNew<vtkCellArray> polygons;
    if (!FixedSizeCells::Use(polygons, 3, wide))
    {
      GTEST_SKIP() << "this VTK has no such storage";
    }
    polygons->InsertNextCell({ 0, 1, 2 });
    polygons->InsertNextCell({ 0, 2, 3 });
    data->SetPolys(polygons);
    const vtkDSMTriangleList list(data);
    EXPECT_EQ(GetAll(list), (std::vector<Corners>{ { 0, 1, 2 }, { 0, 2, 3 } })) << wide;
    EXPECT_EQ(list.GetCell(1), 1);
  }
}

TEST(TriangleList, QuadranglesAreReadFromStorageWithoutOffsets)
{
  for (const bool wide : { false, true })
  {
    const auto data = MakePoints({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
    vtkNew<vtkCellArray> polygons;
    if (!FixedSizeCells::Use(polygons, 4, wide))
    {
      GTEST_SKIP() << "this VTK has no such storage";
    }
    polygons->InsertNextCell({ 0, 1, 2, 3 });
    data->SetPolys(polygons);
    EXPECT_EQ(GetAll(vtkDSMTriangleList(data)), (std::vector<Corners>{ { 0, 1, 2 }, { 0, 2, 3 } }));
  }
}

TEST(TriangleList, ConvexPolygonsBecomeTheFanThatVtkDraws)
{
  const auto data = MakePoints({ { 0, 0 }, { 2, 0 }, { 3, 1 }, { 2, 2 }, { 0, 2 } });
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 2, 3, 4 });
  polygons->InsertNextCell({ 4, 3, 2, 1, 0 }); // from behind
  polygons->InsertNextCell({ 0, 1 });          // no polygon
  data->SetPolys(polygons);
  const vtkDSMTriangleList list(data);
  EXPECT_EQ(GetAll(list),
    (std::vector<Corners>{
      { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 4 }, { 4, 3, 2 }, { 4, 2, 1 }, { 4, 1, 0 } }));
  EXPECT_EQ(list.GetCell(2), 0);
  EXPECT_EQ(list.GetCell(3), 1);
}

TEST(TriangleList, ConcavePolygonsAreCoveredOnceAndNotBeyondTheirBorder)
{
  // An arrow head, whose area is 1.5, beginning at each of its corners in turn.
  const std::vector<std::array<double, 2>> arrow{ { 0, 0 }, { 2, 1.5 }, { 0, 3 }, { 1, 1.5 } };
  for (std::size_t first = 0; first < arrow.size(); ++first)
  {
    const auto data = MakePoints(arrow);
    vtkNew<vtkCellArray> polygons;
    polygons->InsertNextCell(4);
    for (std::size_t corner = 0; corner < arrow.size(); ++corner)
    {
      polygons->InsertCellPoint(static_cast<vtkIdType>((first + corner) % arrow.size()));
    }
    data->SetPolys(polygons);
    const vtkDSMTriangleList list(data);
    double sum = 0.0;
    for (const Corners& corners : GetAll(list))
    {
      EXPECT_GT(GetArea(data, corners), 0.0) << first;
      sum += 0.5 * GetArea(data, corners);
    }
    EXPECT_EQ(list.GetCount(), 2u) << first;
    EXPECT_DOUBLE_EQ(sum, 1.5) << first;
  }
}

TEST(TriangleList, StripsTurnAllTheSameWay)
{
  const auto data = MakePoints({ { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1, 1 }, { 0, 2 } });
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({ 0, 1, 2, 3, 4 });
  data->SetStrips(strips);
  const vtkDSMTriangleList list(data);
  ASSERT_EQ(list.GetCount(), 3u);
  for (const Corners& corners : GetAll(list))
  {
    EXPECT_DOUBLE_EQ(GetArea(data, corners), 1.0);
  }
  EXPECT_EQ(list.GetCell(2), 0);
}

TEST(TriangleList, SidesOfPolygonsAreEdgesAndCutsAreNot)
{
  const auto data = MakePoints({ { 0, 0 }, { 2, 0 }, { 3, 1 }, { 2, 2 }, { 0, 2 } });
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 2 });
  polygons->InsertNextCell({ 0, 1, 2, 3, 4 });
  polygons->InsertNextCell({ 4, 3, 1, 0 });
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({ 0, 1, 4, 3 });
  data->SetPolys(polygons);
  data->SetStrips(strips);
  const vtkDSMTriangleList list(data);
  ASSERT_EQ(list.GetCount(), 8u);
  const unsigned expected[8] = { 0b111, 0b011, 0b010, 0b110, 0b011, 0b110, 0b111, 0b111 };
  for (std::uint64_t triangle = 0; triangle < list.GetCount(); ++triangle)
  {
    EXPECT_EQ(list.GetEdgeFlags(triangle), expected[triangle]) << triangle;
  }
  EXPECT_TRUE(vtkDSMTriangleList::NeedsEdgeFlags(data));
}

TEST(TriangleList, EveryTriangleOfAConcavePolygonKnowsItsEdges)
{
  const auto data = MakePoints({ { 0, 0 }, { 2, 1.5 }, { 0, 3 }, { 1, 1.5 } });
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 2, 3 });
  data->SetPolys(polygons);
  const vtkDSMTriangleList list(data);
  ASSERT_EQ(list.GetCount(), 2u);
  for (std::uint64_t triangle = 0; triangle < 2; ++triangle)
  {
    Corners corners;
    list.GetTriangle(triangle, corners.data());
    for (int side = 0; side < 3; ++side)
    {
      const std::uint64_t way = (corners[(side + 1) % 3] + 4 - corners[side]) % 4;
      EXPECT_EQ(list.GetEdgeFlags(triangle) >> side & 1u, way == 2 ? 0u : 1u);
    }
  }
}

TEST(TriangleList, EdgeFlagsOfPointsAreThoseOfTheEdgesThatBeginThere)
{
  const auto data = MakePoints({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 2 });
  polygons->InsertNextCell({ 3, 0, 2 });
  data->SetPolys(polygons);
  EXPECT_FALSE(vtkDSMTriangleList::NeedsEdgeFlags(data));
  vtkNew<vtkUnsignedCharArray> flags;
  for (const int flag : { 1, 0, 1, 0 })
  {
    flags->InsertNextValue(static_cast<unsigned char>(flag));
  }
  data->GetPointData()->SetAttribute(flags, vtkDataSetAttributes::EDGEFLAG);
  EXPECT_TRUE(vtkDSMTriangleList::NeedsEdgeFlags(data));
  const vtkDSMTriangleList list(data);
  EXPECT_EQ(list.GetEdgeFlags(0), 0b101u);
  EXPECT_EQ(list.GetEdgeFlags(1), 0b110u);
}

TEST(TriangleList, GhostsAreLeftOut)
{
  const auto data = MakePoints({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 2 });
  polygons->InsertNextCell({ 0, 2, 3 });
  polygons->InsertNextCell({ 1, 2, 3 });
  data->SetPolys(polygons);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->InsertNextValue(vtkDataSetAttributes::DUPLICATECELL);
  ghosts->InsertNextValue(0);
  ghosts->InsertNextValue(vtkDataSetAttributes::HIDDENCELL);
  data->GetCellData()->AddArray(ghosts);
  const vtkDSMTriangleList list(data);
  EXPECT_EQ(GetAll(list), (std::vector<Corners>{ { 0, 2, 3 } }));
  EXPECT_EQ(list.GetCell(0), 1);
}

TEST(TriangleList, ACellWithAPointThatDoesNotExistIsNamed)
{
  const auto data = MakePoints({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 2 });
  polygons->InsertNextCell({ 0, 2, 3, 7 });
  data->SetPolys(polygons);
  try
  {
    const vtkDSMTriangleList list(data);
    FAIL();
  }
  catch (const dsm::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("Cell 1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("point 7"), std::string::npos) << error.what();
  }
}

TEST(TriangleList, NothingIsNothing)
{
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  EXPECT_EQ(vtkDSMTriangleList(data).GetCount(), 0u);
}
