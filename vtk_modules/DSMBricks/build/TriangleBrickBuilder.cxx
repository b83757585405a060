// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/TriangleBrickBuilder.h"

#include "DSMBricks/layout/OctahedralNormal.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace bricks
{

namespace
{

/// Triangles are tested four at a time. Tubes are tested one by one, which takes much longer than the test of a box.
constexpr std::uint32_t LargestLeaf = 4;
constexpr std::uint32_t LargestLeafOfTubes = 1;

/// Adds a ball, rounded outward.
void AddBall(const double center[3], double radius, BoundingBox& box)
{
  constexpr float infinity = std::numeric_limits<float>::infinity();
  float lower[4] = {};
  float upper[4] = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    lower[axis] = std::nextafter(static_cast<float>(center[axis] - radius), -infinity);
    upper[axis] = std::nextafter(static_cast<float>(center[axis] + radius), infinity);
  }
  box.Add(Float4::Load(lower));
  box.Add(Float4::Load(upper));
}

/// Adds all that belongs to the middle one of three points of a tube: balls of all sizes up to the middles of the
/// way to the others, or up to the other for a line of two points.
void AddTube(const float corners[9], const float radii[3], BoundingBox& box)
{
  const bool isWhole = std::equal(corners, corners + 3, corners + 6);
  const double part = isWhole ? 1.0 : 0.5;
  for (int corner = 0; corner < 3; ++corner)
  {
    double center[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double middle = corners[3 + axis];
      center[axis] = middle + part * (corners[3 * corner + axis] - middle);
    }
    const double middleRadius = radii[1];
    AddBall(center, middleRadius + part * (radii[corner] - middleRadius), box);
  }
}

} // namespace

TriangleBrickBuilder::TriangleBrickBuilder(
  const MeshAttributes& attributes, const MortonCode& order, std::uint32_t largestTriangles)
  : Attributes(attributes)
  , Layout(attributes)
  , Order(order)
  , LargestTriangles(std::clamp(largestTriangles, 1u, TriangleBrickHeader::LargestTriangles))
  , Tree(attributes.Radii ? LargestLeafOfTubes : LargestLeaf)
{
  this->VertexWords += attributes.Values == Attachment::Points ? 1 : 0;
  this->VertexWords += attributes.Colors == Attachment::Points ? 1 : 0;
  this->VertexWords += attributes.TextureCoordinates ? 2 : 0;
}

std::vector<RecordBrick> TriangleBrickBuilder::Build(
  const std::uint32_t* records, std::size_t count)
{
  this->Sort(records, count);
  const std::size_t parts = (count + this->LargestTriangles - 1) / this->LargestTriangles;
  std::vector<RecordBrick> bricks;
  bricks.reserve(parts);
  for (std::size_t part = 0; part < parts; ++part)
  {
    const std::size_t begin = count * part / parts;
    const std::size_t end = count * (part + 1) / parts;
    bricks.push_back(
      this->BuildBrick(this->Keys.data() + begin, static_cast<std::uint32_t>(end - begin)));
  }
  return bricks;
}

void TriangleBrickBuilder::Sort(const std::uint32_t* records, std::size_t count)
{
  this->Keys.resize(count);
  for (std::size_t index = 0; index < count; ++index)
  {
    const std::uint32_t* record = records + index * this->Layout.Words;
    float corners[9];
    TriangleRecord::GetCorners(record, corners);
    this->Keys[index] = { this->Order.GetOfTriangle(corners), record };
  }
  std::sort(this->Keys.begin(), this->Keys.end(),
    [words = this->Layout.Words](const Key& a, const Key& b)
    {
      return a.Code != b.Code
        ? a.Code < b.Code
        : std::lexicographical_compare(a.Record, a.Record + words, b.Record, b.Record + words);
    });
}

