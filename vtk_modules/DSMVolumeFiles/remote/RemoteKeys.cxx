// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/remote/RemoteKeys.h"

#include "DSMCore/base/ByteDigest.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/MemorySource.h"
#include "DSMVolumeFiles/base/ReadingManner.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

constexpr std::size_t MostKnownKeys = 1 << 16;
constexpr std::chrono::seconds LeastBetweenChecks(1);

/// A request takes as long as some bytes.
constexpr std::uint64_t LargestRemoteGap = std::uint64_t(64) << 10;
constexpr std::uint64_t MostTogetherRemote = std::uint64_t(8) << 20;

void RefuseToWait()
{
  if (WithoutWaiting::IsInForce())
  {
    throw WouldWait{};
  }
}

/// Who waits for another one to fetch the same bytes does so about as long as that one may take.
std::chrono::seconds GetLongestClaim()
{
  return std::chrono::seconds(2 * HttpLimits::Get().Seconds);
}

/// A key in memory.
class FetchedKey final : public MemorySource
{
public:
  /// `name`: of what is kept of it.
  FetchedKey(std::string path, std::string name, ByteBuffer bytes, std::uint64_t stamp)
    : MemorySource(std::move(path), std::move(bytes), stamp)
    , Name(std::move(name))
  {
  }

  void Doubt() const override { KeptAnswers::GetShared().Drop(this->Name); }

private:
  std::string Name;
};

} // namespace

/// A key that is read in parts.
class RemoteKeys::Parts final : public StampedSource
{
public:
  Parts(std::shared_ptr<const RemoteKeys> keys, std::string path, Known known)
    : Keys(std::move(keys))
    , Path(std::move(path))
    , Whole(std::move(known))
  {
  }

  /// Bytes that are here already.
  void SetBeginning(const HttpRange& range, ByteBuffer bytes)
  {
    this->Offset = range.FromEnd ? this->Whole.Total - bytes.size() : range.Offset;
    this->Bytes = std::move(bytes);
    this->Names.push_back(this->Keys->NameKept(this->Path, range));
  }

  const std::string& GetPath() const override { return this->Path; }
  std::uint64_t GetBytes() const override { return this->Whole.Total; }
  std::uint64_t GetStamp() const override { return GetStampOf(this->Whole); }
  void Prefetch(std::vector<Piece>) const override {}

  void Doubt() const override
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    for (const std::string& name : this->Names)
    {
      this->Keys->Kept.Drop(name);
    }
  }

  void Read(const std::vector<Piece>& pieces, std::byte* out) const override
  {
    for (auto piece = pieces.begin(); piece != pieces.end();)
    {
      // Pieces ascend, and may overlap.
      const std::uint64_t begin = piece->Offset;
      std::uint64_t end = begin + piece->Bytes;
      auto last = piece + 1;
      for (; last != pieces.end() && last->Offset < end + LargestRemoteGap &&
           last->Offset + last->Bytes <= begin + MostTogetherRemote;
           ++last)
      {
        end = std::max<std::uint64_t>(end, last->Offset + last->Bytes);
      }
      if (end > this->Whole.Total || end < begin)
      {
        throw FileError(this->Path,
          "ends at byte " + std::to_string(this->Whole.Total) + ", where more are expected.");
      }
      const ByteBuffer read = this->ReadRun(begin, end);
      for (; piece != last; ++piece)
      {
        out = std::copy_n(read.data() + (piece->Offset - begin), piece->Bytes, out);
      }
    }
  }

private:
  ByteBuffer ReadRun(std::uint64_t begin, std::uint64_t end) const
  {
    if (begin == end)
    {
      return {};
    }
    if (begin >= this->Offset && end <= this->Offset + this->Bytes.size())
    {
      const std::byte* const first = this->Bytes.data() + (begin - this->Offset);
      return ByteBuffer(first, first + (end - begin));
    }
    const HttpRange part{ begin, end - begin };
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      this->Names.push_back(this->Keys->NameKept(this->Path, part));
    }
    std::optional<Answer> answer = this->Keys->Ask(this->Path, part, part.Bytes);
    if (!answer)
    {
      throw FileError(this->Path, "was deleted after it was opened.");
    }
    const bool isSame = answer->Of.Validator == this->Whole.Validator &&
      answer->Of.Total == this->Whole.Total && answer->Body.size() == part.Bytes;
    if (!isSame)
    {
      throw FileError(this->Path, "changed or was replaced after it was opened. Reload it.");
    }
    return std::move(answer->Body);
  }

  std::shared_ptr<const RemoteKeys> Keys;
  std::string Path;
  Known Whole;
  std::uint64_t Offset = 0;
  ByteBuffer Bytes; ///< from Offset on
  mutable std::mutex Guard;
  mutable std::vector<std::string> Names; ///< of what is kept of it
};

RemoteKeys::RemoteKeys(const std::string& url, std::function<bool()> goesOn,
  const std::optional<KeptAnswers::Time>& openedAt)
  : Place(url)
  , GoesOn(std::move(goesOn))
  , Kept(KeptAnswers::GetShared())
  , OpenedAt(openedAt.value_or(KeptAnswers::Time::clock::now()))
{
}

