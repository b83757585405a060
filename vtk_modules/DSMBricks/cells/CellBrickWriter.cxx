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

/// Returns where a part of so many bytes begins, and moves the offset behind it. Four bytes behind each part are
/// within the block, for points that are read as four floats.
std::uint32_t Take(std::uint32_t& offset, std::size_t bytes)
{
  const std::uint32_t start = offset;
  offset += static_cast<std::uint32_t>((bytes + 4 + 15) / 16 * 16);
  return start;
}

} // namespace

RecordBrick CellBrickWriter::Write(
  const std::vector<float>& points, std::vector<std::uint16_t>& corners, int cornersOfCell)
{
  this->OrderCells(cornersOfCell, points, corners);
  this->Ordered.resize(corners.size());
  const auto each = static_cast<std::size_t>(cornersOfCell);
  for (std::size_t cell = 0; cell < this->Order.size(); ++cell)
  {
    std::copy_n(
      corners.data() + this->Order[cell] * each, each, this->Ordered.data() + cell * each);
  }
  corners.swap(this->Ordered);
  CellBrickHeader header{};
  header.Corners = static_cast<std::uint16_t>(cornersOfCell);
  header.Cells = static_cast<std::uint16_t>(this->Order.size());
  header.Groups = static_cast<std::uint16_t>((this->Order.size() + GroupSize - 1) / GroupSize);
  return this->Assemble(header, points, corners, {});
}

RecordBrick CellBrickWriter::WriteGrid(const std::vector<float>& points,
  const std::uint16_t cells[3], const std::vector<std::uint8_t>& shown)
{
  CellBrickHeader header{};
  header.Corners = CellBrick::MostCorners;
  std::copy_n(cells, 3, header.GridCells);
  std::uint32_t groups[3];
  CellBrick::GetGroupsOfGrid(cells, groups);
  header.Groups = static_cast<std::uint16_t>(groups[0] * groups[1] * groups[2]);
  return this->Assemble(header, points, {}, shown);
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
  const CellBrickHeader& header = brick.GetHeader();
  std::uint32_t cells = 0;
  this->Boxes.clear();
  this->Groups.clear();
  for (std::uint32_t group = 0; group < header.Groups; ++group)
  {
    std::uint16_t corners[CellBrick::GroupSize][CellBrick::MostCorners];
    const int count = brick.ReadGroup(group, corners);
    if (count > 0)
    {
      BoundingBox box;
      for (int cell = 0; cell < count; ++cell)
      {
        for (int corner = 0; corner < header.Corners; ++corner)
        {
          box.Add(Float4::Load(brick.GetPoint(corners[cell][corner])));
        }
      }
      this->Boxes.push_back(box);
      this->Groups.push_back(group);
      cells += static_cast<std::uint32_t>(count);
    }
  }
  return cells;
}

RecordBrick CellBrickWriter::Assemble(CellBrickHeader header, const std::vector<float>& points,
  const std::vector<std::uint16_t>& corners, const std::vector<std::uint8_t>& shown)
{
  // The parts behind the nodes first: the nodes are about the cells, which are read from them.
  header.Points = static_cast<std::uint16_t>(points.size() / 3);
  std::uint32_t offset = CellBrickHeader::NodeOffset;
  header.PointOffset = Take(offset, points.size() * sizeof(float));
  header.CornerOffset = corners.empty() ? 0 : Take(offset, corners.size() * sizeof(std::uint16_t));
  header.ShownOffset = shown.empty() ? 0 : Take(offset, shown.size());
  std::vector<std::byte> bytes(offset);
  std::memcpy(bytes.data(), &header, sizeof(header));
  std::memcpy(bytes.data() + header.PointOffset, points.data(), points.size() * sizeof(float));
  if (!corners.empty())
  {
    std::memcpy(
      bytes.data() + header.CornerOffset, corners.data(), corners.size() * sizeof(std::uint16_t));
  }
  if (!shown.empty())
  {
    std::memcpy(bytes.data() + header.ShownOffset, shown.data(), shown.size());
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
  header.CornerOffset += corners.empty() ? 0 : nodeBytes;
  header.ShownOffset += shown.empty() ? 0 : nodeBytes;
  brick.Bytes.resize(header.BlockBytes);
  std::memcpy(brick.Bytes.data(), &header, sizeof(header));
  std::memcpy(brick.Bytes.data() + CellBrickHeader::NodeOffset, nodes.data(), nodeBytes);
  std::memcpy(brick.Bytes.data() + CellBrickHeader::NodeOffset + nodeBytes,
    bytes.data() + CellBrickHeader::NodeOffset, offset - CellBrickHeader::NodeOffset);
  return brick;
}

} // namespace bricks
