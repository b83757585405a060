// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMAmrPart.h"

#include "DSMBricks/levels/LevelSource.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"

#include "vtkImageData.h"
#include "vtkStructuredData.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace
{

using bricks::Box;
using bricks::Index3;

/// OwnPieces of a cell by which a place may miss a cell's corner, and of a number by which it may miss a whole one.
constexpr double Tolerance = 1e-3;

bool AreSame(const double one[3], const double other[3])
{
  return std::equal(one, one + 3, other,
    [](double a, double b) { return std::abs(a - b) <= Tolerance * std::abs(a); });
}

glm::dmat3 GetDirection(const bricks::PieceInfo& piece)
{
  return glm::transpose(glm::dmat3(piece.Direction[0], piece.Direction[1], piece.Direction[2],
    piece.Direction[3], piece.Direction[4], piece.Direction[5], piece.Direction[6],
    piece.Direction[7], piece.Direction[8]));
}

bool IsEmpty(const bricks::PieceInfo& piece)
{
  return piece.Min[0] >= piece.Max[0] || piece.Min[1] >= piece.Max[1] ||
    piece.Min[2] >= piece.Max[2];
}

} // namespace

/// This rank's leaves, with the values of one array.
class vtkDSMAmrPart::Source final : public vtkDSMLevelSource
{
public:
  Source(const vtkDSMAmrPart& data, const Choice& choice)
    : Data(data)
    , OfPoints(!choice.OnCells)
    , Valid(choice.Valid)
  {
    for (std::size_t own = 0; own < data.Blocks.size(); ++own)
    {
      const auto number = static_cast<std::size_t>(data.FirstOwn) + own;
      const Place& place = data.Places[number];
      vtkDSMImageArrays::Info info;
      vtkDataArray* const array = vtkDSMImageArrays::Find(data.Blocks[own], choice, info);
      if (!array || place.Cells.IsEmpty())
      {
        continue;
      }
      const bricks::PieceInfo& piece = data.Pieces[number];
      const bricks::LatticePlan::Member member{ 0,
        place.Cells.Min - Index3(piece.Min[0], piece.Min[1], piece.Min[2]), place.Cells };
      this->Blocks.push_back({ own, place, data.FindLeaves(own), info.Type,
        std::make_unique<vtkDSMImagePiece>(
          data.Blocks[own], array, choice.Component, member, false, choice.OnCells) });
      this->AddCubes(this->Blocks.size() - 1);
    }
  }

  const std::vector<bricks::LevelCube>& GetCubes() const override { return this->Cubes.GetAll(); }
  bool IsOfPoints() const override { return this->OfPoints; }

  void ReadCube(std::size_t number, double* values, std::uint8_t* isLeaf) const override
  {
    const bricks::LevelCube& cube = this->Cubes.GetAll()[number];
    const Index3 size(bricks::LevelLattice::Edge);
    const Index3 first = Index3(cube.Place[0], cube.Place[1], cube.Place[2]) * size;
    std::fill_n(isLeaf, size.x * size.y * size.z, std::uint8_t{ 0 });
    for (const std::size_t index : this->BlocksOfCubes[number])
    {
      const Block& block = this->Blocks[index];
      const Box cells = bricks::Intersect(block.At.Cells, { first, first + size });
      const Index3 more(this->OfPoints ? 1 : 0);
      const Box samples{ cells.Min, cells.Max + more };
      std::vector<std::byte> bytes(
        static_cast<std::size_t>(samples.GetCount()) * bricks::GetBytes(block.Type));
      block.Piece->ReadSamples(samples, bytes.data());
      bricks::Dispatch(block.Type,
        [&](auto sample)
        {
          using T = decltype(sample);
          const auto* from = reinterpret_cast<const T*>(bytes.data());
          const bricks::MissingTest<T> isMissing(this->Valid);
          const Index3 row = samples.GetSize();
          const Index3 stride = size + more;
          // Only values of leaves: blocks may overlap.
          bricks::ForEachIndex(cells,
            [&](const Index3& cell)
            {
              if (!block.IsLeaf(cell))
              {
                return;
              }
              const Index3 at = cell - first;
              isLeaf[at.x + size.x * (at.y + size.y * at.z)] = 1;
              bricks::ForEachIndex({ cell, cell + more + Index3(1) },
                [&](const Index3& point)
                {
                  const Index3 to = point - first;
                  const Index3 in = point - samples.Min;
                  values[to.x + stride.x * (to.y + stride.y * to.z)] =
                    isMissing(from[in.x + row.x * (in.y + row.y * in.z)])
                    ? std::numeric_limits<double>::quiet_NaN()
                    : static_cast<double>(from[in.x + row.x * (in.y + row.y * in.z)]);
                });
            });
        });
    }
  }

