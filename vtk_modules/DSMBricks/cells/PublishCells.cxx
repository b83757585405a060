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
    const CellBrickHeader& header = brick.GetHeader();
    for (std::uint32_t group = 0; group < header.Groups; ++group)
    {
      std::uint16_t corners[CellBrick::GroupSize][CellBrick::MostCorners];
      const int count = brick.ReadGroup(group, corners);
      for (int cell = 0; cell < count; ++cell)
      {
        BoundingBox box;
        for (int corner = 0; corner < header.Corners; ++corner)
        {
          box.Add(Float4::Load(brick.GetPoint(corners[cell][corner])));
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
  static constexpr double StepsPerOctave = 4.0;
  static constexpr double Middle = 512.0;

  void AddCell(float size)
  {
    if (size > 0.0f)
    {
      const double step = std::round(StepsPerOctave * std::log2(static_cast<double>(size)));
      ++this->Counts[static_cast<std::size_t>(std::clamp(step + Middle, 0.0, 2.0 * Middle - 1.0))];
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

/// Yields what the owners of bricks know of the points of each rank. Block n is what rank n gets: the number of a
/// brick, how many of its points follow, their numbers in the brick, and those in the rank's source.
class RouteSource final : public dsm::FragmentSource
{
public:
  explicit RouteSource(const SortedBricks& bricks)
    : Bricks(bricks)
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
      this->Slots.emplace_back(notes[2 * slot], static_cast<std::uint32_t>(slot));
    }
    std::sort(this->Slots.rbegin(), this->Slots.rend());
  }

  const SortedBricks& Bricks;
  std::size_t Brick = 0;
  std::vector<std::pair<dsm::BlockId, std::uint32_t>> Slots; ///< rank and slot, the last first
};

/// Collective.
void ExchangeRoutes(std::string_view what, const SortedBricks& bricks,
  const std::vector<GridBrick>& grids, dsm::BlockId firstGrid, CornerRoutes& routes,
  dsm::Messenger& messenger)
{
  using Piece = std::pair<std::uint32_t, std::vector<std::uint32_t>>;
  std::vector<Piece> pieces;
  RouteSource source(bricks);
  const auto absorb = [&](dsm::BlockId, const std::byte* bytes, std::size_t count)
  {
    std::vector<std::uint32_t> words(count / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes, words.size() * sizeof(std::uint32_t));
    pieces.emplace_back(words.at(0), std::move(words));
  };
  dsm::FragmentStream::RunToRanks(what, messenger, source, absorb);
  messenger.RunTogether(what,
    [&]
    {
      std::sort(pieces.begin(), pieces.end(),
        [](const Piece& one, const Piece& other) { return one.first < other.first; });
      routes = CornerRoutes();
      for (const auto& [id, words] : pieces)
      {
        routes.Bricks.push_back({ id, routes.Points.size() });
        for (std::size_t word = 1; word + 1 < words.size(); word += 2)
        {
          routes.Slots.push_back(static_cast<std::uint16_t>(words[word]));
          routes.Points.push_back(words[word + 1]);
        }
      }
      for (const GridBrick& grid : grids)
      {
        routes.Bricks.push_back({ firstGrid++, routes.Points.size() });
        for (std::size_t slot = 0; slot < grid.Points.size(); ++slot)
        {
          routes.Slots.push_back(static_cast<std::uint16_t>(slot));
          routes.Points.push_back(grid.Points[slot]);
        }
      }
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
  SortedBrickBuilder builder(what, *reader, settings, messenger);
  static_cast<BrickSpace&>(*cells) = builder.GetSpace();
  SortedBricks bricks = builder.Build(progress);
  std::vector<GridBrick> grids;
  messenger.RunTogether(
    what, [&] { grids = CutGrids(source, builder.GetSpace(), settings.Threads); });
  const dsm::BlockId firstGrid = AddGridBricks(what, grids, bricks, messenger);
  ExchangeRoutes(what, bricks, grids, firstGrid, routes, messenger);
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
  const auto ofCopying = [&](double done) { progress(0.5 + 0.5 * done); };
  cells->Segment = store.Publish(what, std::move(*directory), *blocks, sink,
    progress ? dsm::FunctionRef<void(double)>(ofCopying) : dsm::FunctionRef<void(double)>(), place);
  return cells;
}

} // namespace bricks
