// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/LatticePlan.h"
#include "DSMCore/base/Error.h"

#include <gtest/gtest.h>

#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

namespace
{

using CellExtent = std::array<std::int64_t, 6>;

bricks::PieceInfo MakePiece(const CellExtent& cells, int leaf = 0)
{
  bricks::PieceInfo piece{};
  for (int axis = 0; axis < 3; ++axis)
  {
    piece.Spacing[axis] = 1.0 + axis;
    piece.Direction[4 * axis] = 1.0;
    piece.Min[axis] = cells[2 * axis];
    piece.Max[axis] = cells[2 * axis + 1];
  }
  piece.Leaf = leaf;
  return piece;
}

bricks::Box MakeBox(const CellExtent& cells)
{
  return { { cells[0], cells[2], cells[4] }, { cells[1], cells[3], cells[5] } };
}

glm::dvec3 GetCorner(const bricks::LatticePlan::Lattice& lattice)
{
  return glm::dvec3(lattice.IndexToWorld * glm::dvec4(0.0, 0.0, 0.0, 1.0));
}

TEST(LatticePlan, PiecesOfOneImageMakeOneLatticeThatStartsAtItsFirstPoint)
{
  const bricks::LatticePlan plan({ MakePiece({ -5, 3, 2, 8, 10, 14 }),
    MakePiece({ 3, 9, 2, 8, 10, 14 }), MakePiece({ -5, 9, 8, 9, 10, 14 }) });
  ASSERT_EQ(plan.GetLattices().size(), 1u);
  const auto& lattice = plan.GetLattices()[0];
  EXPECT_EQ(lattice.Points, bricks::Index3(15, 8, 5));
  EXPECT_EQ(GetCorner(lattice), glm::dvec3(-5.0, 4.0, 30.0));
  ASSERT_EQ(lattice.Members.size(), 3u);
  EXPECT_EQ(lattice.Members[1].Piece, 1);
  EXPECT_EQ(lattice.Members[1].Cells.Min, bricks::Index3(8, 0, 0));
  EXPECT_EQ(lattice.Members[1].IndexToLattice, bricks::Index3(5, -2, -10));
}

TEST(LatticePlan, ShiftedOriginsAreAligned)
{
  bricks::PieceInfo second = MakePiece({ 0, 4, 0, 4, 0, 4 }, 1);
  second.Origin[0] = 4.00001;
  const bricks::LatticePlan plan({ MakePiece({ 0, 4, 0, 4, 0, 4 }), second });
  ASSERT_EQ(plan.GetLattices().size(), 1u);
  EXPECT_EQ(plan.GetLattices()[0].Points, bricks::Index3(9, 5, 5));
  EXPECT_EQ(plan.GetLattices()[0].Members[1].IndexToLattice, bricks::Index3(4, 0, 0));
}

TEST(LatticePlan, ALaterPieceJoinsTwoGroups)
{
  const bricks::LatticePlan plan({ MakePiece({ 0, 4, 0, 4, 0, 4 }),
    MakePiece({ 8, 12, 0, 4, 0, 4 }), MakePiece({ 4, 8, 0, 4, 0, 4 }) });
  ASSERT_EQ(plan.GetLattices().size(), 1u);
  EXPECT_EQ(plan.GetLattices()[0].Points, bricks::Index3(13, 5, 5));
}

TEST(LatticePlan, WhatDoesNotFitStaysApart)
{
  bricks::PieceInfo offGrid = MakePiece({ 4, 8, 0, 4, 0, 4 });
  offGrid.Origin[1] = 0.5;
  bricks::PieceInfo coarse = MakePiece({ 4, 8, 0, 4, 0, 4 });
  coarse.Spacing[2] = 6.0;
  bricks::PieceInfo turned = MakePiece({ 4, 8, 0, 4, 0, 4 });
  turned.Direction[0] = turned.Direction[4] = 0.0;
  turned.Direction[1] = -1.0;
  turned.Direction[3] = 1.0;
  const bricks::PieceInfo distant = MakePiece({ 100, 104, 0, 4, 0, 4 });
  const bricks::LatticePlan plan(
    { MakePiece({ 0, 4, 0, 4, 0, 4 }), offGrid, coarse, turned, distant });
  EXPECT_EQ(plan.GetLattices().size(), 5u);
}

TEST(LatticePlan, OverlappingBlocksAreDifferentVolumesButCopiesOfOneImageAreNot)
{
  const CellExtent cells = { 0, 4, 0, 4, 0, 4 };
  const CellExtent shifted = { 2, 6, 0, 4, 0, 4 };
  EXPECT_EQ(
    bricks::LatticePlan({ MakePiece(cells, 1), MakePiece(shifted, 2) }).GetLattices().size(), 2u);
  EXPECT_EQ(
    bricks::LatticePlan({ MakePiece(cells, 1), MakePiece(shifted, 1) }).GetLattices().size(), 1u);
}

/// Rectilinear pieces and the coordinates of their points.
struct Grids
{
  std::vector<bricks::PieceInfo> Pieces;
  std::vector<bricks::GridPlanes::Coordinates> Coordinates;

