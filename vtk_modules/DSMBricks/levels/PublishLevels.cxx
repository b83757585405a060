// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/levels/PublishLevels.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/layout/FillValues.h"
#include "DSMBricks/layout/MacrocellBuilder.h"
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMBricks/levels/LevelNodes.h"
#include "DSMBricks/sorted/RecordExchange.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/publish/BlockStream.h"
#include "DSMCore/publish/Publication.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bricks
{

namespace
{

constexpr Index3 CubeSize{ LevelLattice::Edge };

template <class T>
void Append(std::vector<std::byte>& bytes, const T* items, std::size_t count)
{
  const auto* const first = reinterpret_cast<const std::byte*>(items);
  bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

/// Contents of a message to the owner of a brick, which begins with one of these.
enum class Content : std::uint64_t
{
  Leaves, ///< of the brick's level: a Box, values, and flags
  Foreign ///< ForeignLeaf, any number
};

/// This rank's bricks on their way from leaves to points.
class LevelBuilder
{
public:
  LevelBuilder(std::string_view what, const LevelLattice& lattice, const LevelSource& source,
    dsm::Messenger& messenger, int threads, dsm::FunctionRef<void(double)> progress)
    : What(what)
    , Lattice(lattice)
    , Source(source)
    , Messages(messenger)
    , Threads(threads)
    , Progress(progress)
  {
  }

  /// Collective.
  void Run()
  {
    this->Messages.RunTogether(this->What, [&] { this->CreateNodes(); });
    this->SendCubes(&LevelBuilder::SendLeaves);
    this->SendCubes(&LevelBuilder::SendToOtherLevels);
    std::array<double, 2> limits = this->Limits;
    for (const std::array<double, 2>& other : this->Messages.AllGatherValue(this->Limits))
    {
      limits = { std::min(limits[0], other[0]), std::max(limits[1], other[1]) };
    }
    this->Messages.RunTogether(
      this->What, [&] { this->ForEachOwn([](LevelNodes& nodes) { nodes.FindMeans(); }); });
    for (int level = 0; level < this->Lattice.GetScales().GetCount(); ++level)
    {
      this->Messages.RunTogether(this->What,
        [&]
        {
          this->ForEachOwn(
            [&](LevelNodes& nodes)
            {
              if (nodes.GetBrick().Level == level)
              {
                nodes.FindHanging();
                nodes.ExtendToBorder(limits);
              }
            });
        });
      this->SendCorners(level);
    }
  }

  /// Nothing but these are needed any more.
  std::vector<std::unique_ptr<LevelNodes>>& GetNodes() { return this->Nodes; }
  dsm::BlockId GetId(std::size_t own) const
  {
    return static_cast<dsm::BlockId>(this->Messages.GetRank()) +
      own * static_cast<dsm::BlockId>(this->Messages.GetSize());
  }

private:
  void CreateNodes()
  {
    for (dsm::BlockId id = this->GetId(0); id < this->Lattice.GetBrickCount();
         id += static_cast<dsm::BlockId>(this->Messages.GetSize()))
    {
      this->Nodes.push_back(
        std::make_unique<LevelNodes>(this->Lattice, id, this->Source.IsOfPoints()));
    }
  }

  template <class Visit>
  void ForEachOwn(const Visit& visit)
  {
    ParallelFor(this->Threads, this->Nodes.size(),
      [&](std::size_t index, int) { visit(*this->Nodes[index]); });
  }

  /// Collective. `feed(stream)` sends a little, and returns false when nothing is left.
  template <class Feed>
  void Exchange(const Feed& feed)
  {
    this->Messages.BeginSession();
    const auto take = [this](int, dsm::BlockId id, const std::byte* bytes, std::size_t count)
    { this->Take(id, bytes, count); };
    dsm::FirstFailure failure;
    {
      dsm::BlockStream stream(this->Messages, take);
      failure = stream.Run([&] { return feed(stream); });
    }
    this->Messages.RunTogether(this->What, [&] { failure.Throw(); });
  }

  void Send(dsm::BlockStream& stream, dsm::BlockId id, std::vector<std::byte>&& bytes)
  {
    const auto ranks = static_cast<dsm::BlockId>(this->Messages.GetSize());
    const int owner = static_cast<int>(id % ranks);
    if (owner == this->Messages.GetRank())
    {
      this->Take(id, bytes.data(), bytes.size());
    }
    else
    {
      stream.Post(owner, id, std::move(bytes));
    }
  }

  void Take(dsm::BlockId id, const std::byte* bytes, std::size_t count)
  {
    const std::size_t own = id / static_cast<dsm::BlockId>(this->Messages.GetSize());
    if (own >= this->Nodes.size() || this->GetId(own) != id || count < sizeof(Content))
    {
      throw dsm::Error("A message about brick " + std::to_string(id) +
        " reached the wrong rank. Do all ranks run the same build?");
    }
    LevelNodes& nodes = *this->Nodes[own];
    Content content;
    std::memcpy(&content, bytes, sizeof(content));
    bytes += sizeof(content);
    count -= sizeof(content);
    if (content == Content::Leaves)
    {
      this->TakeLeaves(nodes, bytes, count);
      return;
    }
    for (std::size_t at = 0; at + sizeof(ForeignLeaf) <= count; at += sizeof(ForeignLeaf))
    {
      ForeignLeaf leaf;
      std::memcpy(&leaf, bytes + at, sizeof(leaf));
      if (this->TakesCorners)
      {
        nodes.AddCorners(leaf);
      }
      else
      {
        nodes.AddLeaf(leaf);
      }
    }
  }

  void TakeLeaves(LevelNodes& nodes, const std::byte* bytes, std::size_t count)
  {
    Box box;
    std::memcpy(&box, bytes, std::min(sizeof(box), count));
    const auto cells = static_cast<std::size_t>(box.GetCount());
    const std::size_t samples = this->CountSamples(box);
    if (count != sizeof(box) + samples * sizeof(double) + cells)
    {
      throw dsm::Error("A message about leaves of a brick has " + std::to_string(count) +
        " bytes. Do all ranks run the same build?");
    }
    std::vector<double> values(samples);
    std::memcpy(values.data(), bytes + sizeof(box), samples * sizeof(double));
    nodes.AddLeaves(box, values.data(),
      reinterpret_cast<const std::uint8_t*>(bytes + sizeof(box) + samples * sizeof(double)));
  }

  std::size_t CountSamples(const Box& cells) const
  {
    const Box points{ cells.Min, cells.Max + Index3(this->Source.IsOfPoints() ? 1 : 0) };
    return static_cast<std::size_t>(points.GetCount());
  }

  /// Collective. Calls `send(stream, cube)` for each of the source's cubes, which is in Values and Leaves then.
  void SendCubes(void (LevelBuilder::*send)(dsm::BlockStream&, const LevelCube&))
  {
    const Box whole{ Index3(0), CubeSize };
    this->Values.assign(this->CountSamples(whole), 0.0);
    this->Leaves.assign(static_cast<std::size_t>(whole.GetCount()), 0);
    std::size_t next = 0;
    const std::vector<LevelCube>& cubes = this->Source.GetCubes();
    this->Exchange(
      [&](dsm::BlockStream& stream)
      {
        if (next == cubes.size())
        {
          return false;
        }
        this->Source.ReadCube(next, this->Values.data(), this->Leaves.data());
        (this->*send)(stream, cubes[next++]);
        if (this->Progress)
        {
          this->Progress(static_cast<double>(next) / static_cast<double>(cubes.size() + 1));
        }
        return true;
      });
  }

  bool IsLeaf(const Index3& at) const
  {
    return this->Leaves[static_cast<std::size_t>(at.x + CubeSize.x * (at.y + CubeSize.y * at.z))] !=
      0;
  }

  /// To bricks of the same level.
  void SendLeaves(dsm::BlockStream& stream, const LevelCube& cube)
  {
    for (std::size_t cell = 0; !this->Source.IsOfPoints() && cell < this->Leaves.size(); ++cell)
    {
      const double value = this->Values[cell];
      if (this->Leaves[cell] != 0 && std::isfinite(value))
      {
        this->Limits = { std::min(this->Limits[0], value), std::max(this->Limits[1], value) };
      }
    }
    const Index3 first = LevelCubes::GetFirst(cube);
    const Box whole{ first, first + CubeSize };
    const Index3 stride = CubeSize + Index3(this->Source.IsOfPoints() ? 1 : 0);
    this->Lattice.ForEachTouching(cube.Level, whole, cube.Level,
      [&](dsm::BlockId id, const LevelBrick& brick)
      {
        const Box box =
          Intersect(whole, { brick.Cells.Min - Index3(1), brick.Cells.Max + Index3(1) });
        const Box points{ box.Min, box.Max + (stride - CubeSize) };
        std::vector<double> values;
        values.reserve(this->CountSamples(box));
        ForEachIndex(points,
          [&](const Index3& point)
          {
            const Index3 at = point - first;
            values.push_back(
              this->Values[static_cast<std::size_t>(at.x + stride.x * (at.y + stride.y * at.z))]);
          });
        std::vector<std::uint8_t> leaves;
        leaves.reserve(static_cast<std::size_t>(box.GetCount()));
        ForEachIndex(
          box, [&](const Index3& cell) { leaves.push_back(this->IsLeaf(cell - first) ? 1 : 0); });
        std::vector<std::byte> bytes;
        const Content content = Content::Leaves;
        Append(bytes, &content, 1);
        Append(bytes, &box, 1);
        Append(bytes, values.data(), values.size());
        Append(bytes, leaves.data(), leaves.size());
        this->Send(stream, id, std::move(bytes));
      });
  }

  ForeignLeaf GetLeaf(const LevelCube& cube, const Index3& at) const
  {
    ForeignLeaf leaf{};
    leaf.Level = cube.Level;
    const Index3 cell = LevelCubes::GetFirst(cube) + at;
    const bool ofPoints = this->Source.IsOfPoints();
    const Index3 stride = CubeSize + Index3(ofPoints ? 1 : 0);
    for (int axis = 0; axis < 3; ++axis)
    {
      leaf.Cell[axis] = static_cast<std::int32_t>(cell[axis]);
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      const Index3 from = ofPoints ? at + Index3(corner & 1, corner >> 1 & 1, corner >> 2) : at;
      leaf.Values[corner] =
        this->Values[static_cast<std::size_t>(from.x + stride.x * (from.y + stride.y * from.z))];
    }
    return leaf;
  }

  /// To bricks of coarser and of finer levels that the leaves touch.
  void SendToOtherLevels(dsm::BlockStream& stream, const LevelCube& cube)
  {
    const LevelScales& scales = this->Lattice.GetScales();
    const Index3 first = LevelCubes::GetFirst(cube);
    const Index3 own = scales.Get(cube.Level);
    const Box filled{ first + Index3(cube.Min[0], cube.Min[1], cube.Min[2]),
      first + Index3(cube.Max[0], cube.Max[1], cube.Max[2]) };
    for (int level = 0; level < scales.GetCount(); ++level)
    {
      if (level == cube.Level)
      {
        continue;
      }
      // The leaves in the corners of a larger cell touch its corners.
      const Index3 ratio = level < cube.Level ? scales.GetRatio(level, cube.Level) : Index3(1);
      const Index3 other = scales.Get(level);
      this->Lattice.ForEachTouching(cube.Level, filled, level,
        [&](dsm::BlockId id, const LevelBrick& brick)
        {
          const Box near{ DivideDown(brick.Cells.Min * own - other, other),
            DivideUp(brick.Cells.Max * own + other, other) };
          std::vector<std::byte> bytes;
          const Content content = Content::Foreign;
          Append(bytes, &content, 1);
          ForEachIndex(Intersect(filled, near),
            [&](const Index3& cell)
            {
              const Index3 part = cell - DivideDown(cell, ratio) * ratio;
              const bool isInCorner =
                glm::all(glm::equal(glm::min(part, ratio - Index3(1) - part), Index3(0)));
              const bool touches =
                glm::all(glm::lessThanEqual(cell * other, brick.Cells.Max * own)) &&
                glm::all(glm::lessThanEqual(brick.Cells.Min * own, (cell + Index3(1)) * other));
              if (isInCorner && touches && this->IsLeaf(cell - first))
              {
                const ForeignLeaf leaf = this->GetLeaf(cube, cell - first);
                Append(bytes, &leaf, 1);
              }
            });
          if (bytes.size() > sizeof(content))
          {
            this->Send(stream, id, std::move(bytes));
          }
        });
    }
  }

  /// Collective: the corners of a level's leaves go to the bricks of finer levels that they touch.
  void SendCorners(int level)
  {
    this->TakesCorners = true;
    std::size_t next = 0;
    this->Exchange(
      [&](dsm::BlockStream& stream)
      {
        while (next < this->Nodes.size() && this->Nodes[next]->GetBrick().Level != level)
        {
          ++next;
        }
        if (next == this->Nodes.size())
        {
          return false;
        }
        const LevelNodes& nodes = *this->Nodes[next++];
        for (int finer = level + 1; finer < this->Lattice.GetScales().GetCount(); ++finer)
        {
          this->Lattice.ForEachTouching(level, nodes.GetBrick().Cells, finer,
            [&](dsm::BlockId id, const LevelBrick& brick)
            {
              std::vector<std::byte> bytes;
              const Content content = Content::Foreign;
              Append(bytes, &content, 1);
              nodes.ForEachLeafTouching(
                finer, brick.Cells, [&](const ForeignLeaf& leaf) { Append(bytes, &leaf, 1); });
              if (bytes.size() > sizeof(content))
              {
                this->Send(stream, id, std::move(bytes));
              }
            });
        }
        return true;
      });
  }

  std::string_view What;
  const LevelLattice& Lattice;
  const LevelSource& Source;
  dsm::Messenger& Messages;
  int Threads;
  dsm::FunctionRef<void(double)> Progress;
  std::vector<std::unique_ptr<LevelNodes>>
    Nodes; ///< of this rank's bricks, in the order of their numbers
  bool TakesCorners = false;
  /// Least and largest value of this rank's cells.
  std::array<double, 2> Limits{ std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity() };
  std::vector<double> Values; ///< of the cube that is sent
  std::vector<std::uint8_t> Leaves;
};

template <class T>
void FillBrick(const LevelNodes& nodes, std::byte* block)
{
  auto& header = *reinterpret_cast<VoxelBrickHeader*>(block);
  header.Borders = nodes.FindBorders();
  auto* const samples = reinterpret_cast<T*>(block + header.SampleOffset);
  for (std::size_t point = 0; point < nodes.GetValues().GetCount(); ++point)
  {
    samples[point] = static_cast<T>(nodes.GetValues().Get(point));
  }
  if (header.MaskOffset != 0)
  {
    std::int64_t bit = 0;
    std::byte* const mask = block + header.MaskOffset;
    ForEachIndex(nodes.GetBrick().Cells,
      [&](const Index3& cell)
      {
        if (nodes.IsLeaf(cell))
        {
          mask[bit >> 3] |= std::byte{ 1 } << (bit & 7);
        }
        ++bit;
      });
  }
  BuildMacrocells<T>(block);
}

/// Gives this rank's bricks, and frees their nodes.
class NodesSource final : public dsm::FragmentSource
{
public:
  NodesSource(const LevelLattice& lattice, LevelBuilder& builder)
    : Lattice(lattice)
    , Builder(builder)
  {
  }
  bool Next(dsm::Fragment& fragment) override
  {
    std::vector<std::unique_ptr<LevelNodes>>& all = this->Builder.GetNodes();
    if (this->Done == all.size())
    {
      return false;
    }
    const std::unique_ptr<LevelNodes> nodes = std::move(all[this->Done]);
    fragment.Block = this->Builder.GetId(this->Done++);
    const LevelBrick& brick = nodes->GetBrick();
    const VoxelBrickHeader header =
      CreateVoxelBrickHeader(brick.Cells.GetSize(), this->Lattice.GetScalarType(), brick.HasMask);
    fragment.Bytes.assign(header.BlockBytes, std::byte{ 0 });
    std::memcpy(fragment.Bytes.data(), &header, sizeof(header));
    if (header.Type == ScalarType::Float32)
    {
      FillBrick<float>(*nodes, fragment.Bytes.data());
    }
    else
    {
      FillBrick<double>(*nodes, fragment.Bytes.data());
    }
    return true;
  }
  double GetProgress() const override { return 0.0; }

private:
  const LevelLattice& Lattice;
  LevelBuilder& Builder;
  std::size_t Done = 0;
};

/// Collective. Surveys the bricks, without the fill values that nothing declares.
IsovalueSurvey Survey(const LevelVoxels& voxels, dsm::Messenger& messenger)
{
  const auto look = [&](const ValueLimits& limits)
  {
    LimitedSurvey mine;
    messenger.RunTogether("Surveying the levels",
      [&]
      {
        const Index3 end(glm::ceil(voxels.Lattice.GetBounds()[1]));
        voxels.Segment->ForEachResident(
          [&](dsm::BlockId id, const std::byte* block, std::size_t)
          {
            const LevelBrick& brick = voxels.Lattice.GetBrick(id);
            const Index3 scale = voxels.Lattice.GetScales().Get(brick.Level);
            mine.CountBrick(brick.Cells, end * scale, block, limits);
          });
      });
    return AddSurveys(mine, messenger);
  };
  return LeaveOutFills(look({}).Within, { &voxels.Hierarchy.GetRanges() }, look);
}

/// In cells of level 0, rounded outward.
BoundingBox GetBox(const LevelLattice& lattice, const LevelBrick& brick)
{
  const glm::dvec3 scale(lattice.GetScales().Get(brick.Level));
  const glm::dvec3 lower = glm::dvec3(brick.Cells.Min) / scale;
  const glm::dvec3 upper = glm::dvec3(brick.Cells.Max) / scale;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  float below[4] = {};
  float above[4] = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    below[axis] = std::nextafter(static_cast<float>(lower[axis]), -infinity);
    above[axis] = std::nextafter(static_cast<float>(upper[axis]), infinity);
  }
  BoundingBox box;
  box.Add(Float4::Load(below));
  box.Add(Float4::Load(above));
  return box;
}

/// The hierarchy over the bricks of all levels. `ranges`: by their numbers.
RangedBrickBvh CreateHierarchy(const LevelLattice& lattice, const std::vector<ValueRange>& ranges)
{
  std::vector<BoundingBox> boxes;
  boxes.reserve(lattice.GetBricks().size());
  for (const LevelBrick& brick : lattice.GetBricks())
  {
    boxes.push_back(GetBox(lattice, brick));
  }
  return RangedBrickBvh(boxes, ranges);
}

} // namespace

LevelLattice DivideLevels(std::string_view what, const LevelScales& scales, ScalarType type,
  const LevelSource& source, dsm::Messenger& messenger)
{
  const auto parts = messenger.GatherTogether(what,
    [&]
    {
      std::vector<std::byte> mine;
      Append(mine, source.GetCubes().data(), source.GetCubes().size());
      return mine;
    });
  LevelLattice lattice;
  messenger.RunTogether(what,
    [&]
    {
      std::vector<LevelCube> cubes;
      for (const std::vector<std::byte>& part : parts)
      {
        const std::size_t first = cubes.size();
        cubes.resize(first + part.size() / sizeof(LevelCube));
        std::memcpy(cubes.data() + first, part.data(), (cubes.size() - first) * sizeof(LevelCube));
      }
      lattice = LevelLattice(scales, cubes, type);
    });
  return lattice;
}

std::shared_ptr<LevelVoxels> PublishLevels(std::string_view what, const LevelLattice& lattice,
  const LevelSource& source, dsm::BlockStore& store, dsm::Messenger& messenger,
  dsm::BlockStore::Place place, int threads, dsm::FunctionRef<void(double)> progress)
{
  LevelBuilder builder(what, lattice, source, messenger, threads, progress);
  builder.Run();
  std::shared_ptr<LevelVoxels> voxels;
  std::optional<dsm::BlockDirectory> directory;
  messenger.RunTogether(what,
    [&]
    {
      voxels = std::make_shared<LevelVoxels>();
      voxels->Lattice = lattice;
      directory = lattice.CreateDirectory(messenger.GetSize());
    });
  NodesSource nodes(lattice, builder);
  BlockSink sink;
  voxels->Segment = store.Publish(what, std::move(*directory), nodes, sink, {}, place);
  try
  {
    const std::vector<ValueRange> ranges =
      MacrocellHierarchy::GatherRanges(*voxels->Segment, messenger);
    messenger.RunTogether(what, [&] { voxels->Hierarchy = CreateHierarchy(lattice, ranges); });
    voxels->Survey = Survey(*voxels, messenger);
  }
  catch (...) // on every rank
  {
    store.Retire(voxels->Segment);
    throw;
  }
  return voxels;
}

} // namespace bricks