  std::vector<Cell> ReadCells(std::size_t number) const override
  {
    const bricks::LevelCube& cube = this->Cubes.GetAll()[number];
    const Index3 size(bricks::LevelLattice::Edge);
    const Index3 first = bricks::LevelCubes::GetFirst(cube);
    std::vector<Cell> found(static_cast<std::size_t>(size.x * size.y * size.z));
    for (const std::size_t index : this->BlocksOfCubes[number])
    {
      const Block& block = this->Blocks[index];
      const bricks::PieceInfo& piece =
        this->Data.Pieces[static_cast<std::size_t>(this->Data.FirstOwn) + block.Own];
      const Index3 toOwn = Index3(piece.Min[0], piece.Min[1], piece.Min[2]) - block.At.Cells.Min;
      bricks::ForEachIndex(bricks::Intersect(block.At.Cells, { first, first + size }),
        [&](const Index3& cell)
        {
          if (block.IsLeaf(cell))
          {
            const Index3 at = cell - first;
            const glm::ivec3 own(cell + toOwn);
            found[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))] = {
              static_cast<int>(block.Own),
              vtkStructuredData::ComputeCellIdForExtent(
                this->Data.Blocks[block.Own]->GetExtent(), &own.x)
            };
          }
        });
    }
    return found;
  }

private:
  struct Block
  {
    std::size_t Own; ///< index into the rank's own
    Place At;
    std::vector<std::uint8_t> Leaves;
    bricks::ScalarType Type;
    std::unique_ptr<vtkDSMImagePiece> Piece;

    bool IsLeaf(const Index3& cell) const
    {
      const Index3 size = this->At.Cells.GetSize();
      const Index3 at = cell - this->At.Cells.Min;
      return this->Leaves[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))] != 0;
    }
  };

  void AddCubes(std::size_t index)
  {
    const Block& block = this->Blocks[index];
    const Index3 size(bricks::LevelLattice::Edge);
    const Box& cells = block.At.Cells;
    bricks::ForEachIndex({ cells.Min / size, (cells.Max + size - Index3(1)) / size },
      [&](const Index3& place)
      {
        const Index3 first = place * size;
        const std::size_t number = this->Cubes.Find(block.At.Level, first);
        this->BlocksOfCubes.resize(this->Cubes.GetAll().size());
        this->BlocksOfCubes[number].push_back(index);
        bricks::ForEachIndex(bricks::Intersect(cells, { first, first + size }),
          [&](const Index3& cell)
          {
            if (!block.IsLeaf(cell))
            {
              return;
            }
            this->Cubes.Count(number, cell);
          });
      });
  }

  const vtkDSMAmrPart& Data;
  bool OfPoints;
  bricks::ValidValues Valid;
  std::vector<Block> Blocks;
  bricks::LevelCubes Cubes;
  std::vector<std::vector<std::size_t>> BlocksOfCubes;
};

