// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/range/KeptFile.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/CacheFolder.h"
#include "DSMVolumeFiles/base/DurableFile.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/base/Url.h"

#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>

namespace vol
{

namespace
{

/// Kept files that were not used for so long are removed: the volume has probably changed, or is
/// gone.
constexpr auto LongestUnused = std::chrono::hours(24) * 180;

void RemoveUnused(const std::filesystem::path& folder)
{
  std::error_code failure;
  const auto now = std::filesystem::file_time_type::clock::now();
  for (auto entry = std::filesystem::directory_iterator(folder, failure);
       !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure))
  {
    std::error_code unknown;
    const bool isFile = entry->is_regular_file(unknown);
    const auto used = entry->last_write_time(unknown);
    if (!unknown && isFile && now - used > LongestUnused)
    {
      std::filesystem::remove(entry->path(), unknown);
    }
  }
}

/// Returns the path prefix of files that are kept for an array, with the folder; empty if there is
/// no folder.
std::filesystem::path GetBeginning(const ArrayStep& of, const std::string& kind)
{
  const std::filesystem::path folder = GetCacheFolder();
  if (folder.empty())
  {
    return {};
  }
  const VolumeFile::StepOrigin origin = of.File->GetOrigin(of.Step);
  const std::string path = GetWholePath(origin.Path);
  const FileArray& kept = of.Get();
  const bricks::Index3& samples = kept.Grid.Samples; // another level of detail has fewer
  const std::int64_t numbers[] = { static_cast<std::int64_t>(origin.Stamp),
    static_cast<std::int64_t>(of.Array), origin.Step, samples.x, samples.y, samples.z };
  bricks::ByteHash hash;
  hash.Add(path.data(), path.size());
  hash.Add(kept.Name.data(), kept.Name.size());
  hash.Add(kind.data(), kind.size());
  hash.Add(numbers, sizeof(numbers));
  if (kept.Valid.Exclude(kept.Type))
  {
    hash.Add(&kept.Valid, sizeof(kept.Valid));
  }
  return folder / (kind + "-" + std::to_string(hash.Get()) + "-");
}

/// The box's six numbers, with nothing behind them.
std::string Write(const bricks::Box& box)
{
  std::string text;
  for (const bricks::Index3& corner : { box.Min, box.Max })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      text += (text.empty() ? "" : "_") + std::to_string(corner[axis]);
    }
  }
  return text;
}

/// Parses the end of a file name. Returns nothing unless it is a box within `whole`.
std::optional<bricks::Box> ReadBox(const std::string& text, const bricks::Box& whole)
{
  bricks::Box box;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (bricks::Index3* corner : { &box.Min, &box.Max })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      at = std::from_chars(at, end, (*corner)[axis]).ptr;
      at += at != end && *at == '_' ? 1 : 0;
    }
  }
  const bool isInside = Write(bricks::Intersect(box, whole)) == text;
  return isInside && !box.IsEmpty() ? std::optional<bricks::Box>(box) : std::nullopt;
}

} // namespace

KeptFile::KeptFile(const ArrayStep& of, const bricks::Box& box, const std::string& kind)
  : Path(GetBeginning(of, kind).string())
{
  if (!this->Path.empty())
  {
    this->Path += Write(box);
  }
}

std::vector<bricks::Box> KeptFile::FindBoxes(const ArrayStep& of, const std::string& kind)
{
  std::vector<bricks::Box> boxes;
  const std::filesystem::path beginning = GetBeginning(of, kind);
  const std::string name = beginning.filename().string();
  const bricks::Box whole{ bricks::Index3(0), of.Get().Grid.Samples };
  std::error_code failure; // such as no folder
  for (auto entry = std::filesystem::directory_iterator(beginning.parent_path(), failure);
       !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure))
  {
    const std::string kept = entry->path().filename().string();
    if (kept.compare(0, name.size(), name) == 0)
    {
      if (const std::optional<bricks::Box> box = ReadBox(kept.substr(name.size()), whole))
      {
        boxes.push_back(*box);
      }
    }
  }
  return boxes;
}

KeptFile::Header KeptFile::MakeHeader(const std::byte* bytes, std::size_t count) const
{
  constexpr std::uint64_t magic = 0x315450454b4d5344u; // "DSMKEPT1"
  const std::string name = std::filesystem::path(this->Path).filename().string();
  bricks::ByteHash hash;
  hash.Add(name.data(), name.size());
  hash.Add(bytes, count);
  return { magic, count, hash.Get() };
}

std::vector<std::byte> KeptFile::Load(std::size_t count) const
{
  Header header;
  std::string kept;
  try
  {
    kept = this->Path.empty() ? std::string() : ReadWhole(this->Path, sizeof(header) + count);
  }
  catch (const dsm::Error&) // such as no file
  {
    return {};
  }
  if (kept.size() != sizeof(header) + count)
  {
    return {};
  }
  std::memcpy(&header, kept.data(), sizeof(header));
  std::vector<std::byte> content(count);
  std::memcpy(content.data(), kept.data() + sizeof(header), count);
  const Header expected = this->MakeHeader(content.data(), content.size());
  if (header.Magic != expected.Magic || header.Bytes != expected.Bytes ||
    header.Checksum != expected.Checksum)
  {
    return {};
  }
  std::error_code failure; // the time of the last use
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
  try
  {
    const std::filesystem::path path(this->Path);
    std::error_code failure;
    std::filesystem::create_directories(path.parent_path(), failure);
    const Header header = this->MakeHeader(bytes, count);
    std::vector<std::byte> content(sizeof(header));
    std::memcpy(content.data(), &header, sizeof(header));
    content.insert(content.end(), bytes, bytes + count);
    // Other processes may read or write the same file at the same time.
    const std::string written =
      DurableFile::WriteBeside(this->Path + ".", content.data(), content.size());
    try
    {
      DurableFile::Rename(written, this->Path);
    }
    catch (const dsm::Error&)
    {
      std::filesystem::remove(written, failure);
      throw;
    }
    static std::once_flag tidied; // a series keeps something for each step
    std::call_once(tidied, [&] { RemoveUnused(path.parent_path()); });
  }
  catch (const std::exception&) // a full disk, or something else than a file is there
  {
  }
}

} // namespace vol