  /// The part of all planes from `first` to `last`, whose own indices begin at `index`.
  void Add(const std::vector<double>& planes, std::int64_t first, std::int64_t last,
    std::int64_t index, int leaf)
  {
    bricks::PieceInfo piece = MakePiece({ index, index + last - first, 0, 2, 5, 7 }, leaf);
    piece.Coordinates = 1;
    this->Pieces.push_back(piece);
    this->Coordinates.push_back(
      { std::vector<double>(planes.begin() + first, planes.begin() + last + 1), { 1.0, 2.5, 3.0 },
        { 9.0, 8.0, 4.0 } });
  }
  bricks::LatticePlan Plan() const
  {
    return bricks::LatticePlan(this->Pieces, {}, this->Coordinates);
  }
};

TEST(LatticePlan, RectilinearPiecesContinueOneAnotherByTheirCoordinates)
{
  const std::vector<double> planes = { -3.0, -1.0, 0.5, 0.6, 4.0, 20.0, 21.0 };
  Grids grids;
  grids.Add(planes, 0, 2, 0, 1);
  grids.Add(planes, 4, 6, 7, 2); // touches nothing before the next one
  grids.Add(planes, 2, 4, 0, 3);
  const bricks::LatticePlan plan = grids.Plan();
  ASSERT_EQ(plan.GetLattices().size(), 1u);
  const auto& lattice = plan.GetLattices()[0];
  EXPECT_EQ(lattice.Points, bricks::Index3(7, 3, 3));
  ASSERT_TRUE(lattice.Planes);
  EXPECT_EQ(GetCorner(lattice), glm::dvec3(-3.0, 1.0, 9.0));
  for (int plane = 0; plane < 7; ++plane)
  {
    const glm::dvec4 place(lattice.Planes->GetPlace(0, plane), 0.0, 0.0, 1.0);
    EXPECT_NEAR((lattice.IndexToWorld * place).x, planes[plane], 1e-13);
  }
  // Coordinates that fall.
  EXPECT_EQ((lattice.IndexToWorld * glm::dvec4(0, 0, lattice.Planes->GetPlace(2, 1), 1)).z, 8.0);
  for (const auto& member : lattice.Members)
  {
    const std::int64_t first[3] = { 0, 4, 2 };
    EXPECT_EQ(member.Cells.Min, bricks::Index3(first[member.Piece], 0, 0));
    EXPECT_EQ(member.IndexToLattice.x, first[member.Piece] - grids.Pieces[member.Piece].Min[0]);
    EXPECT_EQ(member.IndexToLattice.z, -5);
  }
}

TEST(LatticePlan, RectilinearPiecesOfOtherPlanesStayApart)
{
  const std::vector<double> planes = { -3.0, -1.0, 0.5, 0.6, 4.0 };
  Grids grids;
  grids.Add(planes, 0, 2, 0, 1);
  grids.Add({ 0.5, 0.6, 4.0 }, 0, 2, 0, 2); // continues it
  grids.Add({ -1.0, 0.4, 4.0 }, 0, 2, 0, 3);
  grids.Add({ 4.0, 5.0, 6.0 }, 0, 2, 0, 4);
  grids.Coordinates.back()[1][1] = 2.4;
  grids.Pieces.push_back(MakePiece({ 0, 4, 0, 4, 0, 4 }, 5)); // image data
  grids.Coordinates.emplace_back();
  EXPECT_EQ(grids.Plan().GetLattices().size(), 4u);
  grids.Coordinates.front()[2][1] = 9.0;
  EXPECT_THROW(grids.Plan(), dsm::Error);
}

TEST(LatticePlan, RectilinearPiecesMeetWherePlanesDifferByLittle)
{
  // As CTH writes them: multiples in single precision.
  Grids grids;
  grids.Add({ 0.0909091, 0.09090924, 0.0909094 }, 0, 2, 0, 2);
  grids.Add({ 0.0, 0.04545455, 0.09090909 }, 0, 2, 0, 1);
  EXPECT_EQ(grids.Plan().GetLattices().size(), 2u); // that is a tenth of the small cell

  grids = {};
  grids.Add({ 0.09090924, 0.13636364, 0.18181818 }, 0, 2, 0, 2);
  grids.Add({ 0.0, 0.04545455, 0.09090909 }, 0, 2, 0, 1);
  for (const bool isReversed : { false, true })
  {
    const bricks::LatticePlan plan = grids.Plan();
    ASSERT_EQ(plan.GetLattices().size(), 1u) << isReversed;
    const auto& lattice = plan.GetLattices()[0];
    EXPECT_EQ(lattice.Points, bricks::Index3(5, 3, 3));
    // The block of the lower number counts, whatever the order of the pieces.
    const glm::dvec4 place(lattice.Planes->GetPlace(0, 2), 0.0, 0.0, 1.0);
    EXPECT_NEAR((lattice.IndexToWorld * place).x, 0.09090909, 1e-12);
    std::reverse(grids.Pieces.begin(), grids.Pieces.end());
    std::reverse(grids.Coordinates.begin(), grids.Coordinates.end());
  }
}

TEST(LatticePlan, FlatDataAreRefusedByAxis)
{
  try
  {
    bricks::LatticePlan({ MakePiece({ 0, 4, 3, 3, 0, 4 }) });
    FAIL() << "an image without cells was accepted";
  }
  catch (const dsm::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("no cells along y"), std::string::npos)
      << error.what();
  }
  const std::vector<bricks::PieceInfo> none;
  EXPECT_TRUE(bricks::LatticePlan(none).GetLattices().empty());
}

