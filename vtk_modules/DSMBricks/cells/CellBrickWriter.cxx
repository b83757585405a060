// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/CellBrickWriter.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace bricks
{

namespace
{

constexpr std::size_t GroupSize = CellBrickHeader::GroupSize;
constexpr std::uint16_t NoNumber = 65535;

/// Returns where a part of so many bytes begins, and moves the offset behind it.
std::uint32_t Take(std::uint32_t& offset, std::size_t bytes)
{
  const std::uint32_t start = offset;
  offset += static_cast<std::uint32_t>((bytes + 15) / 16 * 16);
  return start;
}

/// By x, then y, then z.
bool IsPlaceBefore(const float* one, const float* other)
{
  return std::lexicographical_compare(one, one + 3, other, other + 3);
}

} // namespace

RecordBrick CellBrickWriter::Write(
  const std::vector<float>& points, const std::vector<std::uint16_t>& corners, int cornersOfCell)
{
  CellBrickHeader header{};
  header.Points = static_cast<std::uint16_t>(points.size() / 3);
  header.Corners = static_cast<std::uint16_t>(cornersOfCell);
  this->OrderCells(cornersOfCell, points, corners);
  this->WriteGroups(header, points, corners);
  this->OrderedPoints.clear();
  for (const std::uint16_t point : this->PointOrder)
  {
    const float* const place = points.data() + 3 * std::size_t(point);
    this->OrderedPoints.insert(this->OrderedPoints.end(), place, place + 3);
  }
  header.Cells = static_cast<std::uint16_t>(this->Order.size());
  header.Groups = static_cast<std::uint16_t>(this->Heads.size());
  return this->Assemble(header, this->OrderedPoints, {});
}

RecordBrick CellBrickWriter::WriteGrid(const std::vector<float>& points,
  const std::uint16_t cells[3], const std::vector<std::uint8_t>& shown)
{
  CellBrickHeader header{};
  header.Points = static_cast<std::uint16_t>(points.size() / 3);
  header.Corners = CellGroup::MostCorners;
  std::copy_n(cells, 3, header.GridCells);
  std::uint32_t groups[3];
  CellBrick::GetGroupsOfGrid(cells, groups);
  header.Groups = static_cast<std::uint16_t>(groups[0] * groups[1] * groups[2]);
  const std::size_t row = cells[0] + std::size_t(1);
  const std::size_t slice = row * (cells[1] + std::size_t(1));
  std::vector<SplitCode> splits;
  splits.reserve(std::size_t(cells[0]) * cells[1] * cells[2]);
  for (std::size_t z = 0; z < cells[2]; ++z)
  {
    for (std::size_t y = 0; y < cells[1]; ++y)
    {
      for (std::size_t x = 0; x < cells[0]; ++x)
      {
        if (!shown.empty() && shown[splits.size()] == 0)
        {
          splits.push_back(CellBrickHeader::Hidden);
          continue;
        }
        const auto getPlace = [&](int corner)
        {
          const auto bits = static_cast<std::size_t>(HexahedronCorner(corner));
          return points.data() +
            3 * (x + (bits & 1) + row * (y + (bits >> 1 & 1)) + slice * (z + (bits >> 2)));
        };
        splits.push_back(FindSplit(
          [&](int one, int other) { return IsPlaceBefore(getPlace(one), getPlace(other)); }));
      }
    }
  }
  this->Heads.clear();
  this->Bytes.clear();
  return this->Assemble(header, points, splits);
}

void CellBrickWriter::WriteGroups(const CellBrickHeader& header, const std::vector<float>& points,
  const std::vector<std::uint16_t>& corners)
{
  this->PointOrder.clear();
  this->NewNumbers.assign(points.size() / 3, NoNumber);
  this->Heads.clear();
  this->Bytes.clear();
  for (std::size_t first = 0; first < this->Order.size(); first += GroupSize)
  {
    this->WriteGroup(
      header, first, std::min(GroupSize, this->Order.size() - first), points, corners);
  }
}

void CellBrickWriter::WriteGroup(const CellBrickHeader& header, std::size_t first,
  std::size_t count, const std::vector<float>& points, const std::vector<std::uint16_t>& corners)
{
  const std::size_t each = header.Corners;
  CellGroupHead head{ static_cast<std::uint32_t>(this->Bytes.size()),
    static_cast<std::uint16_t>(this->PointOrder.size()), 0, 0 };
  const auto getCorners = [&](std::size_t cell)
  { return corners.data() + this->Order[first + cell] * each; };
  std::uint16_t old[CellGroup::MostPoints];
  for (std::size_t cell = 0; cell < count; ++cell)
  {
    for (std::size_t corner = 0; corner < each; ++corner)
    {
      const std::uint16_t point = getCorners(cell)[corner];
      std::uint16_t& number = this->NewNumbers[point];
      if (number == NoNumber)
      {
        number = static_cast<std::uint16_t>(this->PointOrder.size());
        this->PointOrder.push_back(point);
        ++head.New;
      }
      else if (number < head.FirstNew && std::find(old, old + head.Old, number) == old + head.Old)
      {
        old[head.Old++] = number;
      }
    }
  }
  this->Heads.push_back(head);
  if (each == CellGroup::MostCorners)
  {
    for (std::size_t cell = 0; cell < count; ++cell)
    {
      const auto getPlace = [&](int corner)
      { return points.data() + 3 * std::size_t(getCorners(cell)[corner]); };
      this->Bytes.push_back(std::byte(FindSplit(
        [&](int one, int other) { return IsPlaceBefore(getPlace(one), getPlace(other)); })));
    }
  }
  const std::size_t begin = this->Bytes.size();
  const auto bits = static_cast<std::size_t>(head.GetBitsOfCorner());
  const auto bitsOfPoint = static_cast<std::size_t>(header.GetBitsOfPoint());
  const std::size_t all = count * each * bits + head.Old * bitsOfPoint;
  this->Bytes.resize(begin + (all + 7) / 8 + sizeof(std::uint64_t));
  std::size_t bit = 0;
  const auto write = [&](std::uint64_t number, std::size_t size)
  {
    WriteBits(this->Bytes.data() + begin, bit, number);
    bit += size;
  };
  for (std::size_t cell = 0; cell < count; ++cell)
  {
    for (std::size_t corner = 0; corner < each; ++corner)
    {
      const std::uint16_t number = this->NewNumbers[getCorners(cell)[corner]];
      write(number >= head.FirstNew
          ? number - head.FirstNew
          : head.New + static_cast<std::size_t>(std::find(old, old + head.Old, number) - old),
        bits);
    }
  }
  std::for_each(old, old + head.Old, [&](std::uint16_t number) { write(number, bitsOfPoint); });
  this->Bytes.resize(begin + (all + 7) / 8);
}

void CellBrickWriter::OrderCells(
  int cornersOfCell, const std::vector<float>& points, const std::vector<std::uint16_t>& corners)
{
  const auto each = static_cast<std::size_t>(cornersOfCell);
  const std::size_t count = corners.size() / each;
  this->Centers.assign(3 * count, 0.0f);
  for (std::size_t cell = 0; cell < count; ++cell)
  {
    for (std::size_t corner = 0; corner < each; ++corner)
    {
      const float* const point = points.data() + 3 * std::size_t(corners[cell * each + corner]);
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        this->Centers[3 * cell + axis] += point[axis];
      }
    }
  }
  this->Order.resize(count);
  std::iota(this->Order.begin(), this->Order.end(), 0u);
  this->Divide(0, count);
}

