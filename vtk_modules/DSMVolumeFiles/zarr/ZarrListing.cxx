// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrListing.h"

#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/base/ReadingManner.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <utility>

namespace vol
{

namespace
{

constexpr std::uint64_t MostListed = 1 << 24;
constexpr std::uint64_t MostAbsent = 1 << 20;
constexpr std::uint64_t AbsentBytes = 32;  ///< about what one takes
constexpr std::uint64_t FolderBytes = 128; ///< about what a folder takes beside its files

} // namespace

ZarrListing::ZarrListing(const std::string& folder, const ZarrMetadata& data, bool canList)
  : Root(folder)
  , CanList(canList)
  , IsNested(data.Separator == "/")
  , Folders(IsNested ? data.Shape.size() : 1)
{
  if (IsNested && !data.Prefix.empty())
  {
    this->Root += "/" + data.Prefix;
  }
  else if (!data.Prefix.empty())
  {
    this->Prefix = data.Prefix + data.Separator;
  }
  this->Counts = data.CountFiles();
  if (!MultiplyWithin(FileLimits::ArrayBytes, this->Counts))
  {
    this->Counts.clear();
  }
}

std::uint64_t ZarrListing::GetNumber(const Index& index) const
{
  std::uint64_t number = 0;
  for (std::size_t axis = 0; axis < this->Counts.size(); ++axis)
  {
    number = number * this->Counts[axis] + static_cast<std::uint64_t>(index[axis]);
  }
  return number;
}

ZarrListing::End ZarrListing::Find(const Index& index) const
{
  if (!this->CanList)
  {
    return { 0, 0, this->Absent.count(this->GetNumber(index)) != 0 };
  }
  std::uint64_t number = 0;
  if (!this->IsNested)
  {
    const auto root = this->Folders[0].find(0);
    number = this->GetNumber(index);
    return { 0, 0,
      root != this->Folders[0].end() &&
        !std::binary_search(root->second.Files.begin(), root->second.Files.end(), number) };
  }
  for (std::size_t depth = 0; depth < this->Counts.size(); ++depth)
  {
    const auto folder = this->Folders[depth].find(number);
    const auto entry = static_cast<std::uint64_t>(index[depth]);
    const bool isListed = folder != this->Folders[depth].end();
    const bool isMissing = isListed &&
      !std::binary_search(folder->second.Files.begin(), folder->second.Files.end(), entry);
    if (!isListed || isMissing || depth + 1 == this->Counts.size())
    {
      return { depth, number, isMissing };
    }
    number = number * this->Counts[depth] + entry;
  }
  return { 0, 0, false };
}

bool ZarrListing::IsMissing(const Index& index) const
{
  const std::shared_lock<std::shared_mutex> lock(this->Guard);
  return this->Find(index).IsMissing;
}

bool ZarrListing::IsStillMissing(const Index& index)
{
  std::uint64_t stamp = 0;
  End end{};
  {
    const std::shared_lock<std::shared_mutex> lock(this->Guard);
    end = this->Find(index);
    if (!end.IsMissing || !this->CanList)
    {
      return end.IsMissing;
    }
    stamp = this->Folders[end.Depth].at(end.Number).Stamp;
  }
  if (PositionedFile::FindStampOf(this->GetPath(index, end.Depth)) == stamp)
  {
    return true;
  }
  const std::unique_lock<std::shared_mutex> lock(this->Guard);
  const auto folder = this->Folders[end.Depth].find(end.Number);
  if (folder != this->Folders[end.Depth].end() && folder->second.Stamp == stamp)
  {
    this->Listed -= folder->second.Files.size();
    this->Folders[end.Depth].erase(folder);
  }
  return false;
}

void ZarrListing::NoteMissing(const Index& index)
{
  if (!this->CanList)
  {
    const std::unique_lock<std::shared_mutex> lock(this->Guard);
    if (!this->Counts.empty() && this->Absent.size() < MostAbsent)
    {
      this->Absent.insert(this->GetNumber(index));
    }
    return;
  }
  // Those above it have been listed when this returns, or have it and cannot be.
  while (!WithoutWaiting::IsInForce())
  {
    End end{};
    {
      const std::shared_lock<std::shared_mutex> lock(this->Guard);
      end = this->Find(index);
      const bool isListed = this->Folders[end.Depth].count(end.Number) != 0;
      if (this->Counts.empty() || isListed || this->Listed > MostListed)
      {
        return;
      }
    }
    std::optional<Folder> found = this->List(this->GetPath(index, end.Depth));
    if (!found)
    {
      return;
    }
    const std::unique_lock<std::shared_mutex> lock(this->Guard);
    const std::size_t count = found->Files.size();
    if (this->Folders[end.Depth].emplace(end.Number, std::move(*found)).second)
    {
      this->Listed += count;
    }
  }
}

std::uint64_t ZarrListing::GetBytes() const
{
  const std::shared_lock<std::shared_mutex> lock(this->Guard);
  std::uint64_t bytes = this->Listed * sizeof(std::uint64_t) + this->Absent.size() * AbsentBytes;
  for (const auto& folders : this->Folders)
  {
    bytes += folders.size() * FolderBytes;
  }
  return bytes;
}

std::string ZarrListing::GetPath(const Index& index, std::size_t depth) const
{
  std::string path = this->Root;
  for (std::size_t axis = 0; axis < depth; ++axis)
  {
    path += "/" + std::to_string(index[axis]);
  }
  return path;
}

std::optional<std::uint64_t> ZarrListing::Parse(const std::string& name) const
{
  if (name.compare(0, this->Prefix.size(), this->Prefix) != 0)
  {
    return std::nullopt;
  }
  const char* at = name.data() + this->Prefix.size();
  const char* const end = name.data() + name.size();
  const auto take = [&]() -> std::optional<std::uint64_t>
  {
    std::uint64_t number = 0;
    const auto parsed = std::from_chars(at, end, number);
    const bool isPlain = parsed.ec == std::errc() && (*at != '0' || parsed.ptr == at + 1);
    at = parsed.ptr;
    return isPlain ? std::optional<std::uint64_t>(number) : std::nullopt;
  };
  if (this->IsNested)
  {
    const std::optional<std::uint64_t> number = take();
    return at == end ? number : std::nullopt;
  }
  std::uint64_t number = 0;
  for (std::size_t axis = 0; axis < this->Counts.size(); ++axis)
  {
    const bool hasPoint = axis == 0 || (at != end && *at++ == '.');
    const std::optional<std::uint64_t> one = hasPoint ? take() : std::nullopt;
    if (!one || *one >= this->Counts[axis])
    {
      return std::nullopt;
    }
    number = number * this->Counts[axis] + *one;
  }
  return at == end ? std::optional<std::uint64_t>(number) : std::nullopt;
}

std::optional<ZarrListing::Folder> ZarrListing::List(const std::string& path) const
{
  namespace fs = std::filesystem;
  Folder folder;
  folder.Stamp = PositionedFile::FindStampOf(path);
  std::error_code failure;
  if (folder.Stamp == 0)
  {
    return fs::status(path, failure).type() == fs::file_type::not_found
      ? std::optional<Folder>(std::move(folder))
      : std::nullopt;
  }
  // Its stamp may be as coarse as the system's clock ticks.
  constexpr std::chrono::milliseconds oftenEnough(100);
  const auto age = fs::file_time_type::clock::now() - fs::last_write_time(path, failure);
  if (failure || (age < oftenEnough && age > -oftenEnough))
  {
    return std::nullopt;
  }
  for (fs::directory_iterator entry(path, failure); !failure && entry != fs::directory_iterator();
       entry.increment(failure))
  {
    const auto number = this->Parse(entry->path().filename().string());
    if (number)
    {
      folder.Files.push_back(*number);
    }
    if (folder.Files.size() > MostListed)
    {
      return std::nullopt;
    }
  }
  if (failure || PositionedFile::FindStampOf(path) != folder.Stamp)
  {
    return std::nullopt;
  }
  folder.Files.shrink_to_fit();
  std::sort(folder.Files.begin(), folder.Files.end());
  return folder;
}

} // namespace vol
