// SPDX-License-Identifier: BSD-3-Clause
#include "InputFolder.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace fuzz
{

namespace fs = std::filesystem;

namespace
{

const std::string Prefix = "dsm-fuzz-";

void RemoveAbandoned(const fs::path& parent)
{
  std::error_code failure;
  for (auto entry = fs::directory_iterator(parent, failure);
       !failure && entry != fs::directory_iterator(); entry.increment(failure))
  {
    const std::string name = entry->path().filename().string();
    if (name.compare(0, Prefix.size(), Prefix) == 0)
    {
      const int process = std::atoi(name.c_str() + Prefix.size());
      std::error_code ignored;
      if (process > 0 && kill(process, 0) != 0 && errno == ESRCH)
      {
        fs::remove_all(entry->path(), ignored);
      }
    }
  }
}

class Folder
{
public:
  Folder()
    : Owner(getpid())
  {
    const fs::path memory = "/dev/shm";
    const fs::path parent = access(memory.c_str(), W_OK) == 0 ? memory : fs::temp_directory_path();
    RemoveAbandoned(parent);
    this->Path = parent / (Prefix + std::to_string(this->Owner));
    fs::remove_all(this->Path);
    fs::create_directories(this->Path);
  }
  ~Folder()
  {
    if (getpid() == this->Owner)
    {
      std::error_code ignored;
      fs::remove_all(this->Path, ignored);
    }
  }
  Folder(const Folder&) = delete;
  void operator=(const Folder&) = delete;

  const fs::path& GetPath() const { return this->Path; }

private:
  pid_t Owner;
  fs::path Path;
};

} // namespace

const fs::path& GetInputFolder()
{
  static const Folder folder;
  return folder.GetPath();
}

void WriteInput(const fs::path& path, const std::uint8_t* bytes, std::size_t count)
{
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool isWritten =
    file >= 0 && write(file, bytes, count) == static_cast<ssize_t>(count) && close(file) == 0;
  if (!isWritten)
  {
    std::perror(path.c_str());
    std::_Exit(2);
  }
}

void Fail(const std::string& what)
{
  std::fprintf(stderr, "FAILED: %s\n", what.c_str());
  std::abort();
}

} // namespace fuzz
