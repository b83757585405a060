// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/base/SharedProgress.h"
#include "DSMBricks/cells/CellBrick.h"
#include "DSMBricks/cells/PublishCells.h"
#include "DSMBricks/layout/FillValues.h"
#include "DSMBricks/sorted/RecordExchange.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/publish/FragmentStream.h"

#include <algorithm>
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

constexpr float NoValue = std::numeric_limits<float>::quiet_NaN();

/// Approximate shares of the time: values for other ranks, and their blocks.
constexpr double EndOfMoving = 0.2;
constexpr double EndOfWriting = 0.8;

/// Values at points of a brick, by the points' numbers in it.
struct BrickPoints
{
  std::vector<float> Values;
  std::vector<PackedGradient> Gradients; ///< or none

  void Reset(std::size_t points, bool hasGradients)
  {
    this->Values.assign(points, NoValue);
    this->Gradients.assign(hasGradients ? points : 0, PackedGradient());
  }
};

/// What this rank has for bricks: the values of its points, and their gradients, if there are any.
class OwnValues
{
public:
  OwnValues(const CornerRoutes& routes, dsm::FunctionRef<double(std::uint64_t)> getValue,
    const std::vector<PackedGradient>& gradients, bool hasGradients)
    : Routes(routes)
    , GetValue(getValue)
    , Gradients(gradients)
    , HasGradients(hasGradients)
  {
  }

  std::size_t GetBrickCount() const { return this->Routes.Bricks.size(); }
  dsm::BlockId GetBrick(std::size_t number) const { return this->Routes.Bricks[number].Id; }
  /// Calls visit(slot, value, gradient) for this rank's points in a brick. Any thread.
  template <class Visit>
  void ForEachPoint(std::size_t brick, const Visit& visit) const
  {
    const std::size_t end = this->GetEnd(brick);
    for (std::size_t entry = this->Routes.Bricks[brick].Begin; entry < end; ++entry)
    {
      const std::uint32_t point = this->Routes.Points[entry];
      const auto read = static_cast<float>(this->GetValue(point));
      visit(this->Routes.Slots[entry], std::isfinite(read) ? read + 0.0f : NoValue,
        this->HasGradients ? this->Gradients[point] : PackedGradient());
    }
  }
  /// The same for a brick of that number, if this rank has points in it.
  template <class Visit>
  void ForEachPointOf(dsm::BlockId id, const Visit& visit) const
  {
    const auto brick = std::lower_bound(this->Routes.Bricks.begin(), this->Routes.Bricks.end(), id,
      [](const CornerRoutes::Brick& one, dsm::BlockId number) { return one.Id < number; });
    if (brick != this->Routes.Bricks.end() && brick->Id == id)
    {
      this->ForEachPoint(static_cast<std::size_t>(brick - this->Routes.Bricks.begin()), visit);
    }
  }
  std::size_t CountPoints(std::size_t brick) const
  {
    return this->GetEnd(brick) - this->Routes.Bricks[brick].Begin;
  }

private:
  std::size_t GetEnd(std::size_t brick) const
  {
    return brick + 1 < this->Routes.Bricks.size() ? this->Routes.Bricks[brick + 1].Begin
                                                  : this->Routes.Points.size();
  }

  const CornerRoutes& Routes;
  dsm::FunctionRef<double(std::uint64_t)> GetValue;
  const std::vector<PackedGradient>& Gradients;
  bool HasGradients;
};

/// Yields this rank's values for each brick of another rank: the points' numbers in it, the values, and their
/// gradients, if there are any.
class ValueSource final : public dsm::FragmentSource
{
public:
  ValueSource(const OwnValues& own, bool hasGradients, const dsm::BlockDirectory& owners, int rank)
    : Own(own)
    , HasGradients(hasGradients)
    , Owners(owners)
    , Rank(rank)
  {
  }

