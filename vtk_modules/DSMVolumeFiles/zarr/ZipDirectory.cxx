// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZipDirectory.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/MemorySource.h"
#include "DSMVolumeFiles/codec/StreamDecoder.h"

#include <algorithm>
#include <utility>

namespace vol
{

namespace
{

// Parts of an archive, in PKWARE's APPNOTE 6.3.10: the section, the signature, and the bytes without what varies.
constexpr std::uint32_t LocalSignature = 0x04034b50; // 4.3.7
constexpr std::size_t LocalBytes = 30;
constexpr std::uint32_t MemberSignature = 0x02014b50; // 4.3.12
constexpr std::size_t MemberBytes = 46;
constexpr std::uint32_t LargeEndSignature = 0x06064b50; // 4.3.14
constexpr std::size_t LargeEndBytes = 56;
constexpr std::uint32_t LocatorSignature = 0x07064b50; // 4.3.15
constexpr std::size_t LocatorBytes = 20;
constexpr std::uint32_t EndSignature = 0x06054b50; // 4.3.16
constexpr std::size_t EndBytes = 22;
constexpr std::size_t MostComment = 0xffff;
constexpr std::uint16_t LargeNumbers = 1; // 4.5.3

/// Numbers that stand elsewhere since they have more bits.
constexpr std::uint32_t Elsewhere = 0xffffffffu;

constexpr std::uint16_t Stored = 0;
constexpr std::uint16_t Deflated = 8;
/// By which deflate may make chunks larger, and more.
constexpr std::uint64_t LargestExcess = 1 << 20;

template <class T>
T Get(const std::byte* at)
{
  T number = 0;
  for (std::size_t byte = 0; byte < sizeof(T); ++byte)
  {
    number |= static_cast<T>(static_cast<T>(std::to_integer<std::uint8_t>(at[byte])) << (8 * byte));
  }
  return number;
}

template <class T>
void Append(T number, ByteBuffer& bytes)
{
  for (std::size_t byte = 0; byte < sizeof(T); ++byte)
  {
    bytes.push_back(static_cast<std::byte>(number >> (8 * byte) & 0xff));
  }
}

bool IsLess(const ZipDirectory::Member& member, const std::string& name)
{
  return member.Name < name;
}

/// Some bytes of an archive.
class StoredMember final : public StampedSource
{
public:
  StoredMember(std::shared_ptr<const StampedSource> archive, std::string path, std::uint64_t begin,
    std::uint64_t bytes)
    : Archive(std::move(archive))
    , Path(std::move(path))
    , Begin(begin)
    , Bytes(bytes)
  {
  }

  const std::string& GetPath() const override { return this->Path; }
  std::uint64_t GetBytes() const override { return this->Bytes; }
  std::uint64_t GetStamp() const override { return this->Archive->GetStamp(); }
  void Read(const std::vector<Piece>& pieces, std::byte* out) const override
  {
    for (const Piece& piece : pieces)
    {
      if (piece.Bytes > this->Bytes || piece.Offset > this->Bytes - piece.Bytes)
      {
        throw FileError(this->Path, "is too short.");
      }
    }
    this->Archive->Read(this->Move(pieces), out);
  }
  void Prefetch(std::vector<Piece> pieces) const override
  {
    this->Archive->Prefetch(this->Move(std::move(pieces)));
  }
  void Doubt() const override { this->Archive->Doubt(); }

private:
  std::vector<Piece> Move(std::vector<Piece> pieces) const
  {
    for (Piece& piece : pieces)
    {
      piece.Offset += this->Begin;
    }
    return pieces;
  }