std::string RemoteKeys::NameKept(
  const std::string& path, const std::optional<HttpRange>& range) const
{
  const std::string address = this->Place.GetAddress(path);
  return range ? address + "#" + range->Write() : address;
}

std::uint64_t RemoteKeys::GetStampOf(const Known& known)
{
  const std::string& text =
    known.Validator.Tag.empty() ? known.Validator.Modified : known.Validator.Tag;
  return dsm::HashBytes(text.data(), text.size(), known.Total);
}

std::optional<RemoteKeys::Known> RemoteKeys::Find(const std::string& path) const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  const auto known = this->Keys.find(path);
  return known == this->Keys.end() ? std::nullopt : std::optional<Known>(known->second);
}

void RemoteKeys::Note(const std::string& path, const Known& now) const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Keys.size() >= MostKnownKeys)
  {
    this->Keys.clear();
  }
  const Known& known = this->Keys.emplace(path, now).first->second;
  if (known.Validator != now.Validator || known.Total != now.Total)
  {
    throw FileError(path, "changed or was replaced after it was opened. Reload it.");
  }
}

std::optional<RemoteKeys::Answer> RemoteKeys::Ask(
  const std::string& path, const std::optional<HttpRange>& range, std::uint64_t most) const
{
  RefuseToWait();
  const std::string name = NameKept(path, range);
  const std::optional<Known> known = this->Find(path);
  // Those who share the folder may have asked meanwhile.
  const auto find = [&](bool& isSure) -> std::optional<Answer>
  {
    auto kept = this->Kept.Find(name, most);
    if (!kept)
    {
      isSure = false;
      return std::nullopt;
    }
    const Known now{ kept->Validator, kept->Total };
    isSure = known ? known->Validator == now.Validator : kept->Checked > this->OpenedAt;
    return Answer{ now, std::move(kept->Body) };
  };
  bool isSure = false;
  std::optional<Answer> answer = find(isSure);
  if (!isSure)
  {
    const KeptAnswers::Claim claim(this->Kept, name, GetLongestClaim());
    answer = find(isSure);
    if (!isSure)
    {
      HttpClient::Request request;
      request.Path = path;
      request.Range = range;
      request.Most = most;
      request.If = answer ? answer->Of.Validator : HttpValidator();
      HttpClient::Answer told = HttpClient::Get(this->Place, request, this->GoesOn);
      switch (told.How)
      {
        case HttpClient::Outcome::Missing:
          return std::nullopt;
        case HttpClient::Outcome::Unchanged:
          this->Kept.Confirm(name);
          break;
        default:
          this->Kept.Keep(name, told.Validator, told.Total, told.Body);
          answer = Answer{ { told.Validator, told.Total }, std::move(told.Body) };
      }
    }
  }
  this->Note(path, answer->Of);
  return answer;
}

std::shared_ptr<const StampedSource> RemoteKeys::Fetch(
  const std::string& path, std::uint64_t most) const
{
  std::optional<Answer> answer = this->Ask(path, {}, most);
  return answer ? std::make_shared<FetchedKey>(
                    path, this->NameKept(path, {}), std::move(answer->Body), GetStampOf(answer->Of))
                : nullptr;
}

std::shared_ptr<const StampedSource> RemoteKeys::Open(
  const std::string& path, const HttpRange& first) const
{
  RefuseToWait();
  if (const auto known = this->Find(path))
  {
    return std::make_shared<Parts>(this->shared_from_this(), path, *known);
  }
  std::optional<Answer> answer = this->Ask(path, first, first.Bytes);
  if (!answer)
  {
    return nullptr;
  }
  auto parts = std::make_shared<Parts>(this->shared_from_this(), path, answer->Of);
  parts->SetBeginning(first, std::move(answer->Body));
  return parts;
}

void RemoteKeys::AddStamp(const std::string& path, bricks::ByteHash& hash) const
{
  if (const auto known = this->Find(path))
  {
    hash.Add(known->Validator.Tag.data(), known->Validator.Tag.size());
    hash.Add(known->Validator.Modified.data(), known->Validator.Modified.size());
    hash.Add(&known->Total, sizeof(known->Total));
  }
}

void RemoteKeys::CheckThere(const std::string& path) const
{
  RefuseToWait();
  const auto known = this->Find(path);
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    const auto now = std::chrono::steady_clock::now();
    if (now - this->CheckedAt < LeastBetweenChecks)
    {
      return;
    }
    this->CheckedAt = now;
  }
  HttpClient::Request request;
  request.Path = path;
  request.If = known ? known->Validator : HttpValidator();
  request.Most = FileLimits::JsonBytes;
  const HttpClient::Answer answer = HttpClient::Get(this->Place, request, this->GoesOn);
  if (answer.How == HttpClient::Outcome::Missing)
  {
    throw FileError(path, "was deleted after it was opened.");
  }
  if (answer.How == HttpClient::Outcome::Here)
  {
    this->Note(path, { answer.Validator, answer.Body.size() });
  }
}

} // namespace vol