vtkDSMAmrPart::vtkDSMAmrPart(const std::shared_ptr<vtkDSMRankGroup>& group, const OwnPieces& pieces)
  : vtkDSMLevelPart(group, pieces)
{
  dsm::Messenger& messenger = this->Group->GetMessenger();
  std::vector<bricks::PieceInfo> mine;
  std::vector<vtkDSMBlockLook> looks;
  messenger.RunTogether("Reading the levels",
    [&]
    {
      for (const Piece& piece : pieces)
      {
        vtkImageData* const block = vtkImageData::SafeDownCast(piece.Data);
        this->Blocks.emplace_back(block);
        looks.push_back(piece.Look);
        mine.push_back(vtkDSMImagePiece::Describe(block, static_cast<int>(piece.Dataset)));
      }
    });
  this->Pieces = vtkDSMGather::Items(messenger, mine, this->FirstOwn);
  looks = vtkDSMGather::Items(messenger, looks);
  messenger.RunTogether("Joining the levels",
    [&]
    {
      this->FindLevels();
      this->FindPlaces();
      // All are the same.
      const glm::dvec3 end = glm::max(glm::ceil(this->Upper), glm::dvec3(0.0));
      this->BlockLooks.push_back({ { Index3(0), Index3(end) }, looks.front() });
    });
}

vtkDSMAmrPart::~vtkDSMAmrPart() = default;

void vtkDSMAmrPart::FindLevels()
{
  this->Order.resize(this->Pieces.size());
  std::iota(this->Order.begin(), this->Order.end(), std::size_t{ 0 });
  std::stable_sort(this->Order.begin(), this->Order.end(),
    [this](std::size_t a, std::size_t b) { return this->Pieces[a].Leaf < this->Pieces[b].Leaf; });
  std::vector<const double*> spacings;
  for (const std::size_t number : this->Order)
  {
    const bricks::PieceInfo& piece = this->Pieces[number];
    const bool isKnown = std::any_of(spacings.begin(), spacings.end(),
      [&](const double* one) { return AreSame(one, piece.Spacing); });
    if (!IsEmpty(piece) && !isKnown)
    {
      spacings.push_back(piece.Spacing);
    }
  }
  std::stable_sort(spacings.begin(), spacings.end(),
    [](const double* a, const double* b) { return a[0] * a[1] * a[2] > b[0] * b[1] * b[2]; });
  std::vector<Index3> scales;
  for (const double* spacing : spacings)
  {
    Index3 scale;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double exact = spacings.front()[axis] / spacing[axis];
      scale[axis] = std::llround(exact);
      const std::int64_t before = scales.empty() ? 1 : scales.back()[axis];
      if (!(std::abs(exact - static_cast<double>(scale[axis])) <= Tolerance * exact) ||
        scale[axis] < 1 || scale[axis] % before != 0)
      {
        throw dsm::Error("The cells of one level of the dataset are not a whole number of times "
                         "smaller than those of "
                         "another: on axis " +
          std::to_string(axis) + " they are " + std::to_string(exact) +
          " times smaller than the largest. Apply Resample To Image first.");
      }
    }
    scales.push_back(scale);
    this->Spacings.push_back({ spacing[0], spacing[1], spacing[2] });
  }
  this->Scales = bricks::LevelScales(std::move(scales));
}

