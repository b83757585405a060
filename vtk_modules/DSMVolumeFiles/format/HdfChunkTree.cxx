// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/HdfChunkTree.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>

namespace vol
{

namespace
{

constexpr std::uint64_t Undefined = UINT64_MAX;
/// An object header or a node of the tree is never as large as this.
constexpr std::uint64_t LargestPart = std::uint64_t(1) << 26;
constexpr int MostLevels = 32;

/// Some bytes of the file: numbers are little-endian there.
class Bytes
{
public:
  /// Nothing where the file ends before.
  static std::optional<Bytes> Read(
    const PositionedFile& file, std::uint64_t offset, std::uint64_t count)
  {
    if (count > LargestPart || offset > file.GetBytes() || count > file.GetBytes() - offset)
    {
      return std::nullopt;
    }
    Bytes bytes;
    bytes.Values.resize(count);
    file.Read(offset, bytes.Values.data(), bytes.Values.size());
    return bytes;
  }

  std::size_t GetCount() const { return this->Values.size(); }
  bool Has(std::size_t place, std::size_t count) const
  {
    return place <= this->Values.size() && count <= this->Values.size() - place;
  }
  std::uint64_t Get(std::size_t place, std::size_t count) const
  {
    std::uint64_t number = 0;
    for (std::size_t byte = count; byte > 0; --byte)
    {
      number = number << 8 | static_cast<std::uint64_t>(this->Values[place + byte - 1]);
    }
    return number;
  }
  bool Begins(const char* signature) const
  {
    return this->Has(0, 4) && std::memcmp(this->Values.data(), signature, 4) == 0;
  }

private:
  std::vector<std::byte> Values;
};

/// Looks for the root of the tree among the messages of an object header.
class HeaderReader
{
public:
  HeaderReader(const PositionedFile& file, std::size_t axes)
    : File(file)
    , Axes(axes)
  {
  }

  /// Where the root is, which may be nowhere; nothing where the file has another layout.
  std::optional<std::uint64_t> FindRoot(std::uint64_t header)
  {
    const std::optional<Bytes> start = Bytes::Read(this->File, header,
      std::min<std::uint64_t>(32, this->File.GetBytes() - std::min(header, this->File.GetBytes())));
    if (!start || !start->Has(0, 32))
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
      this->HasOrder = (flags & 4) != 0;
      this->Add(header + before + width, start->Get(before, width));
    }
    else if (start->Get(0, 1) == 1)
    {
      this->Add(header + 16, start->Get(8, 4));
    }
    // More are appended while they are read; a file whose parts lead round in a circle ends, too.
    for (std::size_t part = 0; part < this->Parts.size() && part < 1000; ++part)
    {
      const auto [first, count] = this->Parts[part];
      const std::optional<Bytes> messages = Bytes::Read(this->File, first, count);
      if (!messages || this->ReadMessages(*messages))
      {
        break;
      }
    }
    return this->Root;
  }

private:
  struct Part
  {
    std::uint64_t First;
    std::uint64_t Count;
  };

  void Add(std::uint64_t first, std::uint64_t count) { this->Parts.push_back({ first, count }); }

  /// True when the layout was among them.
  bool ReadMessages(const Bytes& messages)
  {
    const std::size_t prefix = !this->IsCompact ? 8 : this->HasOrder ? 6 : 4;
    for (std::size_t place = 0; messages.Has(place, prefix);)
    {
      const std::uint64_t kind = messages.Get(place, this->IsCompact ? 1 : 2);
      const std::size_t count = messages.Get(place + (this->IsCompact ? 1 : 2), 2);
      place += prefix;
      if (!messages.Has(place, count))
      {
        return false;
      }
      if (kind == 0x08)
      {
        this->ReadLayout(messages, place, count);
        return true;
      }
      if (kind == 0x10 && count >= 16)
      {
        // Of the newer kind, between a signature and a checksum.
        const std::uint64_t around = this->IsCompact ? 4 : 0;
        const std::uint64_t bytes = messages.Get(place + 8, 8);
        this->Add(messages.Get(place, 8) + around, bytes - std::min(bytes, 2 * around));
      }
      place += count;
    }
    return false;
  }

  void ReadLayout(const Bytes& messages, std::size_t place, std::size_t count)
  {
    if (count >= 11 && messages.Get(place, 1) == 3 && messages.Get(place + 1, 1) == 2 &&
      messages.Get(place + 2, 1) == this->Axes + 1)
    {
      this->Root = messages.Get(place + 3, 8);
    }
  }

  const PositionedFile& File;
  std::size_t Axes;
  bool IsCompact = false;
  bool HasOrder = false;
  std::vector<Part> Parts;
  std::optional<std::uint64_t> Root;
};

class NodeReader
{
public:
  NodeReader(const PositionedFile& file, std::size_t axes, const HdfChunkTree::Visit& visit)
    : File(file)
    , KeyBytes(8 + 8 * (axes + 1))
    , First(axes)
    , Tell(visit)
  {
  }

  bool Read(std::uint64_t address, int level)
  {
    constexpr std::size_t start = 24;
    const std::optional<Bytes> head = Bytes::Read(this->File, address, start);
    if (!head || !head->Begins("TREE") || head->Get(4, 1) != 1)
    {
      return false;
    }
    const int own = static_cast<int>(head->Get(5, 1));
    if (own > MostLevels || (level >= 0 && own != level))
    {
      return false;
    }
    const std::size_t children = head->Get(6, 2);
    const std::size_t step = this->KeyBytes + 8;
    const std::optional<Bytes> list = Bytes::Read(this->File, address + start, children * step);
    if (!list)
    {
      return false;
    }
    for (std::size_t place = 0; place < list->GetCount(); place += step)
    {
      const std::uint64_t child = list->Get(place + this->KeyBytes, 8);
      if (own > 0 ? !this->Read(child, own - 1) : !this->Add(*list, place, child))
      {
        return false;
      }
    }
    return true;
  }

private:
  bool Add(const Bytes& list, std::size_t key, std::uint64_t address)
  {
    const HdfChunk chunk{ address, static_cast<std::uint32_t>(list.Get(key, 4)),
      static_cast<std::uint32_t>(list.Get(key + 4, 4)) };
    for (std::size_t axis = 0; axis < this->First.size(); ++axis)
    {
      this->First[axis] = list.Get(key + 8 + 8 * axis, 8);
    }
    this->Tell(this->First.data(), chunk);
    return address != Undefined;
  }

  const PositionedFile& File;
  std::size_t KeyBytes;
  std::vector<std::uint64_t> First;
  const HdfChunkTree::Visit& Tell;
};

} // namespace

bool HdfChunkTree::Read(
  const PositionedFile& file, std::uint64_t header, std::size_t axes, const Visit& visit)
{
  const std::optional<std::uint64_t> root = HeaderReader(file, axes).FindRoot(header);
  // Nowhere: no chunk has been written.
  return root && (*root == Undefined || NodeReader(file, axes, visit).Read(*root, -1));
}

} // namespace vol
