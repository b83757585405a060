// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/PublishCells.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/cells/CellBrick.h"
#include "DSMBricks/cells/CellRecords.h"
#include "DSMBricks/cells/GridCutter.h"
#include "DSMBricks/sorted/RecordExchange.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/publish/FragmentStream.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace bricks
{

namespace
{

/// Returns the corners of each cell that is in no grid, on all ranks.
int AgreeOnCorners(std::string_view what, const CellSource& source, dsm::Messenger& messenger)
{
  const auto others = messenger.GatherValueTogether(what,
    [&]
    {
      if (source.GetPointCount() > std::numeric_limits<std::uint32_t>::max())
      {
        throw dsm::Error("A rank has a grid of " + std::to_string(source.GetPointCount()) +
          " points; the maximum is 4294967295. Distribute the dataset over more ranks.");
      }
      return std::uint8_t(source.GetCellCount() > 0 && !source.HasOnlyTetrahedra() ? 1 : 0);
    });
  return *std::max_element(others.begin(), others.end()) != 0 ? 8 : 4;
}

/// How many cells have which size, in steps of a quarter of an octave: a sum that does not depend on the order.
class CellSizes
{
public:
  void Add(const CellBrick& brick)
  {
    CellGroup group;
    for (std::uint32_t number = 0; number < brick.GetHeader().Groups; ++number)
    {
      brick.ReadGroup(number, group);
      float places[CellGroup::MostPoints][4] = {};
      brick.ReadPlaces(group, places);
      for (int cell = 0; cell < group.Cells; ++cell)
      {
        BoundingBox box;
        for (int corner = 0; corner < group.Corners; ++corner)
        {
          box.Add(Float4::Load(places[group.At[cell][corner]]));
        }
        float size[4];
        (box.Upper - box.Lower).Store(size);
        this->AddCell(std::max({ size[0], size[1], size[2] }));
      }
    }
  }
  void Add(const CellSizes& other)
  {
    for (std::size_t step = 0; step < this->Counts.size(); ++step)
    {
      this->Counts[step] += other.Counts[step];
    }
  }
  std::uint64_t GetCount() const { return this->All; }
  void CountAll()
  {
    for (const std::uint64_t count : this->Counts)
    {
      this->All += count;
    }
  }
  /// A size than which a part of the cells is smaller; 0 without cells.
  double Get(double part) const
  {
    auto left = static_cast<std::uint64_t>(part * static_cast<double>(this->All));
    for (std::size_t step = 0; step < this->Counts.size(); ++step)
    {
      if (left < this->Counts[step])
      {
        return std::exp2((static_cast<double>(step) - Middle) / StepsPerOctave);
      }
      left -= this->Counts[step];
    }
    return 0.0;
  }

private:
  static constexpr int StepsPerOctave = 4;
  static constexpr int Middle = 512;

  void AddCell(float size)
  {
    if (size > 0.0f)
    {
      // The logarithm, rounded: the exponent, and between which roots of two the rest is.
      constexpr double borders[] = { 1.0905077326652577, 1.2968395546510096, 1.5422108254079407,
        1.8340080864093424 };
      int exponent;
      const double rest = 2.0 * std::frexp(static_cast<double>(size), &exponent);
      int step = StepsPerOctave * (exponent - 1);
      for (const double border : borders)
      {
        step += rest > border ? 1 : 0;
      }
      ++this->Counts[static_cast<std::size_t>(std::clamp(step + Middle, 0, 2 * Middle - 1))];
    }
  }

  std::array<std::uint64_t, 1024> Counts{};
  std::uint64_t All = 0;
};

/// Summary of a brick of a grid, for messages between ranks.
struct GridBrickSummary
{
  BoundingBox Box;
  std::uint32_t Bytes;
};

/// Collective. Numbers the bricks of grids behind the sorted ones, rank by rank. Returns the number of this rank's
/// first one.
dsm::BlockId AddGridBricks(std::string_view what, const std::vector<GridBrick>& own,
  SortedBricks& bricks, dsm::Messenger& messenger)
{
  const auto all = messenger.GatherTogether(what,
    [&]
    {
      std::vector<std::byte> mine(own.size() * sizeof(GridBrickSummary));
      for (std::size_t number = 0; number < own.size(); ++number)
      {
        const RecordBrick& brick = own[number].Brick;
        const GridBrickSummary summary{ brick.Bounds,
          static_cast<std::uint32_t>(brick.Bytes.size()) };
        std::memcpy(mine.data() + number * sizeof(summary), &summary, sizeof(summary));
      }
      return mine;
    });
  dsm::BlockId first = 0;
  messenger.RunTogether(what,
    [&]
    {
      for (std::size_t rank = 0; rank < all.size(); ++rank)
      {
        first = static_cast<int>(rank) == messenger.GetRank() ? bricks.Bytes.size() : first;
        for (std::size_t offset = 0; offset < all[rank].size(); offset += sizeof(GridBrickSummary))
        {
          GridBrickSummary summary;
          std::memcpy(&summary, all[rank].data() + offset, sizeof(summary));
          bricks.Boxes.push_back(summary.Box);
          bricks.Bytes.push_back(summary.Bytes);
        }
      }
    });
  return first;
}

/// Yields what the owners of bricks know of the points of other ranks. Block n is what rank n gets: the number of a
/// brick, and for each of the rank's points in it the number in the brick, and that in the rank's source.
class RouteSource final : public dsm::FragmentSource
{
public:
  RouteSource(const SortedBricks& bricks, const dsm::Messenger& messenger)
    : Bricks(bricks)
    , Rank(static_cast<std::uint32_t>(messenger.GetRank()))
    , Brick(messenger.GetSize() > 1 ? 0 : bricks.Own.size())
  {
  }

  bool Next(dsm::Fragment& fragment) override
  {
    while (this->Slots.empty())
    {
      if (this->Brick == this->Bricks.Own.size())
      {
        return false;
      }
      this->Sort();
    }
    const auto id = static_cast<std::uint32_t>(this->Bricks.Own[this->Brick - 1].Block);
    const std::vector<std::uint32_t>& notes = this->Bricks.Notes[this->Brick - 1];
    std::vector<std::uint32_t> words{ id };
    fragment.Block = this->Slots.back().first;
    while (!this->Slots.empty() && this->Slots.back().first == fragment.Block)
    {
      const std::uint32_t slot = this->Slots.back().second;
      words.push_back(slot);
      words.push_back(notes[2 * slot + 1]);
      this->Slots.pop_back();
    }
    const auto* const bytes = reinterpret_cast<const std::byte*>(words.data());
    fragment.Bytes.assign(bytes, bytes + words.size() * sizeof(std::uint32_t));
    return true;
  }
  double GetProgress() const override
  {
    return this->Bricks.Own.empty()
      ? 1.0
      : static_cast<double>(this->Brick) / static_cast<double>(this->Bricks.Own.size());
  }

private:
  /// The points of the next brick, by rank.
  void Sort()
  {
    const std::vector<std::uint32_t>& notes = this->Bricks.Notes[this->Brick++];
    for (std::size_t slot = 0; slot < notes.size() / 2; ++slot)
    {
      if (notes[2 * slot] != this->Rank)
      {
        this->Slots.emplace_back(notes[2 * slot], static_cast<std::uint32_t>(slot));
      }
    }
    std::sort(this->Slots.rbegin(), this->Slots.rend());
  }

  const SortedBricks& Bricks;
  std::uint32_t Rank;
  std::size_t Brick;
  std::vector<std::pair<dsm::BlockId, std::uint32_t>> Slots; ///< rank and slot, the last first
};

/// A rank's points in a brick, before they are put together.
struct RoutePiece
{
  enum class Layout
  {
    Notes,  ///< rank and point of each point of the brick; other ranks' are left out
    Words,  ///< slot and point
    Numbers ///< points of all slots
  };
  dsm::BlockId Id;
  Layout Form;
  const std::vector<std::uint32_t>* Words;
  std::size_t First; ///< of the numbers in Words
  std::size_t Count; ///< of points

  /// Calls visit(slot, point) for each.
  template <class Visit>
  void ForEach(std::uint32_t rank, const Visit& visit) const
  {
    const std::size_t step = this->Form == Layout::Numbers ? 1 : 2;
    std::size_t slot = 0;
    for (std::size_t word = this->First; word + step <= this->Words->size(); word += step, ++slot)
    {
      const std::uint32_t* const at = this->Words->data() + word;
      if (this->Form == Layout::Words)
      {
        visit(at[0], at[1]);
      }
      else if (this->Form == Layout::Numbers || at[0] == rank)
      {
        visit(slot, at[step - 1]);
      }
    }
  }
};

CornerRoutes JoinRoutes(std::vector<RoutePiece>& pieces, std::uint32_t rank, int threads)
{
  ParallelFor(threads, pieces.size(),
    [&](std::size_t number, int)
    {
      RoutePiece& piece = pieces[number];
      piece.Count = 0;
      piece.ForEach(rank, [&](std::size_t, std::uint32_t) { ++piece.Count; });
    });
  pieces.erase(std::remove_if(pieces.begin(), pieces.end(),
                 [](const RoutePiece& piece) { return piece.Count == 0; }),
    pieces.end());
  std::sort(pieces.begin(), pieces.end(),
    [](const RoutePiece& one, const RoutePiece& other) { return one.Id < other.Id; });
  CornerRoutes routes;
  std::size_t points = 0;
  for (const RoutePiece& piece : pieces)
  {
    routes.Bricks.push_back({ piece.Id, points });
    points += piece.Count;
  }
  routes.Slots.resize(points);
  routes.Points.resize(points);
  ParallelFor(threads, pieces.size(),
    [&](std::size_t number, int)
    {
      std::size_t at = routes.Bricks[number].Begin;
      pieces[number].ForEach(rank,
        [&](std::size_t slot, std::uint32_t point)
        {
          routes.Slots[at] = static_cast<std::uint16_t>(slot);
          routes.Points[at++] = point;
        });
    });
  return routes;
}

/// Collective.
void ExchangeRoutes(std::string_view what, const SortedBricks& bricks,
  const std::vector<GridBrick>& grids, dsm::BlockId firstGrid, int threads, CornerRoutes& routes,
  dsm::Messenger& messenger)
{
  std::vector<std::vector<std::uint32_t>> arrived;
  RouteSource source(bricks, messenger);
  const auto absorb = [&](dsm::BlockId, const std::byte* bytes, std::size_t count)
  {
    std::vector<std::uint32_t> words(count / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes, words.size() * sizeof(std::uint32_t));
    arrived.push_back(std::move(words));
  };
  dsm::FragmentStream::RunToRanks(what, messenger, source, absorb);
  messenger.RunTogether(what,
    [&]
    {
      using Layout = RoutePiece::Layout;
      std::vector<RoutePiece> pieces;
      for (std::size_t brick = 0; brick < bricks.Own.size(); ++brick)
      {
        pieces.push_back({ bricks.Own[brick].Block, Layout::Notes, &bricks.Notes[brick], 0, 0 });
      }
      for (const std::vector<std::uint32_t>& words : arrived)
      {
        pieces.push_back({ words.at(0), Layout::Words, &words, 1, 0 });
      }
      for (const GridBrick& grid : grids)
      {
        pieces.push_back({ firstGrid++, Layout::Numbers, &grid.Points, 0, 0 });
      }
      routes = JoinRoutes(pieces, static_cast<std::uint32_t>(messenger.GetRank()), threads);
    });
}

/// Collective.
CellSizes MeasureCells(
  std::string_view what, const SortedBricks& bricks, int threads, dsm::Messenger& messenger)
{
  const auto all = messenger.GatherValueTogether(what,
    [&]
    {
      std::vector<CellSizes> ofThread(static_cast<std::size_t>(std::max(threads, 1)));
      ParallelFor(static_cast<int>(ofThread.size()), bricks.Own.size(),
        [&](std::size_t brick, int thread) {
          ofThread[static_cast<std::size_t>(thread)].Add(CellBrick(bricks.Own[brick].Bytes.data()));
        });
      CellSizes mine;
      for (const CellSizes& sizes : ofThread)
      {
        mine.Add(sizes);
      }
      return mine;
    });
  CellSizes sum;
  for (const CellSizes& sizes : all)
  {
    sum.Add(sizes);
  }
  sum.CountAll();
  return sum;
}

} // namespace

std::shared_ptr<CellBricks> PublishCells(std::string_view what, const CellSource& source,
  const SortedBrickSettings& settings, dsm::BlockStore& store, dsm::Messenger& messenger,
  dsm::BlockStore::Place place, CornerRoutes& routes, dsm::FunctionRef<void(double)> progress)
{
  constexpr double fineCells = 0.1;
  const int corners = AgreeOnCorners(what, source, messenger);
  std::optional<CellRecordReader> reader;
  std::shared_ptr<CellBricks> cells;
  messenger.RunTogether(what,
    [&]
    {
      reader.emplace(source, corners, messenger.GetRank());
      cells = std::make_shared<CellBricks>();
    });
  SortedBrickBuilder builder(what, *reader, settings, messenger, progress);
  static_cast<BrickSpace&>(*cells) = builder.GetSpace();
  SortedBricks bricks = builder.Build(progress);
  std::vector<GridBrick> grids;
  messenger.RunTogether(
    what, [&] { grids = CutGrids(source, builder.GetSpace(), settings.Threads); });
  const dsm::BlockId firstGrid = AddGridBricks(what, grids, bricks, messenger);
  ExchangeRoutes(what, bricks, grids, firstGrid, settings.Threads, routes, messenger);
  bricks.Notes.clear();
  std::optional<dsm::BlockDirectory> directory;
  std::optional<BlockSource> blocks;
  messenger.RunTogether(what,
    [&]
    {
      for (std::size_t grid = 0; grid < grids.size(); ++grid)
      {
        bricks.Own.push_back({ firstGrid + grid, std::move(grids[grid].Brick.Bytes) });
      }
    });
  const CellSizes sizes = MeasureCells(what, bricks, settings.Threads, messenger);
  messenger.RunTogether(what,
    [&]
    {
      cells->Cells = sizes.GetCount();
      cells->ShortestEdge = sizes.Get(fineCells);
      cells->MeanEdge = sizes.Get(0.5);
      cells->Boxes = std::move(bricks.Boxes);
      directory.emplace(
        std::move(bricks.Bytes), dsm::RoundRobinAssigner(messenger.GetSize()), cells->GetBytes());
      directory->SetPaired();
      blocks.emplace(std::move(bricks.Own));
    });
  BlockSink sink;
  const auto ofCopying = [&](double done) { progress(0.9 + 0.1 * done); };
  cells->Segment = store.Publish(what, std::move(*directory), *blocks, sink,
    progress ? dsm::FunctionRef<void(double)>(ofCopying) : dsm::FunctionRef<void(double)>(), place);
  return cells;
}

} // namespace bricks
