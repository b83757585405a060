// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfChunkLayout.h"

#include "DSMVolumeFiles/base/FileLimits.h"

#include <cstddef>

namespace vol
{

namespace
{

/// Pieces of an object header; their messages may lead from one to the next, also in a circle.
constexpr std::size_t MostParts = 1000;

/// Looks for the layout among the messages of an object header.
class HeaderReader
{
public:
  explicit HeaderReader(const PositionedFile& file)
    : File(file)
  {
  }

  std::optional<HdfChunkLayout> Find(std::uint64_t header)
  {
    const std::optional<HdfBytes> start = HdfBytes::Read(this->File, header, 32);
    if (!start)
    {
      return std::nullopt;
    }
    if (start->Begins("OHDR"))
    {
      const std::uint64_t flags = start->Get(5, 1);
      const std::size_t before = 6 + ((flags & 32) != 0 ? 16 : 0) + ((flags & 16) != 0 ? 4 : 0);
      const std::size_t width = std::size_t(1) << (flags & 3);
      if (start->Get(4, 1) != 2 || !start->Has(before, width))
      {
        return std::nullopt;
      }
      this->IsCompact = true;
      this->Prefix = (flags & 4) != 0 ? 6 : 4;
      this->Add(
        header, before + width + start->Get(before, width) + HdfBytes::Checksum, before + width);
    }
    else if (start->Get(0, 1) == 1)
    {
      this->Add(header, 16 + start->Get(8, 4), 16);
    }
    // More are appended while they are read.
    for (std::size_t part = 0; part < this->Parts.size() && part < MostParts; ++part)
    {
      const auto [first, count, before] = this->Parts[part];
      const std::optional<HdfBytes> messages = HdfBytes::Read(this->File, first, count);
      if (!messages || (this->IsCompact && !messages->HasRightChecksum()) ||
        this->ReadMessages(*messages, before))
      {
        break;
      }
    }
    return this->Layout;
  }

private:
  struct Part
  {
    std::uint64_t First;
    std::uint64_t Count;
    std::size_t Before; ///< its bytes before the messages
  };

  void Add(std::uint64_t first, std::uint64_t count, std::size_t before)
  {
    this->Parts.push_back({ first, count, before });
  }

  /// Returns true when the layout was among them.
  bool ReadMessages(const HdfBytes& messages, std::size_t place)
  {
    const std::size_t end = messages.GetCount() - (this->IsCompact ? HdfBytes::Checksum : 0);
    while (place < end && this->Prefix <= end - place)
    {
      const std::uint64_t kind = messages.Get(place, this->IsCompact ? 1 : 2);
      const std::size_t count = messages.Get(place + (this->IsCompact ? 1 : 2), 2);
      place += this->Prefix;
      if (count > end - place)
      {
        return false;
      }
      if (kind == 0x08)
      {
        this->ReadLayout(messages, place, place + count);
        return true;
      }
      if (kind == 0x10 && count >= 16)
      {
        // A piece of the newer format begins with a signature.
        this->Add(messages.Get(place, 8), messages.Get(place + 8, 8), this->IsCompact ? 4 : 0);
      }
      place += count;
    }
    return false;
  }

  void ReadLayout(const HdfBytes& messages, std::size_t place, std::size_t end)
  {
    const auto take = [&](std::size_t count) -> std::uint64_t
    {
      if (count > end - place)
      {
        this->IsCut = true;
        return 0;
      }
      place += count;
      return messages.Get(place - count, count);
    };
    HdfChunkLayout layout;
    const std::uint64_t version = take(1);
    const std::uint64_t ofLayout = take(1);
    constexpr std::uint64_t chunked = 2;
    if (ofLayout != chunked || (version != 3 && version != 4))
    {
      return;
    }
    const std::uint64_t flags = version == 4 ? take(1) : 0;
    const std::uint64_t axes = take(1);
    if (axes < 2 || axes > FileLimits::Axes + 1)
    {
      return;
    }
    const auto takeEdges = [&](std::size_t width)
    {
      for (std::uint64_t axis = 0; axis < axes; ++axis)
      {
        layout.Edges.push_back(take(width));
      }
    };
    if (version == 3)
    {
      layout.Address = take(8);
      takeEdges(4);
    }
    else
    {
      const std::size_t width = take(1);
      if (width < 1 || width > 8)
      {
        return;
      }
      takeEdges(width);
      if (!this->ReadIndexKind(take, flags, layout))
      {
        return;
      }
      layout.Address = take(8);
    }
    if (!this->IsCut)
    {
      this->Layout = std::move(layout);
    }
  }

  /// Returns whether the kind of index is known here. Its parameters are repeated in the header of
  /// the index, except for a single chunk's.
  template <class Take>
  static bool ReadIndexKind(const Take& take, std::uint64_t flags, HdfChunkLayout& layout)
  {
    using Index = HdfChunkLayout::Index;
    constexpr std::pair<Index, std::size_t> kinds[] = { { Index::Single, 0 },
      { Index::Implicit, 0 }, { Index::FixedArray, 1 }, { Index::ExtensibleArray, 5 },
      { Index::Tree2, 6 } };
    const std::uint64_t kind = take(1);
    if (kind < 1 || kind > std::size(kinds))
    {
      return false;
    }
    layout.Kind = kinds[kind - 1].first;
    take(kinds[kind - 1].second);
    layout.IsFiltered = layout.Kind == Index::Single && (flags & 2) != 0;
    if (layout.IsFiltered)
    {
      layout.SingleBytes = take(8);
      layout.SingleSkippedFilters = static_cast<std::uint32_t>(take(4));
    }
    return true;
  }

  const PositionedFile& File;
  bool IsCompact = false; ///< true for the newer format, with checksums
  std::size_t Prefix = 8; ///< bytes before a message
  bool IsCut = false;     ///< the message is shorter than it has to be
  std::vector<Part> Parts;
  std::optional<HdfChunkLayout> Layout;
};

} // namespace

std::optional<HdfChunkLayout> HdfChunkLayout::Find(const PositionedFile& file, std::uint64_t header)
{
  return HeaderReader(file).Find(header);
}

} // namespace vol
