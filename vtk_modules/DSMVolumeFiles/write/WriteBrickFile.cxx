// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/write/WriteBrickFile.h"

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/build/VoxelBrickReader.h"
#include "DSMBricks/build/VoxelIndex.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/CopyBox.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/cache/FileSamples.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/codec/HaloRecord.h"
#include "DSMVolumeFiles/hdf/HdfFile.h"
#include "DSMVolumeFiles/write/PartFiles.h"
#include "DSMVolumeFiles/write/ReducedOrigin.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <optional>
#include <utility>

namespace vol
{

namespace
{

/// A chunk, and which one it is.
using NumberedChunk = std::pair<std::int64_t, EncodedChunk>;

/// Makes the chunks of an array of a brick file.
class ChunkMaker
{
public:
  ChunkMaker(const ValueOrigin& from, const BrickFileLayout& layout, std::size_t array)
    : From(from)
    , Number(array)
    , Array(layout.Arrays[array])
    , Codec(layout.CreateCodec(array))
    , HasHalo(layout.HasHalo(array))
    , HaloRecordBytes(layout.GetHaloRecordBytes(array))
  {
  }

  /// The samples that a chunk is made of: those that the brick that begins here has, so the first ones of its
  /// neighbors, too.
  bricks::Box GetSource(std::int64_t chunk) const
  {
    return this->Array.Grid.GetBoxWithHalo(this->Array.Grid.GetChunk(chunk));
  }

