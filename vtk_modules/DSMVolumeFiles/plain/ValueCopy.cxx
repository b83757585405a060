// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/plain/ValueCopy.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/DurableFile.h"
#include "DSMVolumeFiles/base/FileError.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vol
{

namespace
{

/// Names of copies begin so.
const std::string Beginning = "unpacked-";

/// Follows the values in a copy, and says that it is complete.
using Trailer = std::array<std::uint64_t, 3>;

Trailer MakeTrailer(const std::filesystem::path& copy, std::uint64_t bytes)
{
  constexpr std::uint64_t magic = 0x3143504e554d5344u; // "DSMUNPC1"
  const std::string name = copy.filename().string();
  bricks::ByteHash hash;
  hash.Add(name.data(), name.size());
  hash.Add(&bytes, sizeof(bytes));
  return { magic, bytes, hash.Get() };
}

} // namespace

std::filesystem::path ValueCopy::GetPath(const std::filesystem::path& folder, std::uint64_t hash)
{
  return folder / (Beginning + std::to_string(hash));
}

std::optional<ValuePart> ValueCopy::Find(const std::filesystem::path& copy, std::uint64_t bytes)
{
  try
  {
    const PositionedFile file(copy.string());
    Trailer trailer;
    if (file.GetBytes() != bytes + sizeof(trailer))
    {
      return std::nullopt;
    }
    file.Read(bytes, reinterpret_cast<std::byte*>(trailer.data()), sizeof(trailer));
    if (trailer != MakeTrailer(copy, bytes))
    {
      return std::nullopt;
    }
    // The time of the last use; the time of change stays, by which readers know the file.
    const timespec times[] = { { 0, UTIME_NOW }, { 0, UTIME_OMIT } };
    utimensat(AT_FDCWD, copy.c_str(), times, 0);
    return ValuePart{ copy.string(), 0, file.GetStamp() };
  }
  catch (const dsm::Error&) // such as no file
  {
    return std::nullopt;
  }
}

void ValueCopy::MakeRoom(
  const std::string& path, const std::filesystem::path& folder, std::uint64_t bytes)
{
  std::error_code failure;
  std::uint64_t available = std::filesystem::space(folder, failure).available;
  std::vector<std::tuple<std::int64_t, std::uint64_t, std::filesystem::path>> copies;
  std::uint64_t removable = 0;
  for (auto entry = std::filesystem::directory_iterator(folder, failure);
       !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure))
  {
    struct stat state = {};
    const std::filesystem::path& copy = entry->path();
    if (copy.filename().string().compare(0, Beginning.size(), Beginning) == 0 &&
      copy.extension().empty() && lstat(copy.c_str(), &state) == 0 && S_ISREG(state.st_mode))
    {
      const auto size = static_cast<std::uint64_t>(state.st_size);
      copies.emplace_back(state.st_atime, size, copy);
      removable += size;
    }
  }
  if ((available + removable) / 2 < bytes)
  {
    throw FileError(path,
      "has values that take " + std::to_string(bytes >> 20) + " MiB unpacked, and '" +
        folder.string() + "' has " + std::to_string(available >> 20) +
        " MiB free, of which a copy takes at most half. Let XDG_CACHE_HOME name a folder with more "
        "room, or save the volume without compression.");
  }
  std::sort(copies.begin(), copies.end());
  for (const auto& [used, size, copy] : copies)
  {
    if (available / 2 >= bytes)
    {
      return;
    }
    std::filesystem::remove(copy, failure);
    available += size;
  }
}

ValueCopy::ValueCopy(std::filesystem::path copy)
  : Copy(std::move(copy))
  , Path(this->Copy.string() + ".part")
{
}

std::unique_ptr<ValueCopy> ValueCopy::TryBegin(const std::filesystem::path& copy)
{
  auto written = std::unique_ptr<ValueCopy>(new ValueCopy(copy));
  written->File = Descriptor(
    open(written->Path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW, 0600));
  if (!written->File.IsOpen())
  {
    written->Refuse();
  }
  if (flock(written->File.Get(), LOCK_EX | LOCK_NB) != 0)
  {
    if (errno != EWOULDBLOCK)
    {
      written->Refuse();
    }
    return nullptr;
  }
  struct stat opened = {};
  struct stat there = {};
  // Its writer may have finished meanwhile.
  const bool isThere = fstat(written->File.Get(), &opened) == 0 &&
    stat(written->Path.c_str(), &there) == 0 && opened.st_ino == there.st_ino;
  if (!isThere)
  {
    return nullptr;
  }
  written->IsLocked = true;
  if (!S_ISREG(opened.st_mode) || ftruncate(written->File.Get(), 0) != 0)
  {
    written->Refuse();
  }
  return written;
}

ValueCopy::~ValueCopy()
{
  if (this->IsLocked)
  {
    unlink(this->Path.c_str());
  }
}

void ValueCopy::Add(const void* bytes, std::size_t count)
{
  const auto* const first = static_cast<const char*>(bytes);
  for (std::size_t done = 0; done < count;)
  {
    const ssize_t wrote = write(this->File.Get(), first + done, count - done);
    if (wrote < 0 && errno != EINTR)
    {
      this->Refuse();
    }
    done += static_cast<std::size_t>(std::max<ssize_t>(wrote, 0));
  }
}

void ValueCopy::Finish(std::uint64_t bytes)
{
  const Trailer trailer = MakeTrailer(this->Copy, bytes);
  this->Add(trailer.data(), sizeof(trailer));
  if (fsync(this->File.Get()) != 0)
  {
    this->Refuse();
  }
  DurableFile::Rename(this->Path, this->Copy.string());
  this->IsLocked = false;
}

void ValueCopy::Refuse() const
{
  throw FileError(this->Path,
    "cannot be written: " + std::string(std::strerror(errno)) +
      ". It is for unpacked values; let XDG_CACHE_HOME name a folder for it, or save the volume "
      "without compression.");
}

} // namespace vol