TEST(LatticePlan, SamplesThatAreNowhereAreRefused)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const auto refuse = [](auto change, const std::string& words)
  {
    bricks::PieceInfo piece = MakePiece({ 0, 4, 0, 4, 0, 4 }, 1);
    change(piece);
    std::string said;
    try
    {
      bricks::LatticePlan({ MakePiece({ 8, 12, 0, 4, 0, 4 }), piece });
    }
    catch (const dsm::Error& error)
    {
      said = error.what();
    }
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  refuse([](auto& piece) { piece.Spacing[1] = 0.0; }, "spacing along y is 0");
  refuse([=](auto& piece) { piece.Spacing[0] = nan; }, "spacing along x is not a number");
  refuse([=](auto& piece) { piece.Origin[2] = -infinite; }, "origin along z is infinite");
  refuse([=](auto& piece) { piece.Direction[5] = nan; }, "direction matrix is not a number");
  bricks::PieceInfo flat = MakePiece({ 0, 4, 3, 3, 0, 4 });
  flat.Spacing[1] = 0.0;
  EXPECT_EQ(bricks::LatticePlan({ flat, MakePiece({ 0, 4, 0, 4, 0, 4 }) }).GetLattices().size(), 1u)
    << "what is left out may be anywhere";
}

TEST(LatticePlan, FlatPiecesAmongVolumesAreLeftOut)
{
  const bricks::LatticePlan plan(
    { MakePiece({ 0, 4, 3, 3, 0, 4 }), MakePiece({ 0, 4, 0, 4, 0, 4 }) });
  ASSERT_EQ(plan.GetLattices().size(), 1u);
  EXPECT_EQ(plan.GetLattices()[0].Members.front().Piece, 1);
}