void CellBrickWriter::Divide(std::size_t begin, std::size_t end)
{
  const std::size_t count = end - begin;
  if (count <= GroupSize)
  {
    return;
  }
  float lower[3];
  float upper[3];
  std::copy_n(this->Centers.data() + 3 * std::size_t(this->Order[begin]), 3, lower);
  std::copy_n(lower, 3, upper);
  for (std::size_t index = begin + 1; index < end; ++index)
  {
    const float* const center = this->Centers.data() + 3 * std::size_t(this->Order[index]);
    for (int axis = 0; axis < 3; ++axis)
    {
      lower[axis] = std::min(lower[axis], center[axis]);
      upper[axis] = std::max(upper[axis], center[axis]);
    }
  }
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
  {
    longest = upper[axis] - lower[axis] > upper[longest] - lower[longest] ? axis : longest;
  }
  const std::size_t half = (count / 2 + GroupSize - 1) / GroupSize * GroupSize;
  const auto first = this->Order.begin() + static_cast<std::ptrdiff_t>(begin);
  std::nth_element(first, first + static_cast<std::ptrdiff_t>(half),
    this->Order.begin() + static_cast<std::ptrdiff_t>(end),
    [&](std::uint32_t one, std::uint32_t other)
    {
      const float a = this->Centers[3 * std::size_t(one) + longest];
      const float b = this->Centers[3 * std::size_t(other) + longest];
      return a != b ? a < b : one < other;
    });
  this->Divide(begin, begin + half);
  this->Divide(begin + half, end);
}

