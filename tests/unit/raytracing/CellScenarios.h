// SPDX-License-Identifier: BSD-3-Clause
#ifndef CellScenarios_h
#define CellScenarios_h

#include "DSMBricks/build/CellExchange.h"
#include "RandomCuts.h"
#include "TestVolume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <vector>

/// Volumes whose cells have values, in pieces on several ranks; each scenario runs on all of them.
namespace dsm_test
{

constexpr std::size_t CellComponents = 2;

/// Cells that every rank can compute; `NoData` and `Own` of all of them.
template <class T>
struct CellVolume
{
  CellVolume(const bricks::Index3& cells, int hidden, std::mt19937& random)
    : Cells{ bricks::Index3(0), cells }
  {
    for (std::int64_t cell = 0; cell < this->Cells.GetCount(); ++cell)
    {
      for (std::vector<T>& values : this->Values)
      {
        values.push_back(static_cast<T>(static_cast<int>(random() % 200) - 100) / T(3));
      }
      this->States.push_back(bricks::CellReader::Own);
    }
    for (int cell = 0; cell < hidden; ++cell)
    {
      this->States[random() % this->States.size()] = bricks::CellReader::NoData;
    }
  }
  std::size_t GetId(const bricks::Index3& cell) const
  {
    const bricks::Index3 size = this->Cells.GetSize();
    return static_cast<std::size_t>(cell.x + size.x * (cell.y + size.y * cell.z));
  }
  /// By the definition, one point at a time.
  T GetAverage(std::size_t component, const bricks::Index3& point, const bricks::Box& missing) const
  {
    const bricks::Index3 order[8] = { { -1, 0, 0 }, { -1, -1, 0 }, { -1, -1, -1 }, { -1, 0, -1 },
      { 0, 0, 0 }, { 0, -1, 0 }, { 0, -1, -1 }, { 0, 0, -1 } };
    std::vector<double> around;
    for (const bricks::Index3& step : order)
    {
      const bricks::Box cell{ point + step, point + step + bricks::Index3(1) };
      if (!Intersect(cell, this->Cells).IsEmpty() && Intersect(cell, missing).IsEmpty() &&
        this->States[this->GetId(cell.Min)] != bricks::CellReader::NoData)
      {
        around.push_back(static_cast<double>(this->Values[component][this->GetId(cell.Min)]));
      }
    }
    double sum = 0.0;
    for (const double value : around)
    {
      sum += 1.0 / static_cast<double>(around.size()) * value;
    }
    return std::is_integral_v<T> ? static_cast<T>(std::round(sum)) : static_cast<T>(sum);
  }

