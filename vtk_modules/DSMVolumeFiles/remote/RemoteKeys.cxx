// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/remote/RemoteKeys.h"

#include "DSMCore/base/ByteDigest.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
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
    throw WouldWait{ true };
  }
}

/// Who waits for another one to fetch the same bytes does so about as long as that one may take.
std::chrono::seconds GetLongestClaim()
{
  return std::chrono::seconds(2 * HttpLimits::Get().Seconds);
}

/// A key in memory.
class FetchedKey final : public StampedSource
{
public:
  FetchedKey(std::string path, ByteBuffer bytes, std::uint64_t stamp)
    : Path(std::move(path))
    , Bytes(std::move(bytes))
    , Stamp(stamp)
  {
  }

  const std::string& GetPath() const override { return this->Path; }
  std::uint64_t GetBytes() const override { return this->Bytes.size(); }
  std::uint64_t GetStamp() const override { return this->Stamp; }
  void Prefetch(std::vector<Piece>) const override {}
  void Doubt() const override { KeptAnswers::GetShared().Drop(this->Path); }

  void Read(const std::vector<Piece>& pieces, std::byte* out) const override
  {
    for (const Piece& piece : pieces)
    {
      if (piece.Offset > this->Bytes.size() || piece.Bytes > this->Bytes.size() - piece.Offset)
      {
        throw FileError(this->Path,
          "ends at byte " + std::to_string(this->Bytes.size()) + ", where more are expected.");
      }
      out = std::copy_n(this->Bytes.data() + piece.Offset, piece.Bytes, out);
    }
  }

private:
  std::string Path;
  ByteBuffer Bytes;
  std::uint64_t Stamp;
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
  void SetBeginning(std::uint64_t offset, ByteBuffer bytes)
  {
    this->Offset = offset;
    this->Bytes = std::move(bytes);
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
    const std::string name = this->Path + "#" + part.Write();
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      this->Names.push_back(name);
    }
    return this->Keys->ReadPart(this->Path, name, this->Whole, part);
  }

  std::shared_ptr<const RemoteKeys> Keys;
  std::string Path;
  Known Whole;
  std::uint64_t Offset = 0;
  ByteBuffer Bytes; ///< from Offset on
  mutable std::mutex Guard;
  mutable std::vector<std::string> Names; ///< of what is kept of it
};

RemoteKeys::RemoteKeys(const std::string& url, std::function<bool()> goesOn)
  : Place(url)
  , GoesOn(std::move(goesOn))
  , Kept(KeptAnswers::GetShared())
  , OpenedAt(KeptAnswers::Time::clock::now())
{
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

std::shared_ptr<const StampedSource> RemoteKeys::Fetch(
  const std::string& path, std::uint64_t most) const
{
  RefuseToWait();
  const auto make = [&](const HttpValidator& validator, ByteBuffer bytes)
  {
    const Known now{ validator, bytes.size() };
    this->Note(path, now);
    return std::make_shared<FetchedKey>(path, std::move(bytes), GetStampOf(now));
  };
  const std::optional<Known> known = this->Find(path);
  // Those who share the folder may have asked meanwhile.
  const auto isSure = [&](const std::optional<KeptAnswers::Kept>& kept) {
    return kept && (known ? known->Validator == kept->Validator : kept->Checked > this->OpenedAt);
  };
  auto kept = this->Kept.Find(path, most);
  if (isSure(kept))
  {
    return make(kept->Validator, std::move(kept->Body));
  }
  const KeptAnswers::Claim claim(this->Kept, path, GetLongestClaim());
  kept = this->Kept.Find(path, most);
  if (isSure(kept))
  {
    return make(kept->Validator, std::move(kept->Body));
  }
  HttpClient::Request request;
  request.Path = path;
  request.Most = most;
  request.If = kept ? kept->Validator : HttpValidator();
  HttpClient::Answer answer = HttpClient::Get(this->Place, request, this->GoesOn);
  switch (answer.How)
  {
    case HttpClient::Outcome::Missing:
      return nullptr;
    case HttpClient::Outcome::Unchanged:
      this->Kept.Confirm(path);
      return make(kept->Validator, std::move(kept->Body));
    default:
      this->Kept.Keep(path, answer.Validator, answer.Body.size(), answer.Body);
      return make(answer.Validator, std::move(answer.Body));
  }
}

std::shared_ptr<const StampedSource> RemoteKeys::Open(
  const std::string& path, const HttpRange& first) const
{
  RefuseToWait();
  if (const auto known = this->Find(path))
  {
    return std::make_shared<Parts>(this->shared_from_this(), path, *known);
  }
  HttpClient::Request request;
  request.Path = path;
  request.Range = first;
  request.Most = first.Bytes;
  HttpClient::Answer answer = HttpClient::Get(this->Place, request, this->GoesOn);
  if (answer.How != HttpClient::Outcome::Here)
  {
    return nullptr;
  }
  const Known now{ answer.Validator, answer.Total };
  this->Note(path, now);
  auto parts = std::make_shared<Parts>(this->shared_from_this(), path, now);
  const std::uint64_t offset = first.FromEnd ? now.Total - answer.Body.size() : first.Offset;
  parts->SetBeginning(offset, std::move(answer.Body));
  return parts;
}

ByteBuffer RemoteKeys::ReadPart(
  const std::string& path, const std::string& name, const Known& known, const HttpRange& part) const
{
  RefuseToWait();
  const auto find = [&]() -> std::optional<ByteBuffer>
  {
    auto kept = this->Kept.Find(name, part.Bytes);
    const bool isRight = kept && kept->Validator == known.Validator && kept->Total == known.Total &&
      kept->Body.size() == part.Bytes;
    return isRight ? std::optional<ByteBuffer>(std::move(kept->Body)) : std::nullopt;
  };
  if (auto bytes = find())
  {
    return std::move(*bytes);
  }
  const KeptAnswers::Claim claim(this->Kept, name, GetLongestClaim());
  if (auto bytes = find())
  {
    return std::move(*bytes);
  }
  HttpClient::Request request;
  request.Path = path;
  request.Range = part;
  request.Most = part.Bytes;
  HttpClient::Answer answer = HttpClient::Get(this->Place, request, this->GoesOn);
  if (answer.How != HttpClient::Outcome::Here)
  {
    throw FileError(path, "was deleted after it was opened.");
  }
  this->Note(path, { answer.Validator, answer.Total });
  if (answer.Validator != known.Validator || answer.Total != known.Total ||
    answer.Body.size() != part.Bytes)
  {
    throw FileError(path, "changed or was replaced after it was opened. Reload it.");
  }
  this->Kept.Keep(name, answer.Validator, answer.Total, answer.Body);
  return std::move(answer.Body);
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