  bool Next(dsm::Fragment& fragment) override
  {
    while (this->Brick < this->Own.GetBrickCount() &&
      this->Owners.GetOwner(this->Own.GetBrick(this->Brick)) == this->Rank)
    {
      ++this->Brick;
    }
    if (this->Brick == this->Own.GetBrickCount())
    {
      return false;
    }
    const std::size_t count = this->Own.CountPoints(this->Brick);
    fragment.Block = this->Own.GetBrick(this->Brick);
    fragment.Bytes.resize(count * CountBytes(this->HasGradients));
    std::byte* slots = fragment.Bytes.data();
    std::byte* values = slots + count * sizeof(std::uint16_t);
    std::byte* gradients = values + count * sizeof(float);
    this->Own.ForEachPoint(this->Brick++,
      [&](std::uint16_t slot, float value, const PackedGradient& gradient)
      {
        Write(slot, slots);
        Write(value, values);
        if (this->HasGradients)
        {
          Write(gradient, gradients);
        }
      });
    return true;
  }
  double GetProgress() const override
  {
    return this->Own.GetBrickCount() == 0
      ? 1.0
      : static_cast<double>(this->Brick) / static_cast<double>(this->Own.GetBrickCount());
  }

  /// Puts the values of a fragment where they belong.
  static void Read(const std::vector<std::byte>& fragment, bool hasGradients, BrickPoints& points)
  {
    const std::size_t count = fragment.size() / CountBytes(hasGradients);
    const std::byte* const values = fragment.data() + count * sizeof(std::uint16_t);
    const std::byte* const gradients = values + count * sizeof(float);
    for (std::size_t number = 0; number < count; ++number)
    {
      std::uint16_t slot;
      std::memcpy(&slot, fragment.data() + number * sizeof(slot), sizeof(slot));
      std::memcpy(&points.Values.at(slot), values + number * sizeof(float), sizeof(float));
      if (hasGradients)
      {
        std::memcpy(&points.Gradients.at(slot), gradients + number * sizeof(PackedGradient),
          sizeof(PackedGradient));
      }
    }
  }

private:
  /// Bytes of each value in a fragment.
  static std::size_t CountBytes(bool hasGradients)
  {
    return sizeof(std::uint16_t) + sizeof(float) + (hasGradients ? sizeof(PackedGradient) : 0);
  }
  template <class Item>
  static void Write(const Item& item, std::byte*& to)
  {
    std::memcpy(to, &item, sizeof(item));
    to += sizeof(item);
  }

  const OwnValues& Own;
  bool HasGradients;
  const dsm::BlockDirectory& Owners;
  int Rank;
  std::size_t Brick = 0;
};

std::uint32_t Align(std::size_t bytes)
{
  return static_cast<std::uint32_t>((bytes + 15) / 16 * 16);
}

/// Rounds ranges of values outward to bytes.
class RangeScale
{
public:
  RangeScale(float first, float last)
    : First(first)
    , Step((last - first) / CellValueHeader::Steps)
  {
    while (this->First + this->Step * CellValueHeader::Steps < last)
    {
      this->Step = std::nextafter(this->Step, std::numeric_limits<float>::infinity());
    }
  }

  float GetStep() const { return this->Step; }
  std::uint8_t RoundDown(float value) const
  {
    float number = this->Step > 0.0f ? std::floor((value - this->First) / this->Step) : 0.0f;
    number = std::clamp(number, 0.0f, CellValueHeader::Steps);
    while (number > 0.0f && this->First + this->Step * number > value)
    {
      --number;
    }
    return static_cast<std::uint8_t>(number);
  }
  std::uint8_t RoundUp(float value) const
  {
    float number = this->Step > 0.0f ? std::ceil((value - this->First) / this->Step) : 0.0f;
    number = std::clamp(number, 0.0f, CellValueHeader::Steps);
    while (number < CellValueHeader::Steps && this->First + this->Step * number < value)
    {
      ++number;
    }
    return static_cast<std::uint8_t>(number);
  }

private:
  float First;
  float Step;
};