  std::shared_ptr<const StampedSource> Archive;
  std::string Path;
  std::uint64_t Begin;
  std::uint64_t Bytes;
};

} // namespace

ZipDirectory::ZipDirectory(std::shared_ptr<const StampedSource> archive)
  : Archive(std::move(archive))
{
  this->ReadMembers(this->FindDirectory());
}

std::vector<ZipDirectory::Member>::const_iterator ZipDirectory::FindFirst(
  const std::string& name) const
{
  return std::lower_bound(this->Members.begin(), this->Members.end(), name, IsLess);
}

const ZipDirectory::Member* ZipDirectory::Find(const std::string& name) const
{
  const auto found = this->FindFirst(name);
  return found != this->Members.end() && found->Name == name ? &*found : nullptr;
}

std::shared_ptr<const StampedSource> ZipDirectory::Open(
  const Member& member, const std::string& path, std::uint64_t most) const
{
  if (member.IsEncrypted)
  {
    throw FileError(path, "is encrypted, which is not supported.");
  }
  const auto header = this->Read(member.Header, LocalBytes);
  if (Get<std::uint32_t>(header.data()) != LocalSignature)
  {
    throw FileError(path, "has no header in its archive, which is damaged.");
  }
  const std::uint64_t begin =
    member.Header + LocalBytes + Get<std::uint16_t>(&header[26]) + Get<std::uint16_t>(&header[28]);
  if (begin > this->Archive->GetBytes() || member.StoredBytes > this->Archive->GetBytes() - begin)
  {
    throw FileError(path, "ends behind its archive, which is damaged.");
  }
  if (member.Method == Stored && member.Bytes == member.StoredBytes)
  {
    return std::make_shared<const StoredMember>(this->Archive, path, begin, member.Bytes);
  }
  if (member.Method != Deflated)
  {
    throw FileError(path,
      "is compressed by method " + std::to_string(member.Method) +
        " of ZIP; only 0 (stored) and 8 (deflate) can be read. Write the archive again without "
        "compression.");
  }
  if (member.Bytes > most || member.StoredBytes > most + LargestExcess ||
    member.Bytes / StreamDecoder::GetMostGrowth(StreamEncoding::Deflate) > member.StoredBytes)
  {
    throw FileError(path, "has more bytes than expected.");
  }
  // Such a stream, with a header and what the directory says of it, is one of gzip (RFC 1952).
  ByteBuffer stored;
  for (const int byte : { 0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 0xff })
  {
    stored.push_back(static_cast<std::byte>(byte));
  }
  const std::size_t at = stored.size();
  stored.resize(at + static_cast<std::size_t>(member.StoredBytes));
  this->Archive->Read({ { begin, static_cast<std::size_t>(member.StoredBytes) } }, &stored[at]);
  Append(member.Checksum, stored);
  Append(static_cast<std::uint32_t>(member.Bytes), stored);
  auto bytes = StreamDecoder::DecodeWhole(
    StreamEncoding::Deflate, stored, static_cast<std::size_t>(member.Bytes));
  if (!bytes || bytes->size() != member.Bytes)
  {
    this->Archive->Doubt();
    throw FileError(path, "is damaged: its deflate stream does not agree with its checksum.");
  }
  return std::make_shared<const MemorySource>(path, std::move(*bytes), this->Archive->GetStamp());
}

ZipDirectory::Place ZipDirectory::FindDirectory() const
{
  const std::uint64_t size = this->Archive->GetBytes();
  const std::uint64_t tail = std::min<std::uint64_t>(size, EndBytes + MostComment);
  const auto bytes = this->Read(size - tail, tail);
  for (std::size_t at = bytes.size() < EndBytes ? 0 : bytes.size() - EndBytes + 1; at-- > 0;)
  {
    const std::byte* const end = &bytes[at];
    if (Get<std::uint32_t>(end) != EndSignature ||
      at + EndBytes + Get<std::uint16_t>(end + 20) != bytes.size())
    {
      continue;
    }
    const std::uint64_t place = size - tail + at;
    if (place >= LocatorBytes)
    {
      const auto locator = this->Read(place - LocatorBytes, LocatorBytes);
      if (Get<std::uint32_t>(locator.data()) == LocatorSignature)
      {
        return this->FindLargeDirectory(Get<std::uint64_t>(&locator[8]));
      }
    }
    const Place found{ Get<std::uint32_t>(end + 16), Get<std::uint32_t>(end + 12),
      Get<std::uint16_t>(end + 10) };
    if (Get<std::uint16_t>(end + 4) != 0 || Get<std::uint16_t>(end + 8) != found.Members)
    {
      this->Refuse("is a part of a ZIP archive in several parts, which cannot be read.");
    }
    return found;
  }
  this->Refuse("is a damaged ZIP archive: it has no directory at its end. Copy it again.");
}

ZipDirectory::Place ZipDirectory::FindLargeDirectory(std::uint64_t locator) const
{
  const auto end = this->Read(locator, LargeEndBytes);
  if (Get<std::uint32_t>(end.data()) != LargeEndSignature ||
    Get<std::uint64_t>(&end[24]) != Get<std::uint64_t>(&end[32]))
  {
    this->Refuse("is a damaged ZIP archive, or one in several parts.");
  }
  return { Get<std::uint64_t>(&end[48]), Get<std::uint64_t>(&end[40]),
    Get<std::uint64_t>(&end[32]) };
}

void ZipDirectory::ReadMembers(const Place& place)
{
  CheckLimit(this->Archive->GetPath(), "bytes of names of members", place.Bytes,
    FileLimits::ZipDirectoryBytes);
  const auto bytes = this->Read(place.Begin, place.Bytes);
  const std::string damaged = "is a ZIP archive with a damaged directory. Copy it again.";
  std::size_t at = 0;
  for (std::uint64_t number = 0; number < place.Members; ++number)
  {
    if (bytes.size() - at < MemberBytes || Get<std::uint32_t>(&bytes[at]) != MemberSignature)
    {
      this->Refuse(damaged);
    }
    const std::byte* const entry = &bytes[at];
    const std::size_t nameBytes = Get<std::uint16_t>(entry + 28);
    const std::size_t extraBytes = Get<std::uint16_t>(entry + 30);
    const std::size_t all = MemberBytes + nameBytes + extraBytes + Get<std::uint16_t>(entry + 32);
    if (bytes.size() - at < all)
    {
      this->Refuse(damaged);
    }
    Member member{ std::string(reinterpret_cast<const char*>(entry + MemberBytes), nameBytes),
      Get<std::uint32_t>(entry + 42), Get<std::uint32_t>(entry + 20),
      Get<std::uint32_t>(entry + 24), Get<std::uint32_t>(entry + 16),
      Get<std::uint16_t>(entry + 10), (Get<std::uint16_t>(entry + 8) & 1) != 0 };
    const std::byte* extra = entry + MemberBytes + nameBytes;
    const std::byte* const extraEnd = extra + extraBytes;
    while (extraEnd - extra >= 4)
    {
      const std::byte* next = extra + 4 + Get<std::uint16_t>(extra + 2);
      if (next > extraEnd)
      {
        break;
      }
      const std::byte* number64 = extra + 4;
      for (std::uint64_t* wide : { &member.Bytes, &member.StoredBytes, &member.Header })
      {
        if (Get<std::uint16_t>(extra) == LargeNumbers && *wide == Elsewhere && next - number64 >= 8)
        {
          *wide = Get<std::uint64_t>(number64);
          number64 += 8;
        }
      }
      extra = next;
    }
    at += all;
    if (!member.Name.empty() && member.Name.back() != '/')
    {
      this->Members.push_back(std::move(member));
    }
  }
  std::stable_sort(this->Members.begin(), this->Members.end(),
    [](const Member& a, const Member& b) { return a.Name < b.Name; });
}

std::vector<std::byte> ZipDirectory::Read(std::uint64_t begin, std::uint64_t bytes) const
{
  const std::uint64_t size = this->Archive->GetBytes();
  if (bytes > size || begin > size - bytes)
  {
    this->Refuse("is a damaged ZIP archive: a part of it is missing. Copy it again.");
  }
  std::vector<std::byte> read(static_cast<std::size_t>(bytes));
  this->Archive->Read({ { begin, read.size() } }, read.data());
  return read;
}

void ZipDirectory::Refuse(const std::string& what) const
{
  throw FileError(this->Archive->GetPath(), what);
}

} // namespace vol