  NumberedChunk Make(std::int64_t chunk, ValueRanges& ranges) const
  {
    const bricks::Index3 place = this->Array.Grid.GetChunk(chunk);
    const bricks::Box own = this->Array.Grid.GetBox(place);
    const bricks::Box have = this->GetSource(chunk);
    const std::size_t sampleBytes = this->Array.GetSampleBytes();
    ByteBuffer samples(static_cast<std::size_t>(have.GetCount()) * sampleBytes);
    this->From.Read(this->Number, have, samples.data());
    ranges.Add(this->Array, samples.data(), have, own);
    EncodedChunk encoded;
    // Chunks at the volume's ends are as large as all others.
    const bricks::Box whole{ own.Min, own.Min + this->Array.Grid.ChunkSamples };
    ByteBuffer bytes(static_cast<std::size_t>(whole.GetCount()) * sampleBytes, std::byte{ 0 });
    CopyBox(own, samples.data(), have, bytes.data(), whole, sampleBytes);
    ByteBuffer halo;
    if (this->HasHalo)
    {
      halo.resize(static_cast<std::size_t>(have.GetCount() - own.GetCount()) * sampleBytes);
      std::byte* to = halo.data();
      for (const bricks::Box& part : this->Array.Grid.GetHalo(place))
      {
        CopyBox(part, samples.data(), have, to, part, sampleBytes);
        to += static_cast<std::size_t>(part.GetCount()) * sampleBytes;
      }
    }
    if (this->HaloRecordBytes > 0)
    {
      encoded.HaloRecord = HaloRecord::Make(chunk, std::exchange(halo, {}), this->HaloRecordBytes);
    }
    encoded.Bytes = this->Codec.Encode(std::move(bytes), std::move(halo));
    return { chunk, std::move(encoded) };
  }

private:
  const ValueOrigin& From;
  std::size_t Number;
  FileArray Array;
  ChunkCodec Codec;
  bool HasHalo;
  std::size_t HaloRecordBytes;
};

/// Serializes a rank's results for rank 0.
template <class T>
void Put(std::vector<std::byte>& bytes, const T* values, std::size_t count)
{
  const auto* const first = reinterpret_cast<const std::byte*>(values);
  bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

class Taker
{
public:
  explicit Taker(const std::vector<std::byte>& bytes)
    : Bytes(bytes)
  {
  }
  bool IsAtEnd() const { return this->At == this->Bytes.size(); }
  template <class T>
  void Take(T* values, std::size_t count)
  {
    this->Check(count, sizeof(T));
    std::memcpy(values, this->Bytes.data() + this->At, count * sizeof(T));
    this->At += count * sizeof(T);
  }
  /// Throws dsm::Error where fewer values are left.
  void Check(std::uint64_t count, std::size_t bytes) const
  {
    if (count > (this->Bytes.size() - this->At) / bytes)
    {
      throw dsm::Error(
        "A message with chunks of a brick file is truncated. Do all ranks run the same build?");
    }
  }

private:
  const std::vector<std::byte>& Bytes;
  std::size_t At = 0;
};

std::vector<std::byte> ToBytes(const std::vector<NumberedChunk>& chunks, const ValueRanges& ranges)
{
  std::size_t count = 2 * ranges.All.size() * sizeof(ValueRange);
  for (const auto& [number, chunk] : chunks)
  {
    count +=
      sizeof(number) + 2 * sizeof(std::uint64_t) + chunk.Bytes.size() + chunk.HaloRecord.size();
  }
  std::vector<std::byte> bytes;
  bytes.reserve(count); // they are up to an eighth of the memory
  for (const std::vector<ValueRange>* list : { &ranges.All, &ranges.Finite })
  {
    Put(bytes, list->data(), list->size());
  }
  for (const auto& [number, chunk] : chunks)
  {
    Put(bytes, &number, 1);
    for (const ByteBuffer* const part : { &chunk.Bytes, &chunk.HaloRecord })
    {
      const std::uint64_t count = part->size();
      Put(bytes, &count, 1);
      Put(bytes, part->data(), part->size());
    }
  }
  return bytes;
}

void FromBytes(
  const std::vector<std::byte>& bytes, std::vector<NumberedChunk>& chunks, ValueRanges& ranges)
{
  Taker from(bytes);
  ValueRanges part = ranges;
  for (std::vector<ValueRange>* list : { &part.All, &part.Finite })
  {
    from.Take(list->data(), list->size());
  }
  ranges.Add(part);
  while (!from.IsAtEnd())
  {
    auto& [number, chunk] = chunks.emplace_back();
    from.Take(&number, 1);
    for (ByteBuffer* const part : { &chunk.Bytes, &chunk.HaloRecord })
    {
      std::uint64_t count = 0;
      from.Take(&count, 1);
      from.Check(count, 1);
      part->resize(count);
      from.Take(part->data(), count);
    }
  }
}

/// Merges the results of all ranks, in the file's order.
std::vector<EncodedChunk> Merge(
  const std::vector<std::vector<std::byte>>& parts, ValueRanges& ranges)
{
  std::vector<NumberedChunk> all;
  for (const std::vector<std::byte>& part : parts)
  {
    FromBytes(part, all, ranges);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<EncodedChunk> chunks;
  for (auto& [number, chunk] : all)
  {
    chunks.push_back(std::move(chunk));
  }
  return chunks;
}

/// HDF5 takes '/' for a folder, and "." for the folder itself.
std::string MakeLinkName(std::string name)
{
  if (name.size() > FileLimits::NameBytes)
  {
    throw dsm::Error("The name of an array has " + std::to_string(name.size()) +
      " bytes; at most " + std::to_string(FileLimits::NameBytes) +
      " can be written. It begins with '" + name.substr(0, 100) + "'.");
  }
  std::replace(name.begin(), name.end(), '/', '_');
  return name.empty() || name == "." ? "_" : name;
}

BrickFileLayout CreateLayout(const ValueOrigin& from, const WriteOptions& options)
{
  BrickFileLayout layout;
  layout.Geometry = from.GetGeometry();
  layout.Pressed = options.Pressed;
  layout.HasHaloRecords = options.HasHaloRecords;
  layout.BrickEdge = options.BrickEdge != 0
    ? options.BrickEdge
    : bricks::BrickLattice(glm::max(from.GetArrays().front().Grid.Samples, bricks::Index3(2)),
        from.GetArrays().front().Type, /*cellMask=*/false)
        .GetEdge();
  if (layout.BrickEdge < 1 || layout.BrickEdge > bricks::BrickLattice::LargestEdge)
  {
    throw dsm::Error("A brick must have 1 to " + std::to_string(bricks::BrickLattice::LargestEdge) +
      " cells along an axis, not " + std::to_string(layout.BrickEdge) + ".");
  }
  for (FileArray array : from.GetArrays())
  {
    const std::string name = array.Name;
    array.Name = MakeLinkName(name);
    const auto same = std::find_if(layout.Arrays.begin(), layout.Arrays.end(),
      [&](const FileArray& one) { return one.Name == array.Name && one.OnCells == array.OnCells; });
    if (same != layout.Arrays.end())
    {
      const auto before = static_cast<std::size_t>(same - layout.Arrays.begin());
      throw dsm::Error("The arrays '" + from.GetArrays()[before].Name + "' and '" + name +
        "' would both be named '" + array.Name + "'. Omit or rename one.");
    }
    array.Grid.ChunkSamples = glm::min(bricks::Index3(layout.BrickEdge), array.Grid.Samples);
    layout.Arrays.push_back(std::move(array));
  }
  return layout;
}

/// Collective. Makes the indices of the bricks of a brick file's arrays, for which it reads the file once more.
/// Arrays that the renderer cannot show get no index.
std::vector<std::vector<std::byte>> FindIndices(const std::string& path,
  const BrickFileLayout& layout, const WriteOptions& options, dsm::Messenger& messenger,
  const std::function<void(double)>& tell)
{
  const char* const what = "Indexing the bricks";
  // It holds the file open, which cannot be written until no rank does.
  ChunkCache cache(options.MemoryBytes / 2);
  std::shared_ptr<const VolumeFile> file;
  messenger.RunTogether(what, [&] { file = OpenHdf(path); });
  std::vector<std::vector<std::byte>> indices(layout.Arrays.size());
  const bricks::Index3& points = layout.Geometry.Points;
  const bool hasCells = points.x > 1 && points.y > 1 && points.z > 1;
  for (std::size_t number = 0; number < indices.size(); ++number)
  {
    const FileArray& array = layout.Arrays[number];
    if (!hasCells || array.OnCells || array.Components != 1)
    {
      continue;
    }
    std::optional<bricks::BrickLattice> lattice;
    std::shared_ptr<const dsm::BlockReader> reader;
    bricks::VoxelIndex::Pass pass;
    messenger.RunTogether(what,
      [&]
      {
        const auto& arrays = file->GetArrays();
        const auto found = std::find_if(arrays.begin(), arrays.end(),
          [&](const FileArray& one) { return one.Name == array.Name && !one.OnCells; });
        if (found == arrays.end() || found->Type != array.Type || found->Components != 1)
        {
          throw FileError(path, "is missing the array '" + array.Name + "' that was written.");
        }
        lattice.emplace(points, array.Type, false, layout.BrickEdge);
        reader = std::make_shared<bricks::VoxelBrickReader>(*lattice,
          std::make_shared<FileSamples>(
            ArrayStep{ file, static_cast<std::size_t>(found - arrays.begin()), 0 }, cache));
        pass.Order.resize(lattice->GetBrickCount());
        std::iota(pass.Order.begin(), pass.Order.end(), dsm::BlockId(0));
        pass.Threads = options.Threads;
      });
    const bricks::VoxelIndex index = bricks::VoxelIndex::Find(messenger, *lattice, *reader, pass,
      [&](double part)
      {
        if (messenger.GetRank() == 0)
        {
          tell((static_cast<double>(number) + part) / static_cast<double>(indices.size()));
        }
      });
    messenger.RunTogether(what, [&] { indices[number] = index.Encode(); });
  }
  return indices;
}

/// Collective. Adds the chunks of an array from `done` on; `writer` on rank 0.
void WriteArray(ValueOrigin& from, const BrickFileLayout& layout, std::size_t array,
  std::int64_t done, BrickFileWriter* writer, const WriteOptions& options,
  dsm::Messenger& messenger, const std::function<void(double)>& tell)
{
  const char* const what = "Writing a brick file";
  const FileArray& made = layout.Arrays[array];
  std::optional<ChunkMaker> maker;
  messenger.RunTogether(what, [&] { maker.emplace(from, layout, array); });
  const std::int64_t count = made.Grid.GetCount();
  const auto chunkBytes = static_cast<std::size_t>(
    bricks::Box{ bricks::Index3(0), made.Grid.ChunkSamples }.GetCount() * made.GetSampleBytes());
  const std::int64_t share =
    std::max<std::int64_t>(1, static_cast<std::int64_t>(options.MemoryBytes / 8 / chunkBytes));
  while (done < count)
  {
    const std::int64_t last = std::min(count, done + share);
    std::vector<bricks::Box> boxes;
    messenger.RunTogether(what,
      [&]
      {
        for (std::int64_t chunk = done; chunk < last; ++chunk)
        {
          boxes.push_back(maker->GetSource(chunk));
        }
      });
    const std::vector<int> ranks = from.Deal(array, boxes);
    const auto parts = messenger.GatherOnRankZero(what,
      [&]
      {
        std::vector<std::int64_t> mine;
        for (std::int64_t chunk = done; chunk < last; ++chunk)
        {
          if (ranks[static_cast<std::size_t>(chunk - done)] == messenger.GetRank())
          {
            mine.push_back(chunk);
          }
        }
        std::vector<NumberedChunk> chunks(mine.size());
        std::vector<ValueRanges> ranges(
          static_cast<std::size_t>(options.Threads), ValueRanges(made.Components));
        bricks::ParallelFor(options.Threads, mine.size(),
          [&](std::size_t index, int thread)
          { chunks[index] = maker->Make(mine[index], ranges[static_cast<std::size_t>(thread)]); });
        for (const ValueRanges& part : ranges)
        {
          ranges.front().Add(part);
        }
        return ToBytes(chunks, ranges.front());
      });
    done = last;
    messenger.RunTogether(what,
      [&]
      {
        if (writer)
        {
          ValueRanges ranges(made.Components);
          const std::vector<EncodedChunk> chunks = Merge(parts, ranges);
          writer->Add(array, chunks, ranges);
          tell(static_cast<double>(done) / static_cast<double>(count));
        }
      });
  }
}

/// Collective. Writes the coarser levels of the brick file that a writer has closed, each of the one before, to
/// files of their own. Those that an earlier call has written are kept. Returns how many there are.
int WriteLevels(const std::string& path, const BrickFileLayout& layout, const std::string& source,
  const WriteOptions& options, dsm::Messenger& messenger, const std::function<void(double)>& tell)
{
  const char* const what = "Writing coarser levels";
  WriteOptions one = options;
  one.BrickEdge = layout.BrickEdge;
  one.Levels = 0;
  one.HasHaloRecords = false;
  std::string last = PartFiles::GetPart(path);
  for (int level = 1; level <= options.Levels; ++level)
  {
    // Each takes an eighth of the one before.
    const double begin = 1.0 - std::pow(8.0, 1 - level);
    const double share = 1.0 - begin - std::pow(8.0, -level);
    const std::string next = PartFiles::GetLevel(path, level);
    std::unique_ptr<ReducedOrigin> origin;
    bool isThere = false;
    bool isLast = false;
    messenger.RunTogether(what,
      [&]
      {
        const auto file = OpenHdf(last);
        const bricks::Index3& points = file->GetGeometry().Points;
        isLast = std::max({ points.x, points.y, points.z }) <= layout.BrickEdge + 1 ||
          !ReducedOrigin::CanReduce(file->GetGeometry());
        isThere = messenger.GetRank() == 0 && std::filesystem::exists(next);
        origin = std::make_unique<ReducedOrigin>(file, source + " level " + std::to_string(level),
          messenger.GetSize(), options.MemoryBytes / 2);
      });
    if (isLast)
    {
      return level - 1;
    }
    if (messenger.AllGatherValue(std::uint8_t(isThere ? 1 : 0)).front() == 0)
    {
      WriteBrickFile(
        std::move(origin), next, one, messenger, [&](double part) { tell(begin + share * part); });
    }
    last = next;
  }
  return options.Levels;
}

} // namespace

void WriteBrickFile(std::unique_ptr<ValueOrigin> from, const std::string& path,
  const WriteOptions& options, dsm::Messenger& messenger, const std::function<void(double)>& tell)
{
  const char* const what = "Writing a brick file";
  BrickFileLayout layout;
  std::string source;
  std::unique_ptr<BrickFileWriter> writer;
  std::vector<std::int64_t> begin;
  messenger.RunTogether(what,
    [&]
    {
      layout = CreateLayout(*from, options);
      source = from->Describe();
      begin.assign(layout.Arrays.size(), 0);
      if (messenger.GetRank() == 0)
      {
        writer = BrickFileWriter::Make(path, layout, source,
          options.IsResumable ? BrickFileWriter::Unfinished::Keep
                              : BrickFileWriter::Unfinished::Remove);
        for (std::size_t array = 0; array < begin.size(); ++array)
        {
          begin[array] = writer->GetChunks(array);
        }
      }
    });
  // Writing first, then looking through the bricks, and then, an eighth as long, the coarser levels.
  const double finest = options.Levels > 0 ? 0.875 : 1.0;
  const auto tellHalf = [&](double half, double part) { tell(0.5 * finest * (half + part)); };
  const auto arrays = static_cast<double>(begin.size());
  for (std::size_t array = 0; array < begin.size(); ++array)
  {
    const std::int64_t done = messenger.AllGatherValue(begin[array]).front();
    WriteArray(*from, layout, array, done, writer.get(), options, messenger,
      [&](double part) { tellHalf(0.0, (static_cast<double>(array) + part) / arrays); });
  }
  from.reset(); // and its memory
  messenger.RunTogether(what,
    [&]
    {
      if (writer)
      {
        writer->Close();
      }
    });
  std::vector<std::vector<std::byte>> indices;
  const std::string part = PartFiles::GetPart(path);
  try
  {
    indices =
      FindIndices(part, layout, options, messenger, [&](double done) { tellHalf(1.0, done); });
  }
  catch (const dsm::Error& error) // the same on every rank
  {
    throw dsm::Error(error.what() + (" If '" + part + "' is damaged, delete it and start again."));
  }
  const int levels = WriteLevels(path, layout, source, options, messenger,
    [&](double part) { tell(finest + (1.0 - finest) * part); });
  messenger.Barrier();
  messenger.RunTogether(what,
    [&]
    {
      if (writer)
      {
        writer->Finish(indices, levels);
      }
    });
}

} // namespace vol
