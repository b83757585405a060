// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/open/SeriesFile.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <list>
#include <mutex>
#include <optional>
#include <utility>

namespace vol
{

namespace
{

/// Files that stay open: those of a step, its neighbors, and of who still reads another.
constexpr std::size_t MostOpenSteps = 6;

/// Returns the stamp of the file at a step's path.
std::uint64_t FindStampOfStep(const std::string& path, const OpenOptions& options)
{
  bricks::ByteHash hash;
  hash.Add(path.data(), path.size());
  try
  {
    const std::uint64_t stamp = FindStamp(path, options);
    hash.Add(&stamp, sizeof(stamp));
  }
  catch (const std::exception&) // a missing file is rejected when it is shown
  {
    return hash.Get();
  }
  return hash.Get();
}

/// Returns what the names of the files have in common, but for the numbers of the steps.
std::string NameBySeries(const std::vector<std::string>& paths)
{
  const std::string first = GetStem(paths.front());
  const std::string last = GetStem(paths.back());
  const auto differ = std::mismatch(first.begin(), first.end(), last.begin(), last.end()).first;
  const std::size_t end = std::string(first.begin(), differ).find_last_not_of("0123456789._- ");
  return end == std::string::npos ? first : first.substr(0, end + 1);
}

class SeriesFile final : public VolumeFile
{
public:
  SeriesFile(const std::vector<std::string>& paths, OpenOptions options)
    : VolumeFile(paths.front())
    , Paths(paths)
    , Options(std::move(options))
  {
    const auto first = OpenVolumeFile(this->Path, this->Options);
    this->Options.GoesOn = nullptr; // other threads open the steps, when they are needed
    this->Geometry = first->GetGeometry();
    this->Coordinates = first->GetCoordinates();
    this->Arrays = first->GetArrays();
    if (this->Arrays.size() == 1 && this->Arrays.front().Name == GetStem(this->Path))
    {
      this->Arrays.front().Name = NameBySeries(paths);
    }
    this->Levels = first->GetLevels();
    this->Warnings = first->GetWarnings();
    this->Steps = static_cast<int>(paths.size());
    this->Stamps.resize(paths.size());
    this->Stamps.front() = first->GetStamp();
    this->Open.emplace_back(0, first);
    bricks::ByteHash hash;
    for (const std::string& path : paths)
    {
      const std::uint64_t stamp = FindStampOfStep(path, this->Options);
      hash.Add(&stamp, sizeof(stamp));
    }
    this->Stamp = hash.Get();
  }

  std::vector<std::string> GetPaths() const override { return this->Paths; }

  void ReadChunk(
    std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const override
  {
    this->Get(step)->ReadChunk(array, 0, chunk, out);
  }

  bool ReadPart(std::size_t array, int step, const bricks::Index3& chunk, const bricks::Box& part,
    std::byte* out) const override
  {
    return this->Get(step)->ReadPart(array, 0, chunk, part, out);
  }
  bool ReadWithHalo(
    std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const override
  {
    return this->Get(step)->ReadWithHalo(array, 0, chunk, out);
  }

  bool IsFill(std::size_t array, int step, const bricks::Box& box) const override
  {
    return this->Get(step)->IsFill(array, 0, box);
  }

  void Prefetch(std::size_t array, int step, const std::vector<ChunkPart>& parts) const override
  {
    this->Get(step)->Prefetch(array, 0, parts);
  }

  Index ReadIndex(std::size_t array, int step) const override
  {
    return this->Get(step)->ReadIndex(array, 0);
  }

  std::vector<std::string> GetFiles(int step) const override
  {
    return this->Get(step)->GetFiles(0);
  }

  StepOrigin GetOrigin(int step) const override { return this->Get(step)->GetOrigin(0); }

  std::uint64_t GetTableBytes() const override
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    std::uint64_t most = 0;
    for (const auto& [step, file] : this->Open)
    {
      most = std::max(most, file->GetTableBytes());
    }
    return most * std::min(MostOpenSteps, this->Paths.size());
  }

private:
  std::shared_ptr<const VolumeFile> Get(int step) const
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    const auto known = std::find_if(
      this->Open.begin(), this->Open.end(), [=](const auto& one) { return one.first == step; });
    if (known != this->Open.end())
    {
      this->Open.splice(this->Open.begin(), this->Open, known);
      return known->second;
    }
    const std::string& path = this->Paths[static_cast<std::size_t>(step)];
    const auto file = OpenVolumeFile(path, this->Options);
    this->CheckSame(*file);
    this->CheckUnchanged(*file, this->Stamps[static_cast<std::size_t>(step)]);
    this->Open.emplace_front(step, file);
    if (this->Open.size() > MostOpenSteps)
    {
      this->Open.pop_back();
    }
    return file;
  }

  void CheckSame(const VolumeFile& file) const
  {
    // A single array is often called as its file is.
    const bool onlyOne = this->Arrays.size() == 1;
    const bool same = std::equal(this->Arrays.begin(), this->Arrays.end(), file.GetArrays().begin(),
      file.GetArrays().end(),
      [=](const FileArray& a, const FileArray& b)
      {
        return (onlyOne || a.Name == b.Name) && a.Type == b.Type && a.Components == b.Components &&
          a.OnCells == b.OnCells && a.Grid.Samples == b.Grid.Samples;
      });
    if (!same)
    {
      this->Refuse(file, "its arrays differ. Open it separately.");
    }
    for (std::size_t array = 0; array < this->Arrays.size(); ++array)
    {
      const bricks::Index3 mine = this->Arrays[array].Grid.ChunkSamples;
      const bricks::Index3 other = file.GetArrays()[array].Grid.ChunkSamples;
      if (mine != other)
      {
        this->Refuse(file,
          "its array '" + file.GetArrays()[array].Name + "' has chunks of " + DescribeShape(other) +
            " samples instead of " + DescribeShape(mine) +
            " (large uncompressed chunks count as several). Write all steps with the same chunks "
            "and compression, or open it separately.");
      }
    }
    if (!IsSamePlace(this->Geometry, file.GetGeometry()) ||
      this->Coordinates != file.GetCoordinates())
    {
      this->Refuse(
        file, "its first index, origin, spacing or direction differs. Open it separately.");
    }
  }

  [[noreturn]] void Refuse(const VolumeFile& file, const std::string& why) const
  {
    throw FileError(file.GetPath(),
      "cannot be a time step of the series that starts with '" + this->Path + "': " + why);
  }

  /// Values that were read of it are still about: they must not meet others. `known`: the stamp when it was opened
  /// first, or none yet.
  static void CheckUnchanged(const VolumeFile& file, std::optional<std::uint64_t>& known)
  {
    if (known.value_or(file.GetStamp()) != file.GetStamp())
    {
      throw FileError(file.GetPath(), "changed or was replaced after it was opened. Reload it.");
    }
    known = file.GetStamp();
  }

  std::vector<std::string> Paths;
  OpenOptions Options;
  mutable std::mutex Guard;
  mutable std::vector<std::optional<std::uint64_t>> Stamps; ///< one for each step
  /// Steps and their files, the last used first.
  mutable std::list<std::pair<int, std::shared_ptr<const VolumeFile>>> Open;
};

} // namespace

std::shared_ptr<const VolumeFile> OpenVolumeSeries(
  const std::vector<std::string>& paths, const OpenOptions& options)
{
  if (paths.empty())
  {
    throw dsm::Error("No file name is set.");
  }
  return paths.size() == 1 ? OpenVolumeFile(paths.front(), options)
                           : std::make_shared<SeriesFile>(paths, options);
}

} // namespace vol
