// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/DurableFile.h"

#include "DSMVolumeFiles/base/Descriptor.h"
#include "DSMVolumeFiles/base/FileError.h"

#include "DSMCore/base/Error.h"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vol
{

namespace
{

[[noreturn]] void Refuse(const std::string& path, int cause)
{
  throw FileError(path, "cannot be written: " + std::string(std::strerror(cause)) + ".");
}

void WriteAll(Descriptor& file, const std::string& path, const void* bytes, std::size_t count)
{
  struct stat state = {};
  if (file.Get() < 0 || fstat(file.Get(), &state) != 0)
  {
    Refuse(path, errno);
  }
  if (!S_ISREG(state.st_mode))
  {
    throw FileError(path, "cannot be written because it is a device or a pipe.");
  }
  const auto* const first = static_cast<const char*>(bytes);
  for (std::size_t done = 0; done < count;)
  {
    const ssize_t wrote = write(file.Get(), first + done, count - done);
    if (wrote < 0 && errno != EINTR)
    {
      Refuse(path, errno);
    }
    done += static_cast<std::size_t>(wrote > 0 ? wrote : 0);
  }
  if (fsync(file.Get()) != 0 || !file.Close())
  {
    Refuse(path, errno);
  }
}

} // namespace

void DurableFile::Write(const std::string& path, const void* bytes, std::size_t count)
{
  // Without O_NONBLOCK, opening a pipe would block.
  Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0666));
  WriteAll(file, path, bytes, count);
}

std::string DurableFile::WriteBeside(
  const std::string& beginning, const void* bytes, std::size_t count)
{
  std::random_device random; // process numbers are not unique among hosts that share a folder
  std::string name;
  int opened = -1;
  do
  {
    name = beginning + std::to_string(random()) + "-" + std::to_string(random());
    opened = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (opened < 0 && errno == EEXIST);
  Descriptor file(opened);
  if (file.Get() < 0)
  {
    Refuse(name, errno);
  }
  try
  {
    WriteAll(file, name, bytes, count);
  }
  catch (const dsm::Error&)
  {
    unlink(name.c_str());
    throw;
  }
  return name;
}

void DurableFile::Synchronize(const std::string& path)
{
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.Get() < 0 || fsync(file.Get()) != 0)
  {
    Refuse(path, errno);
  }
}

void DurableFile::Rename(const std::string& from, const std::string& to)
{
  if (std::rename(from.c_str(), to.c_str()) != 0)
  {
    throw FileError(from, "could not be renamed to '" + to + "': " + std::strerror(errno) + ".");
  }
  const std::filesystem::path folder = std::filesystem::path(to).parent_path();
  const Descriptor opened(
    open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // Not every file system supports this; the renamed file is there in any case.
  if (opened.Get() >= 0 && fsync(opened.Get()) != 0 && errno == EIO)
  {
    Refuse(to, errno);
  }
}

} // namespace vol
