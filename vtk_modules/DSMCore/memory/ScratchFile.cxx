// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/ScratchFile.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/memory/FileLimit.h"
#include "DSMCore/memory/HostMemory.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

namespace dsm
{

ScratchFile::ScratchFile(std::string directory, std::uint64_t bytes)
  : Directory(std::move(directory))
  , Bytes(bytes)
{
  this->Open();
  try
  {
    this->SetAside();
  }
  catch (...)
  {
    close(this->Descriptor);
    throw;
  }
}

ScratchFile::~ScratchFile()
{
  close(this->Descriptor);
}

void ScratchFile::RefuseRoom(int error) const
{
  throw Error("Scratch directory '" + this->Directory +
    "' (DSMScratchDirectory): cannot reserve the " + FormatMebibytes(this->Bytes) + " (" +
    std::to_string(this->Bytes) + " bytes) that this rank needs: " + std::strerror(error) +
    ". Free space on its disk, choose another directory, or raise the memory per rank "
    "(DSMMemory).");
}

void ScratchFile::Open()
{
#ifdef O_TMPFILE
  this->Descriptor = open(this->Directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
#endif
  if (this->Descriptor < 0)
  {
    // Not every file system has files that never had a name.
    std::string name = this->Directory + "/dsm-scratch-XXXXXX";
    this->Descriptor = mkostemp(name.data(), O_CLOEXEC);
    if (this->Descriptor >= 0)
    {
      unlink(name.c_str());
    }
  }
  if (this->Descriptor < 0)
  {
    const int error = errno;
    if (error == ENOSPC || error == EDQUOT)
    {
      this->RefuseRoom(error);
    }
    throw Error("Scratch directory '" + this->Directory +
      "' (DSMScratchDirectory): cannot create a file, for which this rank needs " +
      FormatMebibytes(this->Bytes) + " (" + std::to_string(this->Bytes) +
      " bytes): " + std::strerror(error) +
      ". The directory must exist and be writable on the node of every rank.");
  }
}

void ScratchFile::SetAside()
{
  if (this->Bytes > GetMostFileBytes())
  {
    this->RefuseRoom(EFBIG);
  }
  int error = 0;
#ifdef __linux__
  do
  {
    // Unlike posix_fallocate, it does not write all of the file where the file system cannot do it.
    error =
      this->Bytes > 0 && fallocate(this->Descriptor, 0, 0, static_cast<off_t>(this->Bytes)) != 0
      ? errno
      : 0;
  } while (error == EINTR);
  if (error == EOPNOTSUPP || error == ENOSYS)
#endif
  {
    error = ftruncate(this->Descriptor, static_cast<off_t>(this->Bytes)) != 0 ? errno : 0;
  }
  if (error != 0)
  {
    this->RefuseRoom(error);
  }
}

void ScratchFile::Write(std::uint64_t offset, const std::byte* bytes, std::size_t count)
{
  while (count > 0)
  {
    const ssize_t done = pwrite(this->Descriptor, bytes, count, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR)
    {
      continue;
    }
    if (done <= 0)
    {
      this->RefuseRoom(done < 0 ? errno : ENOSPC);
    }
    offset += static_cast<std::uint64_t>(done);
    bytes += done;
    count -= static_cast<std::size_t>(done);
  }
}

void ScratchFile::Read(std::uint64_t offset, std::byte* bytes, std::size_t count) const
{
  while (count > 0)
  {
    const ssize_t done = pread(this->Descriptor, bytes, count, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR)
    {
      continue;
    }
    if (done <= 0)
    {
      throw Error("Scratch directory '" + this->Directory +
        "' (DSMScratchDirectory): cannot read the scratch file at byte " + std::to_string(offset) +
        ": " + (done < 0 ? std::strerror(errno) : "end of file") +
        ". Check the disk, or choose another directory.");
    }
    offset += static_cast<std::uint64_t>(done);
    bytes += done;
    count -= static_cast<std::size_t>(done);
  }
}

ScratchFile::Attempt ScratchFile::TryRead(
  std::uint64_t offset, std::byte* bytes, std::size_t count) const
{
  const iovec all{ bytes, count };
  const ssize_t done = preadv2(this->Descriptor, &all, 1, static_cast<off_t>(offset), RWF_NOWAIT);
  if (done < 0 && errno != EAGAIN && errno != EINTR)
  {
    return Attempt::CannotTell;
  }
  return done >= 0 && static_cast<std::size_t>(done) == count ? Attempt::Done : Attempt::WouldWait;
}

void ScratchFile::Prefetch(std::uint64_t offset, std::size_t count) const
{
  // A hint: where the system does not take it, nothing is lost.
  posix_fadvise(
    this->Descriptor, static_cast<off_t>(offset), static_cast<off_t>(count), POSIX_FADV_WILLNEED);
}

} // namespace dsm
