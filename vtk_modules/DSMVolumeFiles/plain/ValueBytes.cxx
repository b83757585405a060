// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/plain/ValueBytes.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/ReadingManner.h"

#include <algorithm>

namespace vol
{

namespace
{

/// A process may have 1024 files open, as a rule; a brick lies in 33 slices.
constexpr std::size_t MostOpen = 64;

} // namespace

ValueBytes::ValueBytes(std::string path, std::vector<ValuePart> parts, std::uint64_t partBytes)
  : Path(std::move(path))
  , Parts(std::move(parts))
  , PartBytes(partBytes)
{
  this->Get(0);
}

std::shared_ptr<const PositionedFile> ValueBytes::Find(std::size_t part) const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  const auto known = std::find_if(
    this->Open.begin(), this->Open.end(), [=](const auto& one) { return one.first == part; });
  if (known == this->Open.end())
  {
    return nullptr;
  }
  this->Open.splice(this->Open.begin(), this->Open, known);
  return known->second;
}

std::shared_ptr<const PositionedFile> ValueBytes::Get(std::size_t part) const
{
  if (auto file = this->Find(part))
  {
    return file;
  }
  if (WithoutWaiting::IsInForce())
  {
    throw WouldWait{};
  }
  auto file = std::make_shared<const PositionedFile>(this->Parts[part].Path);
  if (file->GetStamp() != this->Parts[part].Stamp)
  {
    throw FileError(file->GetPath(), "changed after it was opened. Reload it.");
  }
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Open.emplace_front(part, file);
  if (this->Open.size() > MostOpen)
  {
    this->Open.pop_back();
  }
  return file;
}

template <class Visit>
void ValueBytes::ForEachPart(const std::vector<Piece>& pieces, const Visit& visit) const
{
  std::vector<Piece> own;
  std::size_t part = 0;
  std::size_t bytes = 0;
  const auto flush = [&]
  {
    if (!own.empty())
    {
      visit(part, std::move(own), bytes);
    }
    own.clear();
    bytes = 0;
  };
  for (const Piece& piece : pieces)
  {
    for (std::size_t done = 0; done < piece.Bytes;)
    {
      const std::uint64_t at = piece.Offset + done;
      const auto next = static_cast<std::size_t>(at / this->PartBytes);
      const std::uint64_t inside = at % this->PartBytes;
      const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>(piece.Bytes - done, this->PartBytes - inside));
      if (next != part)
      {
        flush();
        part = next;
      }
      own.push_back({ this->Parts[part].Offset + inside, count });
      bytes += count;
      done += count;
    }
  }
  flush();
}

void ValueBytes::Read(const std::vector<Piece>& pieces, std::byte* out) const
{
  this->ForEachPart(pieces,
    [&](std::size_t part, const std::vector<Piece>& own, std::size_t bytes)
    {
      this->Get(part)->Read(own, out);
      out += bytes;
    });
}

void ValueBytes::Prefetch(std::vector<Piece> pieces) const
{
  std::sort(pieces.begin(), pieces.end(),
    [](const auto& one, const auto& other) { return one.Offset < other.Offset; });
  this->ForEachPart(pieces,
    [&](std::size_t part, std::vector<Piece> own, std::size_t)
    {
      if (const auto file = this->Find(part))
      {
        file->Prefetch(std::move(own));
      }
    });
}

} // namespace vol