TEST(LatticePlan, CoverageFindsOneMissingCell)
{
  const bricks::Box whole = MakeBox({ 0, 4, 0, 4, 0, 4 });
  const bricks::Box left = MakeBox({ 0, 2, 0, 4, 0, 4 });
  const bricks::Box right = MakeBox({ 1, 4, 0, 4, 0, 4 });
  EXPECT_TRUE(bricks::LatticePlan::IsCovered(whole, { left, right }));
  EXPECT_FALSE(bricks::LatticePlan::IsCovered(whole, { left }));
  const bricks::Box allButOneLayer = MakeBox({ 1, 4, 0, 4, 0, 3 });
  const bricks::Box allButOneCell = MakeBox({ 2, 4, 0, 4, 3, 4 });
  const bricks::Box lastRow = MakeBox({ 0, 2, 0, 3, 3, 4 });
  EXPECT_FALSE(bricks::LatticePlan::IsCovered(
    whole, { MakeBox({ 0, 1, 0, 4, 0, 3 }), allButOneLayer, allButOneCell, lastRow }));
  EXPECT_TRUE(bricks::LatticePlan::IsCovered(whole,
    { MakeBox({ 0, 1, 0, 4, 0, 3 }), allButOneLayer, allButOneCell, lastRow,
      MakeBox({ 0, 2, 3, 4, 3, 4 }) }));
}

TEST(LatticePlan, SeamsAreWherePiecesOfTwoBlocksTouch)
{
  const std::vector<bricks::PieceInfo> pieces = { MakePiece({ 0, 4, 0, 4, 0, 4 }, 1),
    MakePiece({ 4, 8, 0, 4, 0, 4 }, 1), MakePiece({ 8, 12, 0, 4, 2, 4 }, 2),
    MakePiece({ 30, 32, 0, 4, 0, 4 }, 3) };
  const bricks::LatticePlan plan(pieces);
  ASSERT_EQ(plan.GetLattices().size(), 2u);
  const std::vector<bricks::LatticePlan::Seam> seams = plan.FindSeams(pieces);
  ASSERT_EQ(seams.size(), 1u);
  EXPECT_EQ(seams[0].Points.Min, bricks::Index3(8, 0, 2));
  EXPECT_EQ(seams[0].Points.Max, bricks::Index3(9, 5, 5));
  const auto& members = plan.GetLattices()[seams[0].Lattice].Members;
  EXPECT_EQ(members[seams[0].Members[0]].Piece + members[seams[0].Members[1]].Piece, 1 + 2);
}

TEST(LatticePlan, BlocksThatAreToStayApartDo)
{
  const std::vector<bricks::PieceInfo> pieces = { MakePiece({ 0, 4, 0, 4, 0, 4 }, 1),
    MakePiece({ 4, 8, 0, 4, 0, 4 }, 2), MakePiece({ 0, 4, 4, 8, 0, 4 }, 1),
    MakePiece({ 4, 8, 4, 8, 0, 4 }, 3) };
  EXPECT_EQ(bricks::LatticePlan(pieces).GetLattices().size(), 1u);
  const bricks::LatticePlan plan(pieces, { 2 });
  ASSERT_EQ(plan.GetLattices().size(), 2u);
  EXPECT_EQ(plan.GetLattices()[0].Members.size() + plan.GetLattices()[1].Members.size(), 4u);
  EXPECT_EQ(bricks::LatticePlan(pieces, { 1, 2, 3 }).GetLattices().size(), 3u);
}

} // namespace
