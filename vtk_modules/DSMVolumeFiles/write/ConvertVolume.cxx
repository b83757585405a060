// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/write/ConvertVolume.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/cache/ChunkCache.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <system_error>
#include <utility>

namespace vol
{

namespace
{

std::vector<std::size_t> FindArrays(const VolumeFile& from, const std::vector<std::string>& names)
{
  std::vector<std::size_t> found;
  for (std::size_t number = 0; number < from.GetArrays().size(); ++number)
  {
    const FileArray& array = from.GetArrays()[number];
    if (names.empty() ? !array.IsOffered
                      : std::find(names.begin(), names.end(), array.Name) != names.end())
    {
      found.push_back(number);
    }
  }
  for (const std::string& name : names)
  {
    if (std::none_of(found.begin(), found.end(),
          [&](std::size_t number) { return from.GetArrays()[number].Name == name; }))
    {
      throw FileError(from.GetPath(), "has no array '" + name + "'.");
    }
  }
  return found;
}

/// Throws if the target would overwrite one of the source files, or lies in a source folder.
void CheckTarget(const VolumeFile& from, int step, const std::string& path)
{
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path whole = fs::weakly_canonical(path, none);
  for (const std::string& origin : from.GetFiles(step))
  {
    bool isIn = fs::equivalent(origin, path, none);
    fs::path folder = whole;
    while (!isIn && fs::is_directory(origin, none) && folder.has_relative_path())
    {
      folder = folder.parent_path();
      isIn = fs::equivalent(origin, folder, none);
    }
    if (isIn)
    {
      throw FileError(path,
        "would overwrite the source: the values of '" + from.GetPath() + "' come from '" + origin +
          "'. Choose another name.");
    }
  }
}

/// One step of a file, which every rank reads by itself.
class FileOrigin final : public ValueOrigin
{
public:
  FileOrigin(std::shared_ptr<const VolumeFile> file, const ConvertOptions& options,
    dsm::Messenger& messenger)
    : File(std::move(file))
    , Numbers(FindArrays(*this->File, options.Arrays))
    , Step(options.Step)
    , Messenger(messenger)
    , Threads(options.Threads)
    , Cache(options.MemoryBytes / 2)
  {
    if (this->Step < 0 || this->Step >= this->File->GetSteps())
    {
      throw FileError(this->File->GetPath(),
        "has no step " + std::to_string(this->Step) + "; valid steps are 0 to " +
          std::to_string(this->File->GetSteps() - 1) + ".");
    }
    if (!this->File->IsEvenlySpaced())
    {
      throw FileError(this->File->GetPath(),
        "has coordinates that are not evenly spaced, which a brick file cannot have. Use --spacing "
        "(and --origin) to place the samples evenly.");
    }
    for (const std::size_t number : this->Numbers)
    {
      this->Arrays.push_back(this->File->GetArrays()[number]);
    }
  }

  const FileGeometry& GetGeometry() const override { return this->File->GetGeometry(); }
  const std::vector<FileArray>& GetArrays() const override { return this->Arrays; }
  std::string Describe() const override
  {
    std::string text = this->File->GetPath() + " " + std::to_string(this->File->GetStamp()) +
      " step " + std::to_string(this->Step);
    for (const FileArray& array : this->Arrays) // the written arrays may have other names
    {
      text += " " + array.Name;
    }
    return text;
  }

  /// Each rank gets such as lie beside one another.
  std::vector<int> Deal(std::size_t array, const std::vector<bricks::Box>& boxes) override
  {
    const auto count = static_cast<std::size_t>(this->Messenger.GetSize());
    std::vector<int> ranks(boxes.size());
    for (std::size_t box = 0; box < boxes.size(); ++box)
    {
      ranks[box] = static_cast<int>(box * count / boxes.size());
    }
    this->Messenger.RunTogether(
      "Reading large chunks of a file", [&] { this->Gather(array, boxes, ranks); });
    return ranks;
  }
  void Read(std::size_t array, const bricks::Box& box, std::byte* out) const override
  {
    const auto gathered = this->Gathered.find(GetKey(box));
    if (gathered != this->Gathered.end())
    {
      std::copy(gathered->second.begin(), gathered->second.end(), out);
      return;
    }
    this->Cache.ReadBox({ this->File, this->Numbers[array], this->Step }, box, out);
  }

private:
  using Key = std::array<std::int64_t, 3>;
  static Key GetKey(const bricks::Box& box) { return { box.Min.x, box.Min.y, box.Min.z }; }

  /// If the cache cannot hold the chunks that a box lies in, all boxes of this rank are read chunk
  /// by chunk.
  void Gather(
    std::size_t array, const std::vector<bricks::Box>& boxes, const std::vector<int>& ranks)
  {
    this->Gathered.clear();
    const bricks::Index3 size = boxes.front().GetSize();
    const std::size_t sampleBytes = this->Arrays[array].GetSampleBytes();
    if (ChunkCache::CountBytesTogether(this->Arrays[array], std::max({ size.x, size.y, size.z })) <=
      this->Cache.GetLimit())
    {
      return;
    }
    std::vector<bricks::Box> mine;
    std::vector<std::byte*> outs;
    for (std::size_t box = 0; box < boxes.size(); ++box)
    {
      if (ranks[box] == this->Messenger.GetRank())
      {
        ByteBuffer& samples = this->Gathered[GetKey(boxes[box])];
        samples.resize(static_cast<std::size_t>(boxes[box].GetCount()) * sampleBytes);
        mine.push_back(boxes[box]);
        outs.push_back(samples.data());
      }
    }
    this->Cache.ReadBoxes(
      { this->File, this->Numbers[array], this->Step }, mine, outs, this->Threads);
  }

  std::shared_ptr<const VolumeFile> File;
  std::vector<std::size_t> Numbers; ///< in the file
  std::vector<FileArray> Arrays;
  int Step;
  dsm::Messenger& Messenger;
  int Threads;
  mutable ChunkCache Cache;
  std::map<Key, ByteBuffer> Gathered; ///< boxes that were dealt last to this rank
};

/// By the name of another format programs would not open it; and when the names are given the wrong way round, what
/// was to be read would be replaced.
void CheckName(const std::string& path)
{
  const std::string extension = std::filesystem::path(path).extension().string();
  const char* const others[] = { ".mha", ".mhd", ".nhdr", ".nrrd", ".raw", ".vti", ".vtk",
    ".zarr" };
  if (std::count(std::begin(others), std::end(others), extension) > 0)
  {
    throw FileError(path,
      "has the extension of another format, but HDF5 is written. Use .vtkhdf or .h5. Name the file "
      "to read first.");
  }
}

} // namespace

void ConvertVolume(const std::shared_ptr<const VolumeFile>& from, const std::string& path,
  const ConvertOptions& options, dsm::Messenger& messenger, const std::function<void(double)>& tell)
{
  std::unique_ptr<ValueOrigin> origin;
  messenger.RunTogether("Converting a volume",
    [&]
    {
      origin = std::make_unique<FileOrigin>(from, options, messenger);
      CheckTarget(*from, options.Step, path);
      CheckName(path);
    });
  WriteBrickFile(std::move(origin), path, options, messenger, tell);
}

} // namespace vol
