// SPDX-License-Identifier: BSD-3-Clause
// Writes the seeds that only the project's own code can make: for codecs, and for kept files. usage: fuzz_write_seeds
// FOLDER, which gets the folders Codecs and KeptFiles.
#include "CodecInput.h"
#include "KeptVolume.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/HaloRecord.h"
#include "DSMVolumeFiles/range/ValueRanges.h"

#include <cstdio>
#include <fstream>

namespace
{

namespace fs = std::filesystem;

void Write(const fs::path& path, const std::vector<std::uint8_t>& bytes)
{
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
    .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

vol::ByteBuffer MakeSamples(std::size_t count)
{
  vol::ByteBuffer samples(count);
  for (std::size_t at = 0; at < count; ++at)
  {
    samples[at] = static_cast<std::byte>((3 * at + at / 7) % 101);
  }
  return samples;
}

void WriteCodecs(const fs::path& folder)
{
  const std::vector<std::vector<vol::CodecStep>> all = { {}, { { "swap", 4 } },
    { { "shuffle", 8 } }, { { "shuffle", 3 } }, { { "deflate" } }, { { "zstd" } },
    { { "fletcher32" } }, { { "shuffle", 4 }, { "deflate" }, { "fletcher32" } },
    { { "swap", 2 }, { "shuffle", 2 }, { "zstd" } }, { { "deflate" }, { "zstd" } }, { { "blosc" } },
    { { "zstd" }, { "crc32c" } }, { { "lz4" } }, { { "HDF5's lz4" } }, { { "bzip2" } },
    { { "lzma", 1 } }, { { "lzma", 2 } }, { { "lzma", 3 } }, { { "rounded" } },
    { { "astype", 38 } }, { { "delta", 8 }, { "delta", 192 } },
    { { "fixedscaleoffset", 89 }, { "zstd" } } };
  int number = 0;
  for (const std::vector<vol::CodecStep>& steps : all)
  {
    for (const std::size_t halo : { 0, 40 })
    {
      fuzz::CodecInput input;
      input.Steps = steps;
      input.SampleBytes = 322;
      input.HaloBytes = halo;
      const vol::ByteBuffer samples = MakeSamples(input.SampleBytes);
      input.Stored = samples;
      try
      {
        const vol::ChunkCodec codec(steps);
        input.Stored =
          codec.Encode(samples, MakeSamples(codec.KeepsHalo() ? halo : std::size_t(0)));
      }
      catch (const dsm::Error&)
      {
        // A step that is only read: the samples have to do as its bytes.
      }
      Write(folder / std::to_string(number++), input.Write());
    }
  }
  fuzz::CodecInput record;
  record.HaloBytes = 40;
  record.Skipped = 3;
  record.Stored =
    vol::HaloRecord::Make(3, MakeSamples(40), vol::HaloRecord::GetBytes(record.HaloBytes));
  Write(folder / "record", record.Write());
}

template <class T>
void Append(std::vector<std::uint8_t>& bytes, const T* from, std::size_t count)
{
  const auto* const first = reinterpret_cast<const std::uint8_t*>(from);
  bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

void WriteKept(const fs::path& folder)
{
  const fs::path cache = fuzz::GetInputFolder() / "cache";
  setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  const fuzz::KeptVolume volume;
  vol::ValueRanges ranges(1);
  for (auto* list : { &ranges.All, &ranges.Finite })
  {
    list->front().Add(0.0);
    list->front().Add(100.0);
  }
  vol::KeepRanges({ volume.File, 0, 0 }, volume.Whole, ranges);
  for (const auto& entry : fs::directory_iterator(cache / "dsm-ray-tracer"))
  {
    std::ifstream file(entry.path(), std::ios::binary);
    std::vector<std::uint8_t> bytes{ 0 };
    bytes.insert(bytes.end(), std::istreambuf_iterator<char>(file), {});
    Write(folder / "ranges", bytes);
  }
  bricks::VoxelIndex index = volume.MakeIndex(nullptr, 0);
  std::fill(index.Bricks.begin(), index.Bricks.end(), bricks::ValueRange{ 0.0f, 100.0f });
  index.Survey.All = 64;
  index.Survey.Exponent = -2;
  index.Survey.Least = 0.0;
  index.Survey.Greatest = 100.0;
  for (std::size_t interval = 0; interval <= 400; interval += 4)
  {
    index.Survey.Values[interval] = 2;
    index.Survey.Crossed[interval] = 1;
  }
  const std::vector<std::byte> encoded = index.Encode();
  std::vector<std::uint8_t> bytes{ 1 };
  Append(bytes, encoded.data(), encoded.size());
  Write(folder / "index", bytes);
  bytes = { 2 };
  Append(bytes, &index.Survey, 1);
  Append(bytes, index.Bricks.data(), index.Bricks.size());
  Write(folder / "numbers", bytes);
}

} // namespace

int main(int count, char** arguments)
{
  if (count != 2)
  {
    std::fprintf(stderr, "usage: %s FOLDER\n", arguments[0]);
    return 1;
  }
  const fs::path folder = arguments[1];
  WriteCodecs(folder / "Codecs");
  WriteKept(folder / "KeptFiles");
  return 0;
}