/// Writes the values of a brick.
std::vector<std::byte> WriteValues(
  const CellBrick& brick, const BrickPoints& points, bool hasGradients, IsovalueSurvey& survey)
{
  const CellBrickHeader& header = brick.GetHeader();
  std::vector<ValueRange> groups(header.Groups, ValueRange::GetEmpty());
  ValueRange all = ValueRange::GetEmpty();
  CellGroup group;
  for (std::uint32_t number = 0; number < header.Groups; ++number)
  {
    brick.ReadGroup(number, group);
    for (int cell = 0; cell < group.Cells; ++cell)
    {
      ValueRange range = ValueRange::GetEmpty();
      bool isWhole = true;
      for (int corner = 0; corner < group.Corners; ++corner)
      {
        const float value = points.Values[group.Numbers[group.At[cell][corner]]];
        isWhole = isWhole && !std::isnan(value);
        range.Add({ value, value });
      }
      if (isWhole)
      {
        groups[number].Add(range);
        survey.CountRange(range.First, range.Last, false);
      }
    }
    all.Add(groups[number]);
  }

  CellValueHeader values{};
  const std::uint32_t valueBytes = Align(header.Points * sizeof(float));
  const std::uint32_t gradientBytes = hasGradients ? valueBytes : 0;
  values.GradientOffset = hasGradients ? CellValueHeader::ValueOffset + valueBytes : 0;
  values.RangeOffset = CellValueHeader::ValueOffset + valueBytes + gradientBytes;
  values.BlockBytes = values.RangeOffset + header.Nodes * 2u * WideBvhWidth;
  const RangeScale scale(
    all.First <= all.Last ? all.First : 0.0f, all.First <= all.Last ? all.Last : 0.0f);
  values.First = all.First;
  values.Last = all.Last;
  values.Step = scale.GetStep();
  std::vector<std::byte> bytes(values.BlockBytes);
  std::memcpy(bytes.data(), &values, sizeof(values));
  std::memcpy(bytes.data() + CellValueHeader::ValueOffset, points.Values.data(),
    header.Points * sizeof(float));
  if (hasGradients)
  {
    std::memcpy(bytes.data() + values.GradientOffset, points.Gradients.data(),
      header.Points * sizeof(PackedGradient));
  }
  // Children stand behind their parents.
  std::vector<ValueRange> nodes(header.Nodes, ValueRange::GetEmpty());
  for (std::uint32_t node = header.Nodes; node-- > 0;)
  {
    const CellBrick::Node& shape = brick.GetNodes()[node];
    std::byte* const ranges = bytes.data() + values.RangeOffset + 2 * WideBvhWidth * node;
    for (int child = 0; child < WideBvhWidth; ++child)
    {
      ValueRange range = ValueRange::GetEmpty();
      if (child < shape.Children)
      {
        const std::uint16_t reference = shape.References[child];
        range = reference & CellBrick::Node::LeafBit ? groups[CellBrick::GetGroup(reference)]
                                                     : nodes[reference];
      }
      const bool isAny = range.First <= range.Last;
      ranges[child] = std::byte(isAny ? scale.RoundDown(range.First) : 255);
      ranges[WideBvhWidth + child] = std::byte(isAny ? scale.RoundUp(range.Last) : 0);
      nodes[node].Add(range);
    }
  }
  return bytes;
}

/// Calls `visit(id, block, thread)` for the bricks of cells that this rank owns, by several threads where they are in
/// memory. `first`, `step`: their numbers; `own`: their count.
template <class Visit>
void ForEachOwn(const dsm::BlockSegment& segment, std::size_t first, std::size_t step,
  std::size_t own, int threads, const Visit& visit)
{
  if (segment.GetDirectory().IsFromSource())
  {
    segment.ForEachResident(
      [&](dsm::BlockId id, const std::byte* block, std::size_t) { visit(id, block, 0); });
    return;
  }
  ParallelFor(threads, own,
    [&](std::size_t number, int thread)
    {
      const dsm::BlockId id = first + number * step;
      visit(id, segment.GetOwned(id), thread);
    });
}

/// What a rank knows of a block of values, for all ranks.
struct BlockSummary
{
  std::uint32_t Bytes;
  ValueRange Range;
};

} // namespace

