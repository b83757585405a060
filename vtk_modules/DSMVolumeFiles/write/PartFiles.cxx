// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/write/PartFiles.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace vol
{

namespace
{

namespace fs = std::filesystem;

/// File systems allow names of 255 bytes, and the state of a level appends 27.
constexpr std::size_t LongestName = 228;
constexpr std::size_t ShortenedName = 200;

constexpr int MostLevels = static_cast<int>(FileLimits::Levels);

/// Does not follow links.
fs::file_status GetStatus(const std::string& path)
{
  std::error_code failure;
  return fs::symlink_status(path, failure);
}

void RemoveFile(const std::string& path)
{
  std::error_code failure;
  if (fs::is_regular_file(GetStatus(path)))
  {
    fs::remove(path, failure);
  }
}

void RemoveState(const std::string& path)
{
  const std::string state = PartFiles::GetState(path);
  RemoveFile(state + ".new");
  RemoveFile(state);
}

} // namespace

std::string PartFiles::GetPart(const std::string& path)
{
  const std::size_t slash = path.rfind('/');
  const std::size_t first = slash == std::string::npos ? 0 : slash + 1;
  if (path.size() - first <= LongestName)
  {
    return path + ".part";
  }
  bricks::ByteHash hash;
  hash.Add(path.data() + first, path.size() - first);
  return path.substr(0, first + ShortenedName) + "-" + std::to_string(hash.Get()) + ".part";
}

std::string PartFiles::GetState(const std::string& path)
{
  return GetPart(path) + ".json";
}

std::string PartFiles::GetLock(const std::string& path)
{
  return GetPart(path) + ".lock";
}

std::string PartFiles::GetLevel(const std::string& path, int level)
{
  return GetPart(path) + ".level" + std::to_string(level);
}

void PartFiles::CheckOwn(const std::string& path)
{
  const bool hasState = fs::exists(GetStatus(GetState(path)));
  const auto check = [&](const std::string& name)
  {
    const fs::file_status there = GetStatus(name);
    if (fs::exists(there) && (!hasState || !fs::is_regular_file(there)))
    {
      throw FileError(name,
        "is required as a temporary file to write '" + path +
          "', but this program did not create it. Rename or delete it.");
    }
  };
  check(GetState(path));
  check(GetPart(path));
  for (int level = 1; level <= MostLevels; ++level)
  {
    check(GetLevel(path, level));
  }
}

void PartFiles::RemoveValues(const std::string& path)
{
  for (int level = 1; level <= MostLevels; ++level)
  {
    const std::string one = GetLevel(path, level);
    RemoveFile(GetPart(one));
    RemoveState(one);
    RemoveFile(GetLock(one)); // no process has it: the path's claim covers the levels
    RemoveFile(one);
  }
  RemoveFile(GetPart(path));
}

void PartFiles::Remove(const std::string& path)
{
  RemoveValues(path);
  RemoveState(path);
}

} // namespace vol
