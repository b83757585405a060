// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/range/KeptFile.h"

#include "DSMRayTracing/base/ByteHash.h"

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <sstream>

#include <unistd.h>

namespace vol
{

namespace
{

/// What nobody has used for so long is of a file that has changed, or is gone.
constexpr auto LongestUnused = std::chrono::hours(24) * 180;

void RemoveUnused(const std::filesystem::path& folder)
{
  std::error_code failure;
  const auto now = std::filesystem::file_time_type::clock::now();
  for (auto entry = std::filesystem::directory_iterator(folder, failure);
       !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure))
  {
    std::error_code unknown;
    const auto used = entry->last_write_time(unknown);
    if (!unknown && now - used > LongestUnused)
    {
      std::filesystem::remove(entry->path(), unknown);
    }
  }
}

/// What the names of files that are kept of an array begin with, the folder included; empty where there is no folder.
std::filesystem::path GetBeginning(
  const VolumeFile& file, std::size_t array, int step, const std::string& kind)
{
  const char* const caches = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  if (!(caches && *caches) && !(home && *home))
  {
    return {};
  }
  const std::filesystem::path folder =
    caches && *caches ? std::filesystem::path(caches) : std::filesystem::path(home) / ".cache";
  std::error_code failure;
  const VolumeFile::StepOrigin origin = file.GetOrigin(step);
  const std::string path = std::filesystem::absolute(origin.Path, failure).string();
  const FileArray& kept = file.GetArrays()[array];
  const rt::Index3& samples = kept.Grid.Samples; // another level of detail has fewer
  const std::int64_t numbers[] = { static_cast<std::int64_t>(origin.Stamp),
    static_cast<std::int64_t>(array), origin.Step, samples.x, samples.y, samples.z };
  rt::ByteHash hash;
  hash.Add(path.data(), path.size());
  hash.Add(kept.Name.data(), kept.Name.size());
  hash.Add(kind.data(), kind.size());
  hash.Add(numbers, sizeof(numbers));
  return folder / "dsm-ray-tracer" / (kind + "-" + std::to_string(hash.Get()) + "-");
}

/// The box's six numbers, with nothing behind them.
std::string Write(const rt::Box& box)
{
  std::string text;
  for (const rt::Index3& corner : { box.Min, box.Max })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      text += (text.empty() ? "" : "_") + std::to_string(corner[axis]);
    }
  }
  return text;
}

std::optional<rt::Box> ReadBox(const std::string& text)
{
  rt::Box box;
  std::istringstream stream(text);
  for (rt::Index3* corner : { &box.Min, &box.Max })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      char between = '_';
      stream >> (*corner)[axis] && stream.get(between);
    }
  }
  return Write(box) == text ? std::optional<rt::Box>(box) : std::nullopt;
}

} // namespace

KeptFile::KeptFile(
  const VolumeFile& file, std::size_t array, int step, const rt::Box& box, const std::string& kind)
  : Path(GetBeginning(file, array, step, kind).string())
{
  if (!this->Path.empty())
  {
    this->Path += Write(box);
  }
}

std::vector<rt::Box> KeptFile::FindBoxes(
  const VolumeFile& file, std::size_t array, int step, const std::string& kind)
{
  std::vector<rt::Box> boxes;
  const std::filesystem::path beginning = GetBeginning(file, array, step, kind);
  const std::string name = beginning.filename().string();
  std::error_code failure; // such as no folder
  for (auto entry = std::filesystem::directory_iterator(beginning.parent_path(), failure);
       !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure))
  {
    const std::string kept = entry->path().filename().string();
    if (kept.compare(0, name.size(), name) == 0)
    {
      if (const std::optional<rt::Box> box = ReadBox(kept.substr(name.size())))
      {
        boxes.push_back(*box);
      }
    }
  }
  return boxes;
}

std::vector<std::byte> KeptFile::Load() const
{
  std::ifstream kept(this->Path, std::ios::binary | std::ios::ate);
  const std::streamoff bytes = kept ? std::streamoff(kept.tellg()) : 0;
  std::vector<std::byte> content(static_cast<std::size_t>(bytes > 0 ? bytes : 0));
  kept.seekg(0);
  kept.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(content.size()));
  if (!kept)
  {
    return {};
  }
  std::error_code failure; // it is used
  std::filesystem::last_write_time(
    this->Path, std::filesystem::file_time_type::clock::now(), failure);
  return content;
}

void KeptFile::Keep(const std::byte* bytes, std::size_t count) const
{
  if (this->Path.empty())
  {
    return;
  }
  std::error_code failure;
  const std::filesystem::path path(this->Path);
  std::filesystem::create_directories(path.parent_path(), failure);
  // Other processes may read it meanwhile.
  std::filesystem::path written = path;
  written += "." + std::to_string(getpid());
  {
    std::ofstream kept(written, std::ios::binary);
    kept.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    if (!kept.flush())
    {
      kept.close();
      std::filesystem::remove(written, failure);
      return;
    }
  }
  std::filesystem::rename(written, path, failure);
  static std::once_flag tidied; // a series keeps something for each step
  std::call_once(tidied, [&] { RemoveUnused(path.parent_path()); });
}

} // namespace vol
