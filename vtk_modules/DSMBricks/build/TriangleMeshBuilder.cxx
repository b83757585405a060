// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/TriangleMeshBuilder.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/publish/ConcurrentFragmentSource.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

namespace bricks
{

namespace
{

constexpr std::size_t ChunkSize = std::size_t(1) << 16;

/// Beyond this, products of coordinates leave the range of floats; bricks have them in a larger unit.
constexpr double LargestUnscaled = 1e18;

/// The camera and the depth of VTK and OpenGL end soon after this.
constexpr double LargestCoordinate = 1e30;

/// Memory for each triangle of a rank's own piece during sorting, in bytes.
constexpr double OwnTriangleBytes = 32.0;

/// Summary of a rank's piece, for all ranks.
struct PieceSummary
{
  std::uint64_t Triangles = 0;
  MeshAttributes Attributes;
};

struct Bounds
{
  glm::dvec3 Lower{ std::numeric_limits<double>::infinity() };
  glm::dvec3 Upper{ -std::numeric_limits<double>::infinity() };

  void Add(const Bounds& other)
  {
    this->Lower = glm::min(this->Lower, other.Lower);
    this->Upper = glm::max(this->Upper, other.Upper);
  }
};

} // namespace

TriangleMeshBuilder::TriangleMeshBuilder(std::string_view what, const TriangleSource& source,
  const TriangleMeshSettings& settings, dsm::Messenger& messenger)
  : What(what)
  , Source(source)
  , Settings(settings)
  , Messages(messenger)
{
  this->Settings.Threads = std::max(settings.Threads, 1);
  this->AgreeOnPieces();
  this->CheckMemory();
  this->FindBounds();
  // Halving a cell that is too large leaves cells that are seven tenths full on the average.
  this->LargestTriangles = static_cast<std::uint32_t>(
    std::clamp(1.4 * this->Settings.BrickBytes / this->EstimateBrickBytesPerTriangle(), 1.0,
      static_cast<double>(TriangleBrickHeader::LargestTriangles)));
  this->Reader.emplace(
    this->Source, this->Mesh->Attributes, &this->Mesh->Origin.x, this->Mesh->Scale);
  this->Cells.emplace(
    *this->Reader, this->Order, this->LargestTriangles, this->Settings.Threads, this->Messages);
  std::uint64_t kept = 0;
  for (std::uint64_t cell = 0; cell < this->Cells->GetCount(); ++cell)
  {
    kept += this->Cells->GetPrimitiveCount(cell);
  }
  this->Mesh->Dropped = this->Mesh->Triangles - kept;
  this->Mesh->Triangles = kept;
}

void TriangleMeshBuilder::AgreeOnPieces()
{
  const auto pieces = this->Messages.GatherValueTogether(this->What,
    [&]
    {
      this->Mesh = std::make_shared<TriangleMesh>();
      return PieceSummary{ this->Source.GetTriangleCount(), this->Source.GetAttributes() };
    });
  int first = -1;
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    this->Mesh->Triangles += pieces[rank].Triangles;
    if (pieces[rank].Triangles == 0)
    {
      continue;
    }
    if (first < 0)
    {
      first = static_cast<int>(rank);
      this->Mesh->Attributes = pieces[rank].Attributes;
    }
    if (pieces[rank].Attributes != this->Mesh->Attributes)
    {
      throw dsm::Error(std::string(this->What) + ": The pieces of the mesh on ranks " +
        std::to_string(first) + " and " + std::to_string(rank) +
        " differ in their normals, values, colors, texture coordinates or edge flags. All pieces "
        "must have the same arrays.");
    }
  }
}

double TriangleMeshBuilder::EstimateBrickBytesPerTriangle() const
{
  // A scanned surface has half as many points as triangles, and some are in several bricks.
  constexpr double verticesPerTriangle = 0.6;
  constexpr double nodeBytes = 5.0;
  const MeshAttributes& has = this->Mesh->Attributes;
  const auto bytesOf = [](Attachment attachment, double bytes)
  {
    return attachment == Attachment::None
      ? 0.0
      : bytes * (attachment == Attachment::Points ? verticesPerTriangle : 1.0);
  };
  return nodeBytes + 3 * sizeof(std::uint16_t) + verticesPerTriangle * sizeof(TriangleBrickVertex) +
    bytesOf(has.Values, 4.0) + bytesOf(has.Colors, 4.0) +
    bytesOf(has.TextureCoordinates ? Attachment::Points : Attachment::None, 8.0);
}