std::shared_ptr<CellValues> PublishCellValues(std::string_view what,
  const std::shared_ptr<const CellBricks>& cells, const CornerRoutes& routes,
  dsm::FunctionRef<double(std::uint64_t)> getValue, const std::vector<PackedGradient>& gradients,
  int threads, dsm::BlockStore& store, dsm::Messenger& messenger, dsm::BlockStore::Place place,
  dsm::FunctionRef<void(double)> progress)
{
  using Progress = dsm::FunctionRef<void(double)>;
  const int ranks = messenger.GetSize();
  const int workers = std::max(threads, 1);
  const dsm::BlockDirectory& topology = cells->Segment->GetDirectory();
  const auto flags = messenger.AllGatherValue(std::uint8_t(gradients.empty() ? 0 : 1));
  const bool hasGradients = *std::max_element(flags.begin(), flags.end()) != 0;
  const std::size_t bricks = topology.GetCount();
  const auto first = static_cast<std::size_t>(messenger.GetRank());
  const auto step = static_cast<std::size_t>(ranks);
  std::vector<std::vector<std::vector<std::byte>>> arrived; // fragments from other ranks
  const OwnValues own(routes, getValue, gradients, hasGradients);
  ValueSource values(own, hasGradients, topology, messenger.GetRank());
  messenger.RunTogether(what, [&] { arrived.resize((bricks + step - 1 - first) / step); });
  const auto absorb = [&](dsm::BlockId id, const std::byte* bytes, std::size_t count)
  { arrived[id / step].emplace_back(bytes, bytes + count); };
  const auto ofMoving = [&](double done) { progress(EndOfMoving * done); };
  const dsm::FirstFailure failure = dsm::FragmentStream::Run(
    messenger, topology, values, absorb, progress ? Progress(ofMoving) : Progress());

  std::vector<IsovalueSurvey> ofThread;
  std::vector<dsm::Fragment> blocks;
  const auto all = messenger.GatherTogether(what,
    [&]
    {
      failure.Throw();
      ofThread.resize(static_cast<std::size_t>(workers));
      blocks.resize(arrived.size());
      std::vector<BlockSummary> mine(arrived.size());
      std::vector<BrickPoints> pointsOfThread(static_cast<std::size_t>(workers));
      SharedProgress advance(progress, EndOfMoving, EndOfWriting, arrived.size());
      ForEachOwn(*cells->Segment, first, step, arrived.size(), workers,
        [&](dsm::BlockId id, const std::byte* block, int thread)
        {
          const std::size_t number = id / step;
          const CellBrick brick(block);
          BrickPoints& points = pointsOfThread[static_cast<std::size_t>(thread)];
          points.Reset(brick.GetHeader().Points, hasGradients);
          for (const std::vector<std::byte>& fragment : arrived[number])
          {
            ValueSource::Read(fragment, hasGradients, points);
          }
          arrived[number] = {};
          own.ForEachPointOf(id,
            [&](std::uint16_t slot, float value, const PackedGradient& gradient)
            {
              points.Values.at(slot) = value;
              if (hasGradients)
              {
                points.Gradients[slot] = gradient;
              }
            });
          blocks[number] = { id,
            WriteValues(brick, points, hasGradients, ofThread[static_cast<std::size_t>(thread)]) };
          advance.Add(thread);
          const CellValueHeader& header = CellValueBrick(blocks[number].Bytes.data()).GetHeader();
          mine[number] = { header.BlockBytes, { header.First, header.Last } };
        });
      std::vector<std::byte> bytes(mine.size() * sizeof(BlockSummary));
      std::memcpy(bytes.data(), mine.data(), bytes.size());
      return bytes;
    });
  LimitedSurvey mine;
  for (const IsovalueSurvey& one : ofThread)
  {
    mine.Within.Add(one);
  }
  const IsovalueSurvey survey = AddSurveys(mine, messenger).Within;

  std::shared_ptr<CellValues> published;
  std::optional<dsm::BlockDirectory> directory;
  std::optional<BlockSource> source;
  messenger.RunTogether(what,
    [&]
    {
      published = std::make_shared<CellValues>();
      published->Cells = cells;
      published->Survey = survey;
      std::vector<std::uint32_t> bytes;
      std::vector<ValueRange> ranges;
      for (std::size_t id = 0; id < bricks; ++id)
      {
        BlockSummary summary;
        std::memcpy(&summary, all[id % step].data() + id / step * sizeof(summary), sizeof(summary));
        bytes.push_back(summary.Bytes);
        ranges.push_back(summary.Range);
      }
      published->Hierarchy = RangedBrickBvh(cells->Boxes, ranges);
      directory.emplace(
        std::move(bytes), dsm::RoundRobinAssigner(ranks), published->Hierarchy.GetBytes());
      directory->SetPaired();
      source.emplace(std::move(blocks));
    });
  BlockSink sink;
  const auto ofCopying = [&](double done) { progress(EndOfWriting + (1.0 - EndOfWriting) * done); };
  published->Segment = store.Publish(
    what, std::move(*directory), *source, sink, progress ? Progress(ofCopying) : Progress(), place);
  return published;
}

} // namespace bricks