RecordBrick TriangleBrickBuilder::BuildBrick(const Key* keys, std::uint32_t count)
{
  RecordBrick brick;
  this->MeasureTriangles(keys, count, brick);
  this->Tree.Build(this->Boxes);
  this->CollectVertices(keys, count);
  const TriangleBrickHeader header = this->LayOut(count);
  brick.Bytes.resize(header.BlockBytes);
  std::byte* block = brick.Bytes.data();
  std::memcpy(block, &header, sizeof(header));
  std::memcpy(block + TriangleBrickHeader::NodeOffset, this->Tree.GetNodes().data(),
    this->Tree.GetNodes().size() * sizeof(this->Tree.GetNodes().front()));
  std::memcpy(block + header.TriangleOffset, this->Corners.data(),
    this->Corners.size() * sizeof(std::uint16_t));
  this->WriteElements(keys, header, block);
  return brick;
}

void TriangleBrickBuilder::MeasureTriangles(
  const Key* keys, std::uint32_t count, RecordBrick& brick)
{
  this->Boxes.assign(count, BoundingBox());
  BoundingBox extents;
  for (std::uint32_t triangle = 0; triangle < count; ++triangle)
  {
    BoundingBox& box = this->Boxes[triangle];
    this->MeasureTriangle(keys[triangle].Record, box);
    brick.Bounds.Add(box);
    extents.Add(box.Upper - box.Lower);
  }
  float largest[4];
  extents.Upper.Store(largest);
  this->LargestExtent = this->Attributes.Radii ? std::numeric_limits<float>::infinity()
                                               : std::max({ largest[0], largest[1], largest[2] });
}

void TriangleBrickBuilder::MeasureTriangle(const std::uint32_t* record, BoundingBox& box) const
{
  float corners[9];
  TriangleRecord::GetCorners(record, corners);
  if (this->Attributes.Radii)
  {
    float radii[3];
    std::memcpy(radii, record + this->Layout.Normals, sizeof(radii));
    AddTube(corners, radii, box);
    return;
  }
  for (int corner = 0; corner < 3; ++corner)
  {
    float position[4] = {};
    std::copy_n(corners + 3 * corner, 3, position);
    box.Add(Float4::Load(position));
  }
}

void TriangleBrickBuilder::CollectVertices(const Key* keys, std::uint32_t count)
{
  std::size_t places = 64;
  while (places < 6 * static_cast<std::size_t>(count))
  {
    places *= 2;
  }
  this->Table.assign(places, 0);
  this->Vertices.clear();
  this->Corners.clear();
  for (const std::uint32_t triangle : this->Tree.GetOrder())
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      std::uint32_t words[LargestVertexWords];
      this->GetVertex(keys[triangle].Record, corner, words);
      this->Corners.push_back(this->FindVertex(words));
    }
  }
}

void TriangleBrickBuilder::GetVertex(
  const std::uint32_t* record, int corner, std::uint32_t* words) const
{
  words = std::copy_n(record + 3 * corner, 3, words);
  *words++ =
    this->Layout.HasNormals ? record[this->Layout.Normals + corner] : OctahedralNormal::None;
  if (this->Attributes.Values == Attachment::Points)
  {
    *words++ = record[this->Layout.Values + corner];
  }
  if (this->Attributes.Colors == Attachment::Points)
  {
    *words++ = record[this->Layout.Colors + corner];
  }
  if (this->Attributes.TextureCoordinates)
  {
    std::copy_n(record + this->Layout.TextureCoordinates + 2 * corner, 2, words);
  }
}

std::uint16_t TriangleBrickBuilder::FindVertex(const std::uint32_t* words)
{
  std::uint64_t hash = 0;
  for (int word = 0; word < this->VertexWords; ++word)
  {
    hash = (hash ^ words[word]) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
  }
  const std::size_t mask = this->Table.size() - 1;
  for (std::size_t place = hash & mask;; place = (place + 1) & mask)
  {
    std::uint16_t& entry = this->Table[place];
    if (entry == 0)
    {
      this->Vertices.insert(this->Vertices.end(), words, words + this->VertexWords);
      entry = static_cast<std::uint16_t>(this->Vertices.size() / this->VertexWords);
      return static_cast<std::uint16_t>(entry - 1);
    }
    const std::uint32_t* known = this->Vertices.data() + (entry - 1) * this->VertexWords;
    if (std::equal(words, words + this->VertexWords, known))
    {
      return static_cast<std::uint16_t>(entry - 1);
    }
  }
}