void TriangleMeshBuilder::CheckMemory()
{
  const int ranksOnHost = this->Messages.GetRanksOnHost();
  this->Messages.RunTogether(this->What,
    [&]
    {
      const std::uint64_t available = this->Settings.MemoryBytes > 0
        ? this->Settings.MemoryBytes
        : dsm::GetAvailableHostMemory() / static_cast<std::uint64_t>(ranksOnHost);
      const double own = OwnTriangleBytes * static_cast<double>(this->Source.GetTriangleCount());
      const double each = static_cast<double>(TriangleRecord(this->Mesh->Attributes).GetBytes()) +
        this->EstimateBrickBytesPerTriangle();
      const auto all = static_cast<double>(this->Mesh->Triangles);
      const double share = all * each / this->Messages.GetSize();
      if (own + share > static_cast<double>(available))
      {
        throw dsm::Error("The mesh has " + std::to_string(this->Mesh->Triangles) +
          " triangles. To cut them into bricks, this rank needs about " +
          dsm::FormatMebibytes(static_cast<std::uint64_t>(own + share)) + ", but has " +
          dsm::FormatMebibytes(available) + ". Use at least " +
          std::to_string(static_cast<std::uint64_t>(
            std::ceil(all * (OwnTriangleBytes + each) / static_cast<double>(available)))) +
          " ranks with as much memory, each with a part of the mesh, or a mesh with fewer "
          "triangles.");
      }
    });
}

void TriangleMeshBuilder::FindBounds()
{
  Bounds mine;
  this->Messages.RunTogether(this->What,
    [&]
    {
      std::vector<Bounds> ofThread(this->Settings.Threads);
      ParallelForChunks(this->Settings.Threads, this->Source.GetTriangleCount(), ChunkSize,
        [&](std::size_t begin, std::size_t end, std::size_t, int thread)
        {
          Bounds bounds;
          for (std::size_t triangle = begin; triangle < end; ++triangle)
          {
            double positions[9];
            if (TriangleReader::ReadPositions(this->Source, triangle, positions))
            {
              for (int corner = 0; corner < 3; ++corner)
              {
                const double* p = positions + 3 * corner;
                const glm::dvec3 point(p[0], p[1], p[2]);
                bounds.Add({ point, point });
              }
            }
          }
          ofThread[thread].Add(bounds);
        });
      for (const Bounds& bounds : ofThread)
      {
        mine.Add(bounds);
      }
    });
  Bounds all;
  for (const Bounds& bounds : this->Messages.AllGatherValue(mine))
  {
    all.Add(bounds);
  }
  if (all.Lower.x <= all.Upper.x)
  {
    this->SetOrigin(all.Lower, all.Upper);
  }
}

void TriangleMeshBuilder::SetOrigin(const glm::dvec3& lower, const glm::dvec3& upper)
{
  const glm::dvec3 size = upper - lower;
  const double extent = std::max({ size.x, size.y, size.z });
  double farthest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    farthest = std::max({ farthest, std::abs(lower[axis]), std::abs(upper[axis]) });
  }
  if (farthest > LargestCoordinate)
  {
    char size[32];
    std::snprintf(size, sizeof(size), "%g", farthest);
    throw dsm::Error(std::string(this->What) + ": The mesh has a coordinate of size " + size +
      "; the maximum is 1e30. Scale the dataset or remove the point.");
  }
  if (farthest > LargestUnscaled)
  {
    this->Mesh->Scale = std::exp2(std::ceil(std::log2(farthest / LargestUnscaled)));
  }
  const double perUnit = 1.0 / this->Mesh->Scale;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double middle = 0.5 * lower[axis] + 0.5 * upper[axis];
    if (extent > 0.0 && std::abs(middle) > 4.0 * extent)
    {
      const double unit = std::exp2(std::ceil(std::log2(extent)));
      this->Mesh->Origin[axis] = std::round(middle / unit) * unit;
    }
  }
  float corner[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    corner[axis] = static_cast<float>((lower[axis] - this->Mesh->Origin[axis]) * perUnit);
    this->Mesh->Lower[axis] = corner[axis];
    this->Mesh->Upper[axis] =
      static_cast<float>((upper[axis] - this->Mesh->Origin[axis]) * perUnit);
  }
  this->Order = MortonCode(corner, extent * perUnit);
}

std::unique_ptr<dsm::FragmentSource> TriangleMeshBuilder::CreateRecordSource() const
{
  std::vector<std::unique_ptr<dsm::FragmentSource>> sources;
  const std::uint64_t threads = static_cast<std::uint64_t>(this->Settings.Threads);
  const std::uint64_t cells = this->Cells->GetCount();
  for (std::uint64_t thread = 0; thread < threads; ++thread)
  {
    sources.push_back(std::make_unique<RecordSource>(
      *this->Reader, *this->Cells, cells * thread / threads, cells * (thread + 1) / threads));
  }
  return std::make_unique<dsm::ConcurrentFragmentSource>(std::move(sources));
}