std::uint32_t CellBrickWriter::MeasureGroups(const std::byte* block)
{
  const CellBrick brick(block);
  std::uint32_t cells = 0;
  this->Boxes.clear();
  this->Groups.clear();
  CellGroup group;
  for (std::uint32_t number = 0; number < brick.GetHeader().Groups; ++number)
  {
    brick.ReadGroup(number, group);
    if (group.Cells > 0)
    {
      float places[CellGroup::MostPoints][4] = {};
      brick.ReadPlaces(group, places);
      BoundingBox box;
      for (int cell = 0; cell < group.Cells; ++cell)
      {
        for (int corner = 0; corner < group.Corners; ++corner)
        {
          box.Add(Float4::Load(places[group.At[cell][corner]]));
        }
      }
      this->Boxes.push_back(box);
      this->Groups.push_back(number);
      cells += static_cast<std::uint32_t>(group.Cells);
    }
  }
  return cells;
}

RecordBrick CellBrickWriter::Assemble(
  CellBrickHeader header, const std::vector<float>& points, const std::vector<SplitCode>& splits)
{
  // The parts behind the nodes first: the nodes are about the cells, which are read from them.
  header.Places = PackedPlaces::Measure(points);
  std::uint32_t offset = CellBrickHeader::NodeOffset;
  header.PointOffset = Take(offset, PackedPlaces::CountBytes(header.Places, header.Points));
  const std::size_t headBytes = this->Heads.size() * sizeof(CellGroupHead);
  // A reader of the last corners reads eight bytes.
  header.GroupOffset =
    this->Heads.empty() ? 0 : Take(offset, headBytes + this->Bytes.size() + sizeof(std::uint64_t));
  header.SplitOffset = splits.empty() ? 0 : Take(offset, splits.size());
  std::vector<std::byte> bytes(offset);
  std::memcpy(bytes.data(), &header, sizeof(header));
  PackedPlaces::Write(header.Places, points, bytes.data() + header.PointOffset);
  if (!this->Heads.empty())
  {
    std::memcpy(bytes.data() + header.GroupOffset, this->Heads.data(), headBytes);
    std::memcpy(
      bytes.data() + header.GroupOffset + headBytes, this->Bytes.data(), this->Bytes.size());
  }
  if (!splits.empty())
  {
    std::memcpy(bytes.data() + header.SplitOffset, splits.data(), splits.size());
  }

  RecordBrick brick;
  header.Cells = static_cast<std::uint16_t>(this->MeasureGroups(bytes.data()));
  if (header.Cells == 0)
  {
    return brick;
  }
  for (const BoundingBox& box : this->Boxes)
  {
    brick.Bounds.Add(box);
  }
  this->Tree.Build(this->Boxes);
  std::vector<CellBrick::Node> nodes = this->Tree.GetNodes();
  for (CellBrick::Node& node : nodes)
  {
    for (int child = 0; child < node.Children; ++child)
    {
      std::uint16_t& reference = node.References[child];
      if (reference & CellBrick::Node::LeafBit)
      {
        const std::uint32_t item = this->Tree.GetOrder()[CellBrick::GetGroup(reference)];
        reference = static_cast<std::uint16_t>(CellBrick::Node::LeafBit | this->Groups[item]);
      }
    }
  }
  const auto nodeBytes = static_cast<std::uint32_t>(nodes.size() * sizeof(CellBrick::Node));
  header.Nodes = static_cast<std::uint16_t>(nodes.size());
  header.BlockBytes = offset + nodeBytes;
  header.PointOffset += nodeBytes;
  header.GroupOffset += header.GroupOffset == 0 ? 0 : nodeBytes;
  header.SplitOffset += header.SplitOffset == 0 ? 0 : nodeBytes;
  brick.Bytes.resize(header.BlockBytes);
  std::memcpy(brick.Bytes.data(), &header, sizeof(header));
  std::memcpy(brick.Bytes.data() + CellBrickHeader::NodeOffset, nodes.data(), nodeBytes);
  std::memcpy(brick.Bytes.data() + CellBrickHeader::NodeOffset + nodeBytes,
    bytes.data() + CellBrickHeader::NodeOffset, offset - CellBrickHeader::NodeOffset);
  return brick;
}

} // namespace bricks
