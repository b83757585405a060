// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/remote/KeptAnswers.h"

#include "DSMCore/base/ByteDigest.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/CacheFolder.h"
#include "DSMVolumeFiles/base/PositionedFile.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace vol
{

namespace
{

constexpr std::uint64_t KeptMagic = 0x3150545448445344u;
constexpr std::uint64_t MostTextBytes = 1 << 16;
constexpr const char* ClaimsName = "claims";

/// Before the texts and the body.
struct KeptHead
{
  std::uint64_t Magic;
  std::uint64_t Checksum; ///< of all behind it
  std::uint64_t Total;
  std::uint64_t NameBytes;
  std::uint64_t TagBytes;
  std::uint64_t ModifiedBytes;
  std::uint64_t BodyBytes;
};
constexpr std::size_t Checked = 2 * sizeof(std::uint64_t);

std::uint64_t GetCheck(const ByteBuffer& file)
{
  return dsm::HashBytes(file.data() + Checked, file.size() - Checked);
}

std::uint64_t HashName(const std::string& name, std::uint64_t seed)
{
  return dsm::HashBytes(name.data(), name.size(), seed);
}

bool WriteAll(int descriptor, const ByteBuffer& bytes)
{
  for (std::size_t done = 0; done < bytes.size();)
  {
    const ssize_t count = write(descriptor, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR)
    {
      continue;
    }
    if (count <= 0)
    {
      return false;
    }
    done += static_cast<std::size_t>(count);
  }
  return true;
}

} // namespace

KeptAnswers& KeptAnswers::GetShared()
{
  static KeptAnswers answers = []
  {
    constexpr std::uint64_t usual = 4096;
    const char* const text = std::getenv("DSM_HTTP_CACHE_MIB");
    const std::uint64_t mebibytes = text && *text ? std::strtoull(text, nullptr, 10) : usual;
    const std::filesystem::path folder = GetCacheFolder();
    const bool isWanted = mebibytes > 0 && !folder.empty();
    return KeptAnswers(isWanted ? folder / "http" : std::filesystem::path(),
      std::min<std::uint64_t>(mebibytes, 1 << 30) << 20);
  }();
  return answers;
}

KeptAnswers::KeptAnswers(std::filesystem::path folder, std::uint64_t most)
  : Folder(std::move(folder))
  , Most(most)
  , Written(most) // what other processes have kept is counted at the first file
{
}

std::filesystem::path KeptAnswers::GetPath(const std::string& name) const
{
  constexpr std::uint64_t other = 0x9e3779b97f4a7c15u;
  return this->Folder /
    (std::to_string(HashName(name, 0)) + "-" + std::to_string(HashName(name, other)));
}

std::optional<KeptAnswers::Kept> KeptAnswers::Find(
  const std::string& name, std::uint64_t most) const
{
  if (this->Folder.empty())
  {
    return std::nullopt;
  }
  try
  {
    const std::filesystem::path path = this->GetPath(name);
    std::error_code failure;
    const Time checked = std::filesystem::last_write_time(path, failure);
    if (failure)
    {
      return std::nullopt;
    }
    const PositionedFile file(path.string());
    KeptHead head{};
    if (file.IsDirectory() || file.GetBytes() < sizeof(head) ||
      file.GetBytes() - sizeof(head) > most + MostTextBytes)
    {
      return std::nullopt;
    }
    ByteBuffer bytes(static_cast<std::size_t>(file.GetBytes()));
    file.ReadUnchecked(0, bytes.data(), bytes.size());
    std::memcpy(&head, bytes.data(), sizeof(head));
    const std::uint64_t texts[] = { head.NameBytes, head.TagBytes, head.ModifiedBytes };
    const bool isRight = head.Magic == KeptMagic && head.Checksum == GetCheck(bytes) &&
      std::all_of(std::begin(texts), std::end(texts),
        [](std::uint64_t count) { return count <= MostTextBytes; }) &&
      head.BodyBytes <= most &&
      bytes.size() == sizeof(head) + texts[0] + texts[1] + texts[2] + head.BodyBytes;
    if (!isRight)
    {
      return std::nullopt;
    }
    const auto* text = reinterpret_cast<const char*>(bytes.data()) + sizeof(head);
    const auto take = [&text](std::uint64_t count)
    {
      std::string taken(text, static_cast<std::size_t>(count));
      text += count;
      return taken;
    };
    if (take(head.NameBytes) != name)
    {
      return std::nullopt;
    }
    Kept kept;
    kept.Validator.Tag = take(head.TagBytes);
    kept.Validator.Modified = take(head.ModifiedBytes);
    kept.Total = head.Total;
    kept.Checked = checked;
    bytes.erase(
      bytes.begin(), bytes.end() - static_cast<ByteBuffer::difference_type>(head.BodyBytes));
    kept.Body = std::move(bytes);
    return kept;
  }
  catch (const dsm::Error&)
  {
    return std::nullopt;
  }
}

void KeptAnswers::Keep(const std::string& name, const HttpValidator& validator, std::uint64_t total,
  const ByteBuffer& body)
{
  const std::uint64_t bytes =
    sizeof(KeptHead) + name.size() + validator.Tag.size() + validator.Modified.size() + body.size();
  if (this->Folder.empty() || validator.IsEmpty() || bytes > this->Most / 8)
  {
    return;
  }
  try
  {
    std::error_code failure;
    if (std::filesystem::create_directories(this->Folder, failure))
    {
      std::filesystem::permissions(this->Folder, std::filesystem::perms::owner_all, failure);
    }
    KeptHead head{ KeptMagic, 0, total, name.size(), validator.Tag.size(),
      validator.Modified.size(), body.size() };
    ByteBuffer file;
    file.reserve(static_cast<std::size_t>(bytes));
    const auto add = [&file](const void* from, std::size_t count)
    {
      const auto* const first = static_cast<const std::byte*>(from);
      file.insert(file.end(), first, first + count);
    };
    add(&head, sizeof(head));
    add(name.data(), name.size());
    add(validator.Tag.data(), validator.Tag.size());
    add(validator.Modified.data(), validator.Modified.size());
    add(body.data(), body.size());
    head.Checksum = GetCheck(file);
    std::memcpy(file.data(), &head, sizeof(head));
    // Others may read or write the same file. A checksum tells what a failing disk has left.
    static std::atomic<std::uint64_t> number{ 0 };
    const std::filesystem::path path = this->GetPath(name);
    const std::string beside =
      path.string() + "." + std::to_string(getpid()) + "." + std::to_string(number++);
    Descriptor written(open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    if (!written.IsOpen())
    {
      return;
    }
    const bool isThere = WriteAll(written.Get(), file) && written.Close();
    if (isThere)
    {
      std::filesystem::rename(beside, path, failure);
    }
    if (!isThere || failure)
    {
      std::filesystem::remove(beside, failure);
      return;
    }
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->Written += bytes;
    if (this->Written >= this->Most / 16)
    {
      this->Written = 0;
      this->MakeRoom();
    }
  }
  catch (const std::exception&)
  {
  }
}

void KeptAnswers::Confirm(const std::string& name) const
{
  std::error_code failure;
  std::filesystem::last_write_time(this->GetPath(name), Time::clock::now(), failure);
}

void KeptAnswers::Drop(const std::string& name) const
{
  if (!this->Folder.empty())
  {
    std::error_code failure;
    std::filesystem::remove(this->GetPath(name), failure);
  }
}

void KeptAnswers::MakeRoom()
{
  struct Entry
  {
    Time Used;
    std::uint64_t Bytes;
    std::filesystem::path Path;
  };
  std::vector<Entry> entries;
  std::uint64_t all = 0;
  std::error_code failure;
  for (auto entry = std::filesystem::directory_iterator(this->Folder, failure);
       !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure))
  {
    std::error_code unknown;
    const Time used = entry->last_write_time(unknown);
    const std::uint64_t bytes = unknown ? 0 : entry->file_size(unknown);
    if (!unknown && entry->path().filename() != ClaimsName)
    {
      all += bytes;
      entries.push_back({ used, bytes, entry->path() });
    }
  }
  std::sort(entries.begin(), entries.end(),
    [](const Entry& one, const Entry& other) { return one.Used < other.Used; });
  for (const Entry& entry : entries)
  {
    if (all <= this->Most - this->Most / 8)
    {
      break;
    }
    std::filesystem::remove(entry.Path, failure);
    all -= entry.Bytes;
  }
}

KeptAnswers::Claim::Claim(
  const KeptAnswers& answers, const std::string& name, std::chrono::seconds limit)
{
  if (answers.Folder.empty())
  {
    return;
  }
  std::error_code failure;
  std::filesystem::create_directories(answers.Folder, failure);
  // Each name is a byte of one file that stays empty; a process that ends lets go.
  const std::string path = (answers.Folder / ClaimsName).string();
  Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  struct flock wanted
  {
  };
  wanted.l_type = F_WRLCK;
  wanted.l_whence = SEEK_SET;
  wanted.l_start = static_cast<off_t>(HashName(name, 0) >> 2);
  wanted.l_len = 1;
  const auto end = std::chrono::steady_clock::now() + limit;
  while (file.IsOpen() && fcntl(file.Get(), F_OFD_SETLK, &wanted) != 0)
  {
    const bool isTaken = errno == EAGAIN || errno == EACCES || errno == EINTR;
    if (!isTaken || std::chrono::steady_clock::now() > end)
    {
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  this->File = std::move(file);
}

} // namespace vol
