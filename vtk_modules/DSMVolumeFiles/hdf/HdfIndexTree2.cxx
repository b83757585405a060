// SPDX-License-Identifier: BSD-3-Clause
// The B-tree, version 2, in which HDF5 keeps where chunks are: "HDF5 File Format Specification", III.A.2.
#include "DSMVolumeFiles/hdf/HdfChunkIndex.h"

#include <algorithm>

namespace vol
{

namespace
{

constexpr std::size_t NodePrefixBytes = 4 + 1 + 1; ///< prefix of a node: signature, version, type
constexpr std::uint64_t MostLevels = 32;

/// Bytes that hold any number up to this one, as the library counts them.
std::size_t CountBytesFor(std::uint64_t most)
{
  std::size_t bytes = 1;
  while (most >>= 8)
  {
    ++bytes;
  }
  return bytes;
}

class Tree
{
public:
  Tree(HdfChunkIndex& reader, const HdfBytes& header)
    : Reader(reader)
    , IsFiltered(header.Get(5, 1) == 11)
    , NodeBytes(header.Get(6, 4))
    , RecordBytes(header.Get(10, 2))
    , Depth(header.Get(12, 2))
  {
    const std::size_t placeBytes = 8 * reader.GetAxes();
    this->EntryBytes = this->RecordBytes - std::min(this->RecordBytes, placeBytes);
    this->IsRight = (this->IsFiltered || header.Get(5, 1) == 10) && this->Depth <= MostLevels &&
      HdfChunkIndex::IsEntry(this->IsFiltered, this->EntryBytes) && this->FindLevels();
  }

  bool Read(std::uint64_t root, std::uint64_t records)
  {
    return this->IsRight &&
      (root == HdfUndefined ||
        this->ReadNode(root, records, static_cast<std::size_t>(this->Depth)));
  }

private:
  /// Properties of the nodes of a level; level 0 has the leaves.
  struct Level
  {
    std::uint64_t MostRecords = 0;
    std::uint64_t MostBelow = 0;  ///< records of a node and of all below it
    std::size_t PointerBytes = 0; ///< to a node of the level below
  };

  bool FindLevels()
  {
    const std::size_t own = NodePrefixBytes + HdfBytes::Checksum;
    if (this->NodeBytes < own + this->RecordBytes)
    {
      return false;
    }
    const std::uint64_t leaf = (this->NodeBytes - own) / this->RecordBytes;
    this->Levels.push_back({ leaf, leaf, 0 });
    this->CountBytes = CountBytesFor(leaf);
    for (std::uint64_t level = 1; level <= this->Depth; ++level)
    {
      const std::uint64_t below = this->Levels.back().MostBelow;
      Level made;
      made.PointerBytes =
        HdfBytes::Address + this->CountBytes + (level > 1 ? CountBytesFor(below) : 0);
      if (this->NodeBytes < own + made.PointerBytes + this->RecordBytes)
      {
        return false;
      }
      made.MostRecords =
        (this->NodeBytes - own - made.PointerBytes) / (this->RecordBytes + made.PointerBytes);
      if (below > (UINT64_MAX >> 1) / (made.MostRecords + 1))
      {
        return false; // more than a file has
      }
      made.MostBelow = (made.MostRecords + 1) * below + made.MostRecords;
      this->Levels.push_back(made);
    }
    return true;
  }

  bool ReadNode(std::uint64_t address, std::uint64_t records, std::size_t level)
  {
    const Level& own = this->Levels[level];
    const std::size_t children = NodePrefixBytes + records * this->RecordBytes;
    const std::size_t end = children + (level > 0 ? (records + 1) * own.PointerBytes : 0);
    if (records > own.MostRecords)
    {
      return false;
    }
    const auto node =
      this->Reader.ReadChecked(address, end + HdfBytes::Checksum, level > 0 ? "BTIN" : "BTLF");
    if (!node)
    {
      return false;
    }
    for (std::uint64_t record = 0; record < records; ++record)
    {
      if (!this->AddRecord(*node, NodePrefixBytes + record * this->RecordBytes))
      {
        return false;
      }
    }
    for (std::size_t child = children; child < end; child += own.PointerBytes)
    {
      if (!this->ReadNode(node->Get(child, HdfBytes::Address),
            node->Get(child + HdfBytes::Address, this->CountBytes), level - 1))
      {
        return false;
      }
    }
    return true;
  }

  bool AddRecord(const HdfBytes& node, std::size_t place)
  {
    std::vector<std::uint64_t>& chunk = this->Place;
    chunk.resize(this->Reader.GetAxes());
    for (std::size_t axis = 0; axis < chunk.size(); ++axis)
    {
      chunk[axis] = node.Get(place + this->EntryBytes + 8 * axis, 8);
    }
    return this->Reader.Add(chunk.data(), this->Reader.GetChunk(node, place, this->EntryBytes));
  }

  HdfChunkIndex& Reader;
  bool IsFiltered;
  std::uint64_t NodeBytes;
  std::size_t RecordBytes;
  std::uint64_t Depth;
  std::size_t EntryBytes = 0; ///< bytes of a record, without the chunk's place
  std::size_t CountBytes = 0; ///< bytes of the number of records in a pointer
  std::vector<Level> Levels;
  std::vector<std::uint64_t> Place;
  bool IsRight = false;
};

} // namespace

bool HdfChunkIndex::ReadTree2(std::uint64_t address)
{
  const std::optional<HdfBytes> header = this->ReadChecked(address, 38, "BTHD");
  return header &&
    Tree(*this, *header).Read(header->Get(16, HdfBytes::Address), header->Get(24, 2));
}

} // namespace vol