void vtkDSMAmrPart::FindPlaces()
{
  this->Places.assign(this->Pieces.size(), { 0, {} });
  const auto found = std::find_if(this->Order.begin(), this->Order.end(),
    [this](std::size_t number)
    {
      const bricks::PieceInfo& piece = this->Pieces[number];
      return !IsEmpty(piece) && AreSame(piece.Spacing, this->Spacings.front().data());
    });
  if (found == this->Order.end())
  {
    return;
  }
  const bricks::PieceInfo& first = this->Pieces[*found];
  const glm::dmat3 direction = GetDirection(first);
  const glm::dmat3 inverse = glm::inverse(direction);
  const glm::dvec3 anchor(first.Origin[0], first.Origin[1], first.Origin[2]);
  Index3 least(std::numeric_limits<std::int64_t>::max());
  for (std::size_t number = 0; number < this->Pieces.size(); ++number)
  {
    const bricks::PieceInfo& piece = this->Pieces[number];
    if (IsEmpty(piece))
    {
      continue;
    }
    Place& place = this->Places[number];
    while (!AreSame(piece.Spacing, this->Spacings[static_cast<std::size_t>(place.Level)].data()))
    {
      ++place.Level;
    }
    const glm::dvec3 shift =
      inverse * (glm::dvec3(piece.Origin[0], piece.Origin[1], piece.Origin[2]) - anchor);
    const std::array<double, 3>& spacing = this->Spacings[static_cast<std::size_t>(place.Level)];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double exact = shift[axis] / spacing[static_cast<std::size_t>(axis)];
      const double begin = std::round(exact + static_cast<double>(piece.Min[axis]));
      const double error = std::abs(exact + static_cast<double>(piece.Min[axis]) - begin);
      if (!(error <= 0.05) || !(std::abs(begin) < 1e9) || GetDirection(piece) != direction)
      {
        throw dsm::Error("A block of the dataset is not on the lattice of its level: it misses the "
                         "corners of the cells by " +
          std::to_string(error) + " of a cell. Apply Resample To Image first.");
      }
      place.Cells.Min[axis] = static_cast<std::int64_t>(begin);
      place.Cells.Max[axis] = place.Cells.Min[axis] + piece.Max[axis] - piece.Min[axis];
    }
    least = glm::min(least, bricks::DivideDown(place.Cells.Min, this->Scales.Get(place.Level)));
  }
  for (Place& place : this->Places)
  {
    const Index3 shift = least * this->Scales.Get(place.Level);
    place.Cells.Min -= shift;
    place.Cells.Max -= shift;
    if (!place.Cells.IsEmpty())
    {
      const glm::dvec3 scale(this->Scales.Get(place.Level));
      this->Lower = glm::min(this->Lower, glm::dvec3(place.Cells.Min) / scale);
      this->Upper = glm::max(this->Upper, glm::dvec3(place.Cells.Max) / scale);
    }
    if (!place.Cells.IsEmpty() &&
      glm::any(glm::greaterThan(place.Cells.Max, Index3(std::numeric_limits<std::int32_t>::max()))))
    {
      throw dsm::Error("The finest level of the dataset would have more than 2147483647 cells on "
                       "an axis. Show fewer levels.");
    }
  }
  const std::array<double, 3>& spacing = this->Spacings.front();
  const glm::dvec3 edges(spacing[0], spacing[1], spacing[2]);
  this->SetPlace(anchor + direction * (glm::dvec3(least) * edges), direction, edges);
}

std::vector<std::uint8_t> vtkDSMAmrPart::FindLeaves(std::size_t own) const
{
  const auto number = static_cast<std::size_t>(this->FirstOwn) + own;
  const Place& place = this->Places[number];
  std::vector<std::uint8_t> leaves = vtkDSMImagePiece::FindShown(this->Blocks[own],
    { Index3(this->Pieces[number].Min[0], this->Pieces[number].Min[1], this->Pieces[number].Min[2]),
      Index3(
        this->Pieces[number].Max[0], this->Pieces[number].Max[1], this->Pieces[number].Max[2]) });
  const Index3 size = place.Cells.GetSize();
  bool isBefore = true; // the block in the order
  for (const std::size_t other : this->Order)
  {
    const Place& by = this->Places[other];
    isBefore = isBefore && other != number;
    const bool covers = by.Level > place.Level || (by.Level == place.Level && isBefore);
    if (!covers || by.Cells.IsEmpty())
    {
      continue;
    }
    const Index3 ratio = this->Scales.GetRatio(place.Level, by.Level);
    const Box covered{ bricks::DivideDown(by.Cells.Min, ratio),
      bricks::DivideUp(by.Cells.Max, ratio) };
    bricks::ForEachIndex(bricks::Intersect(place.Cells, covered),
      [&](const Index3& cell)
      {
        const Index3 at = cell - place.Cells.Min;
        leaves[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))] = 0;
      });
  }
  return leaves;
}

void vtkDSMAmrPart::AddPlaces(bricks::ByteHash& hash) const
{
  hash.Add(this->Pieces.data(), this->Pieces.size() * sizeof(bricks::PieceInfo));
}

std::unique_ptr<vtkDSMLevelSource> vtkDSMAmrPart::CreateSource(const Choice& choice) const
{
  return std::make_unique<Source>(*this, choice);
}