  bricks::Box Cells;
  std::vector<T> Values[CellComponents];
  std::vector<std::uint8_t> States;
};

/// A part of it, with copies of cells around it; the samples are sums of both components.
template <class T>
class CellPart final : public bricks::CellReader
{
public:
  CellPart(const CellVolume<T>& volume, const bricks::Box& cells, bool hasCopies)
    : Volume(volume)
    , Cells(cells)
    , Reach(hasCopies ? Intersect({ cells.Min - bricks::Index3(1), cells.Max + bricks::Index3(1) },
                          volume.Cells)
                      : cells)
  {
  }
  bricks::Box GetCells() const override { return this->Cells; }
  bricks::Box GetReach() const override { return this->Reach; }
  bool HasMask() const override { return true; }
  void ReadStates(const bricks::Box& cells, std::uint8_t* out) const override
  {
    ForEachIndex(cells,
      [&](const bricks::Index3& cell)
      {
        const bool isCopy = Intersect({ cell, cell + bricks::Index3(1) }, this->Cells).IsEmpty();
        const std::uint8_t state = this->Volume.States[this->Volume.GetId(cell)];
        *out++ = isCopy && state == Own ? std::uint8_t(Copy) : state;
      });
  }
  int CountComponents() const override { return CellComponents; }
  bricks::ScalarType GetType() const override { return GetScalarType<T>(); }
  void ReadValues(int component, const bricks::Box& cells, std::byte* out) const override
  {
    ForEachIndex(cells,
      [&](const bricks::Index3& cell)
      {
        std::memcpy(out, &this->Volume.Values[component][this->Volume.GetId(cell)], sizeof(T));
        out += sizeof(T);
      });
  }
  void Combine(std::size_t count, const std::byte* values, std::byte* samples) const override
  {
    std::vector<T> in(CellComponents * count);
    std::memcpy(in.data(), values, in.size() * sizeof(T));
    for (std::size_t sample = 0; sample < count; ++sample)
    {
      const T sum = static_cast<T>(in[sample] + in[count + sample]);
      std::memcpy(samples + sample * sizeof(T), &sum, sizeof(T));
    }
  }

private:
  const CellVolume<T>& Volume;
  bricks::Box Cells;
  bricks::Box Reach;
};

/// `owners`: the rank of each piece, from its number. Pieces of the number 0 are nowhere.
template <class T, class GetOwner>
void ExpectAverages(dsm::Messenger& messenger, int hidden, bool isFirstMissing, bool hasCopies,
  const GetOwner& getOwner)
{
  std::mt19937 random(7); // the same on every rank
  const CellVolume<T> volume({ 13, 9, 11 }, hidden, random);
  for (const int cuts : { 0, 1, 4, 30 })
  {
    std::vector<bricks::CellExchange::Piece> pieces;
    std::map<std::size_t, std::shared_ptr<bricks::CellAverages>> own;
    bricks::Box missing;
    for (const bricks::Box& box : CutAtRandom(volume.Cells, cuts, random))
    {
      if (isFirstMissing && cuts > 1 && missing.IsEmpty())
      {
        missing = box;
        continue;
      }
      const std::size_t number = pieces.size();
      const auto part = std::make_shared<CellPart<T>>(volume, box, hasCopies);
      pieces.push_back({ getOwner(number), true, hidden > 0, box, part->GetReach() });
      if (pieces.back().Rank == messenger.GetRank())
      {
        own[number] = std::make_shared<bricks::CellAverages>(part);
      }
    }
    bricks::CellExchange::Run(messenger, "Averaging", pieces, own);
    // A cell of the missing piece that none has a copy of is nowhere.
    bricks::Box unknown = missing;
    if (hasCopies && !missing.IsEmpty())
    {
      unknown.Min += bricks::Index3(1);
      unknown.Max -= bricks::Index3(1);
    }
    for (const auto& [number, piece] : own)
    {
      const bricks::Box cells = piece->GetCells();
      const bricks::Box points{ cells.Min, cells.Max + bricks::Index3(1) };
      std::vector<T> samples(static_cast<std::size_t>(points.GetCount()));
      piece->ReadSamples(points, reinterpret_cast<std::byte*>(samples.data()));
      std::size_t sample = 0;
      ForEachIndex(points,
        [&](const bricks::Index3& point)
        {
          const auto expected = static_cast<T>(
            volume.GetAverage(0, point, unknown) + volume.GetAverage(1, point, unknown));
          EXPECT_EQ(samples[sample++], expected) << "point " << point.x << " " << point.y << " "
                                                 << point.z << " after " << cuts << " cuts";
        });
      // The same in any part.
      const bricks::Box last{ points.Max - bricks::Index3(1), points.Max };
      T corner;
      piece->ReadSamples(last, reinterpret_cast<std::byte*>(&corner));
      EXPECT_EQ(corner, samples.back());
    }
  }
}

inline void AveragesDoNotDependOnPieces(dsm::Messenger& messenger)
{
  const int ranks = messenger.GetSize();
  const auto scattered = [=](std::size_t piece)
  { return static_cast<int>((piece * 7 + piece / 3) % static_cast<std::size_t>(ranks)); };
  const auto together = [=](std::size_t) { return ranks - 1; };
  ExpectAverages<double>(messenger, 0, false, false, scattered);
  ExpectAverages<float>(messenger, 300, false, false, scattered);
  ExpectAverages<std::int16_t>(messenger, 300, false, true, scattered);
  ExpectAverages<std::int64_t>(messenger, 0, false, false, together);
}

inline void CopiesStandInForMissingPieces(dsm::Messenger& messenger)
{
  const int ranks = messenger.GetSize();
  const auto scattered = [=](std::size_t piece)
  { return static_cast<int>(piece % static_cast<std::size_t>(ranks)); };
  ExpectAverages<double>(messenger, 0, true, true, scattered);
  ExpectAverages<float>(messenger, 200, true, true, scattered);
  ExpectAverages<std::uint8_t>(messenger, 0, true, false, scattered);
}

} // namespace dsm_test

#endif
