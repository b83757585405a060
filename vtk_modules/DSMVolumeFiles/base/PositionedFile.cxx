// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/PositionedFile.h"

#include "DSMCore/base/Error.h"
#include "DSMRayTracing/base/ByteHash.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vol
{

namespace
{

/// The disk brings whole pages anyway, and a call of the system costs more than to copy one.
constexpr std::uint64_t LargestGap = 8192;
constexpr std::uint64_t MostTogether = std::uint64_t(1) << 20;

std::uint64_t GetStampOf(const struct stat& state)
{
  // Not of the device: its number differs between the hosts that share a file system.
  const std::uint64_t parts[] = { state.st_ino, static_cast<std::uint64_t>(state.st_size),
    static_cast<std::uint64_t>(state.st_mtim.tv_sec),
    static_cast<std::uint64_t>(state.st_mtim.tv_nsec) };
  rt::ByteHash hash;
  hash.Add(parts, sizeof(parts));
  return hash.Get();
}

[[noreturn]] void Refuse(const std::string& path, const std::string& what)
{
  throw dsm::Error("The file '" + path + "' " + what);
}

} // namespace

PositionedFile::PositionedFile(std::string path)
  : Path(std::move(path))
  , Descriptor(open(this->Path.c_str(), O_RDONLY | O_CLOEXEC))
{
  struct stat state
  {
  };
  if (this->Descriptor < 0 || fstat(this->Descriptor, &state) != 0)
  {
    const std::string cause = std::strerror(errno);
    if (this->Descriptor >= 0)
    {
      close(this->Descriptor);
    }
    Refuse(this->Path, "cannot be opened: " + cause + ".");
  }
  this->Bytes = static_cast<std::uint64_t>(state.st_size);
  this->Stamp = GetStampOf(state);
}

PositionedFile::~PositionedFile()
{
  close(this->Descriptor);
}

void PositionedFile::CheckUnchanged() const
{
  struct stat state
  {
  };
  if (fstat(this->Descriptor, &state) == 0 && GetStampOf(state) != this->Stamp)
  {
    Refuse(this->Path, "was written to since it was opened. Reload it.");
  }
}

void PositionedFile::Read(std::uint64_t offset, std::byte* out, std::size_t bytes) const
{
  this->ReadUnchecked(offset, out, bytes);
  this->CheckUnchanged();
}

void PositionedFile::Read(const std::vector<Piece>& pieces, std::byte* out) const
{
  std::vector<std::byte> together;
  for (auto piece = pieces.begin(); piece != pieces.end();)
  {
    const std::uint64_t begin = piece->Offset;
    std::uint64_t end = begin + piece->Bytes;
    auto next = piece + 1;
    for (; next != pieces.end() && next->Offset < end + LargestGap &&
         next->Offset + next->Bytes <= begin + MostTogether;
         ++next)
    {
      end = next->Offset + next->Bytes;
    }
    if (next == piece + 1)
    {
      this->ReadUnchecked(begin, out, piece->Bytes);
      out += piece->Bytes;
      piece = next;
      continue;
    }
    together.resize(static_cast<std::size_t>(end - begin));
    this->ReadUnchecked(begin, together.data(), together.size());
    for (; piece != next; ++piece)
    {
      out = std::copy_n(
        together.data() + static_cast<std::size_t>(piece->Offset - begin), piece->Bytes, out);
    }
  }
  this->CheckUnchanged();
}

void PositionedFile::ReadUnchecked(std::uint64_t offset, std::byte* out, std::size_t bytes) const
{
  const auto place = [&](std::uint64_t at) { return " at byte " + std::to_string(at); };
  std::size_t done = 0;
  while (done < bytes)
  {
    const ssize_t got =
      pread(this->Descriptor, out + done, bytes - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR)
    {
      continue;
    }
    if (got < 0)
    {
      Refuse(this->Path,
        "cannot be read" + place(offset + done) + ": " + std::string(std::strerror(errno)) + ".");
    }
    if (got == 0)
    {
      this->CheckUnchanged();
      Refuse(this->Path,
        "ends" + place(offset + done) + ", where " + std::to_string(bytes - done) +
          " more bytes of values are expected: it is truncated, or its header is wrong.");
    }
    done += static_cast<std::size_t>(got);
  }
}

void PositionedFile::Foresee(std::uint64_t offset, std::size_t bytes) const
{
  // A hint: where the system does not take it, nothing is lost.
  posix_fadvise(
    this->Descriptor, static_cast<off_t>(offset), static_cast<off_t>(bytes), POSIX_FADV_WILLNEED);
}

} // namespace vol