void TriangleMeshBuilder::BuildBricks(dsm::FunctionRef<void(double)> progress)
{
  BricksOfCells bricks;
  {
    std::unique_ptr<dsm::FragmentSource> source;
    this->Messages.RunTogether(this->What, [&] { source = this->CreateRecordSource(); });
    const RecordBlocks records(
      this->What, *this->Cells, *this->Reader, *source, this->Messages, progress);
    this->Messages.RunTogether(this->What, [&] { bricks = this->BuildOwnBricks(records); });
  }
  this->GatherBricks(std::move(bricks));
  this->Cells.reset();
}

TriangleMeshBuilder::BricksOfCells TriangleMeshBuilder::BuildOwnBricks(const RecordBlocks& records)
{
  BricksOfCells bricks(records.GetCount());
  std::vector<TriangleBrickBuilder> builders(this->Settings.Threads,
    TriangleBrickBuilder(this->Mesh->Attributes, this->Order, this->LargestTriangles));
  ParallelFor(this->Settings.Threads, bricks.size(),
    [&](std::size_t index, int thread)
    {
      bricks[index] = builders[thread].Build(
        records.GetRecords(index), this->Cells->GetPrimitiveCount(records.GetCell(index)));
    });
  return bricks;
}

void TriangleMeshBuilder::GatherBricks(BricksOfCells bricksOfCells)
{
  const auto all = this->Messages.GatherTogether(this->What,
    [&]
    {
      std::vector<std::byte> mine;
      for (const auto& bricks : bricksOfCells)
      {
        for (std::size_t index = 0; index < bricks.size(); ++index)
        {
          BrickSummary summary{};
          float lower[4];
          float upper[4];
          bricks[index].Bounds.Lower.Store(lower);
          bricks[index].Bounds.Upper.Store(upper);
          std::copy_n(lower, 3, summary.Lower);
          std::copy_n(upper, 3, summary.Upper);
          summary.Bytes = static_cast<std::uint32_t>(bricks[index].Bytes.size());
          summary.Following = static_cast<std::uint32_t>(bricks.size() - 1 - index);
          const auto* bytes = reinterpret_cast<const std::byte*>(&summary);
          mine.insert(mine.end(), bytes, bytes + sizeof(summary));
        }
      }
      return mine;
    });

  // Cells in order, and of each the bricks in order: the same numbers on every rank.
  this->Messages.RunTogether(this->What,
    [&]
    {
      const dsm::RoundRobinAssigner assigner(this->Messages.GetSize());
      std::vector<std::size_t> next(all.size(), 0);
      std::vector<BoundingBox> boxes;
      std::vector<dsm::Fragment> ownBricks;
      std::size_t own = 0;
      for (std::uint64_t cell = 0; cell < this->Cells->GetCount(); ++cell)
      {
        const auto owner = static_cast<std::size_t>(assigner.GetOwner(cell));
        const bool isOwn = static_cast<int>(owner) == this->Messages.GetRank();
        BrickSummary summary{};
        std::size_t index = 0;
        do
        {
          if (next[owner] + sizeof(summary) > all[owner].size())
          {
            throw dsm::Error("Rank " + std::to_string(owner) +
              " did not build all its bricks. Do all ranks run the same build?");
          }
          std::memcpy(&summary, all[owner].data() + next[owner], sizeof(summary));
          next[owner] += sizeof(summary);
          if (isOwn)
          {
            ownBricks.push_back(
              { this->BrickBytes.size(), std::move(bricksOfCells[own][index++].Bytes) });
          }
          const float lower[4] = { summary.Lower[0], summary.Lower[1], summary.Lower[2], 0.0f };
          const float upper[4] = { summary.Upper[0], summary.Upper[1], summary.Upper[2], 0.0f };
          boxes.push_back({ Float4::Load(lower), Float4::Load(upper) });
          this->BrickBytes.push_back(summary.Bytes);
        } while (summary.Following > 0);
        own += isOwn ? 1 : 0;
      }
      this->Mesh->Bricks = BrickBvh(boxes);
      this->Bricks = std::make_unique<BlockSource>(std::move(ownBricks));
    });
}

dsm::BlockDirectory TriangleMeshBuilder::TakeBrickDirectory()
{
  return { std::move(this->BrickBytes), dsm::RoundRobinAssigner(this->Messages.GetSize()),
    this->Mesh->Bricks.GetBytes() };
}

} // namespace bricks
