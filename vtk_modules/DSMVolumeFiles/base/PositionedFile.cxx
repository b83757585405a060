// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/PositionedFile.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/ReadingManner.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

namespace vol
{

namespace
{

/// The disk brings whole pages anyway, and a call of the system costs more than to copy one.
constexpr std::uint64_t LargestGap = 8192;
constexpr std::uint64_t MostTogether = std::uint64_t(1) << 20;

/// A smaller file is soon in memory entirely.
constexpr std::uint64_t SmallestWithReadAhead = std::uint64_t(64) << 20;

/// Size of a disk read for scattered pieces, in bytes: smaller reads are hardly faster.
constexpr std::uint64_t Window = std::uint64_t(32) << 10;

std::uint64_t GetStampOf(const struct stat& state)
{
  // Not of the device: its number differs between the hosts that share a file system.
  const std::uint64_t parts[] = { state.st_ino, static_cast<std::uint64_t>(state.st_size),
    static_cast<std::uint64_t>(state.st_mtim.tv_sec),
    static_cast<std::uint64_t>(state.st_mtim.tv_nsec) };
  bricks::ByteHash hash;
  hash.Add(parts, sizeof(parts));
  return hash.Get();
}

} // namespace

PositionedFile::PositionedFile(std::string path)
  : Path(std::move(path))
{
  if (WithoutWaiting::IsInForce())
  {
    throw WouldWait{ true };
  }
  // A pipe would be waited for.
  this->Whole = Descriptor(open(this->Path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat state
  {
  };
  if (!this->Whole.IsOpen() || fstat(this->Whole.Get(), &state) != 0)
  {
    throw FileError(this->Path, "cannot be opened: " + std::string(std::strerror(errno)) + ".");
  }
  if (!S_ISREG(state.st_mode) && !S_ISDIR(state.st_mode)) // a folder has a stamp, too
  {
    throw FileError(this->Path, "cannot be read in parts because it is a device or a pipe.");
  }
  this->OfDirectory = S_ISDIR(state.st_mode);
  this->Bytes = static_cast<std::uint64_t>(state.st_size);
  this->Stamp = GetStampOf(state);
  if (this->Bytes >= SmallestWithReadAhead)
  {
    Descriptor scattered(open(this->Path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (scattered.IsOpen() && fstat(scattered.Get(), &state) == 0 &&
      GetStampOf(state) == this->Stamp &&
      posix_fadvise(scattered.Get(), 0, 0, POSIX_FADV_RANDOM) == 0)
    {
      this->Scattered = std::move(scattered);
    }
  }
}

std::uint64_t PositionedFile::FindStampOf(const std::string& path)
{
  struct stat state
  {
  };
  return stat(path.c_str(), &state) == 0 ? GetStampOf(state) : 0;
}

bool PositionedFile::IsUnchanged() const
{
  struct stat state
  {
  };
  return fstat(this->Whole.Get(), &state) != 0 || GetStampOf(state) == this->Stamp;
}

void PositionedFile::CheckUnchanged() const
{
  if (!this->IsUnchanged())
  {
    throw FileError(this->Path, "changed after it was opened. Reload it.");
  }
}

void PositionedFile::Read(std::uint64_t offset, std::byte* out, std::size_t bytes) const
{
  this->ReadUnchecked(offset, out, bytes);
  this->CheckUnchanged();
}

PositionedFile::Run PositionedFile::FindRun(
  const std::vector<Piece>& pieces, std::vector<Piece>::const_iterator first)
{
  Run run{ first, first + 1, first->Offset, first->Offset + first->Bytes };
  for (; run.Last != pieces.end() && run.Last->Offset < run.End + LargestGap &&
       run.Last->Offset + run.Last->Bytes <= run.Begin + MostTogether;
       ++run.Last)
  {
    run.End = std::max<std::uint64_t>(run.End, run.Last->Offset + run.Last->Bytes);
  }
  return run;
}

void PositionedFile::Read(const std::vector<Piece>& pieces, std::byte* out) const
{
  ByteBuffer together;
  for (auto piece = pieces.begin(); piece != pieces.end();)
  {
    const Run run = FindRun(pieces, piece);
    if (run.Last == piece + 1)
    {
      this->ReadUnchecked(run.Begin, out, piece->Bytes);
      out += piece->Bytes;
      piece = run.Last;
      continue;
    }
    together.resize(static_cast<std::size_t>(run.End - run.Begin));
    this->ReadUnchecked(run.Begin, together.data(), together.size());
    for (; piece != run.Last; ++piece)
    {
      out = std::copy_n(
        together.data() + static_cast<std::size_t>(piece->Offset - run.Begin), piece->Bytes, out);
    }
  }
  this->CheckUnchanged();
}

void PositionedFile::ReadUnchecked(std::uint64_t offset, std::byte* out, std::size_t bytes) const
{
  const auto place = [&](std::uint64_t at) { return " at byte " + std::to_string(at); };
  const bool waits = !WithoutWaiting::IsInForce();
  const bool isScattered = this->Scattered.IsOpen() && ScatteredReads::AreInForce();
  const int descriptor = (isScattered ? this->Scattered : this->Whole).Get();
  if (isScattered && waits)
  {
    this->Prefetch(offset, bytes);
  }
  std::size_t done = 0;
  while (done < bytes)
  {
    const iovec rest{ out + done, bytes - done };
    const ssize_t got =
      preadv2(descriptor, &rest, 1, static_cast<off_t>(offset + done), waits ? 0 : RWF_NOWAIT);
    if (got < 0 && errno == EINTR)
    {
      continue;
    }
    if (got < 0 && !waits)
    {
      throw WouldWait{ errno != EAGAIN };
    }
    if (got < 0)
    {
      throw FileError(this->Path,
        "cannot be read" + place(offset + done) + ": " + std::string(std::strerror(errno)) + ".");
    }
    if (got == 0)
    {
      this->CheckUnchanged();
      throw FileError(this->Path,
        "ends" + place(offset + done) + ", where " + std::to_string(bytes - done) +
          " more bytes of values are expected. The file is truncated or its header is wrong.");
    }
    done += static_cast<std::size_t>(got);
  }
}

void PositionedFile::Prefetch(std::uint64_t offset, std::size_t bytes) const
{
  std::uint64_t end = offset + bytes;
  if (this->Scattered.IsOpen())
  {
    offset = offset / Window * Window;
    end = (end + Window - 1) / Window * Window;
  }
  // A hint: where the system does not take it, nothing is lost.
  posix_fadvise(this->Whole.Get(), static_cast<off_t>(offset), static_cast<off_t>(end - offset),
    POSIX_FADV_WILLNEED);
}

void PositionedFile::Prefetch(std::vector<Piece> pieces) const
{
  std::sort(pieces.begin(), pieces.end(),
    [](const Piece& one, const Piece& other) { return one.Offset < other.Offset; });
  for (auto piece = pieces.cbegin(); piece != pieces.cend();)
  {
    const Run run = FindRun(pieces, piece);
    this->Prefetch(run.Begin, static_cast<std::size_t>(run.End - run.Begin));
    piece = run.Last;
  }
}

} // namespace vol