TriangleBrickHeader TriangleBrickBuilder::LayOut(std::uint32_t triangles) const
{
  const auto vertices = static_cast<std::uint32_t>(this->Vertices.size() / this->VertexWords);
  TriangleBrickHeader header{};
  header.Triangles = static_cast<std::uint16_t>(triangles);
  header.Vertices = static_cast<std::uint16_t>(vertices);
  header.Nodes = static_cast<std::uint32_t>(this->Tree.GetNodes().size());
  header.LargestExtent = this->LargestExtent;
  header.Normals = this->Attributes.Normals != Attachment::None;
  header.Values = this->Attributes.Values;
  header.Colors = this->Attributes.Colors;
  header.Radii = this->Attributes.Radii;
  std::uint32_t offset = TriangleBrickHeader::NodeOffset +
    header.Nodes * static_cast<std::uint32_t>(sizeof(WideBvhNode<std::uint16_t>));
  const auto take = [&offset](std::uint32_t bytes)
  {
    const std::uint32_t start = offset;
    offset += (bytes + 15) / 16 * 16;
    return start;
  };
  const auto takeFor = [&](Attachment attachment, std::uint32_t bytes)
  {
    return attachment == Attachment::None
      ? 0
      : take(bytes * (attachment == Attachment::Points ? vertices : triangles));
  };
  header.VertexOffset = take(vertices * static_cast<std::uint32_t>(sizeof(TriangleBrickVertex)));
  header.TriangleOffset = take(6 * (triangles + 3));
  header.ValueOffset = takeFor(this->Attributes.Values, 4);
  header.ColorOffset = takeFor(this->Attributes.Colors, 4);
  header.TextureOffset =
    takeFor(this->Attributes.TextureCoordinates ? Attachment::Points : Attachment::None, 8);
  header.EdgeFlagOffset = this->Attributes.EdgeFlags
    ? take(4 * (triangles / TriangleBrickHeader::EdgeFlagsPerWord + 1))
    : 0;
  header.BlockBytes = offset;
  return header;
}

void TriangleBrickBuilder::WriteElements(
  const Key* keys, const TriangleBrickHeader& header, std::byte* block) const
{
  const auto write = [block](std::uint32_t offset, std::uint32_t index, const std::uint32_t* words,
                       std::uint32_t count)
  { std::memcpy(block + offset + 4 * count * index, words, 4 * count); };
  for (std::uint32_t vertex = 0; vertex < header.Vertices; ++vertex)
  {
    const std::uint32_t* words = this->Vertices.data() + vertex * this->VertexWords;
    write(header.VertexOffset, vertex, words, 4);
    words += 4;
    if (header.Values == Attachment::Points)
    {
      write(header.ValueOffset, vertex, words++, 1);
    }
    if (header.Colors == Attachment::Points)
    {
      write(header.ColorOffset, vertex, words++, 1);
    }
    if (header.TextureOffset != 0)
    {
      write(header.TextureOffset, vertex, words, 2);
    }
  }
  for (std::uint32_t triangle = 0; triangle < header.Triangles; ++triangle)
  {
    const std::uint32_t* record = keys[this->Tree.GetOrder()[triangle]].Record;
    if (header.Values == Attachment::Triangles)
    {
      write(header.ValueOffset, triangle, record + this->Layout.Values, 1);
    }
    if (header.Colors == Attachment::Triangles)
    {
      write(header.ColorOffset, triangle, record + this->Layout.Colors, 1);
    }
    if (header.EdgeFlagOffset != 0)
    {
      constexpr std::uint32_t perWord = TriangleBrickHeader::EdgeFlagsPerWord;
      std::byte* place = block + header.EdgeFlagOffset + 4 * (triangle / perWord);
      std::uint32_t word;
      std::memcpy(&word, place, sizeof(word));
      word |= record[this->Layout.EdgeFlags] << 3 * (triangle % perWord);
      std::memcpy(place, &word, sizeof(word));
    }
  }
}

} // namespace bricks
