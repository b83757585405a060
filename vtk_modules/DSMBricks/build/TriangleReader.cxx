// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/TriangleReader.h"

#include "DSMBricks/build/TriangleBrickBuilder.h"
#include "DSMBricks/layout/OctahedralNormal.h"
#include "DSMBricks/layout/PlaceInBrick.h"
#include "DSMBricks/layout/TriangleBrickHeader.h"
#include "DSMCore/base/Error.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace bricks
{

namespace
{

std::uint32_t GetBits(float value)
{
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/// Exactly zero only when the three points lie on a line, or so nearly that rounding hides it.
bool HasArea(const float corners[9])
{
  double first[3];
  double second[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    first[axis] = static_cast<double>(corners[3 + axis]) - corners[axis];
    second[axis] = static_cast<double>(corners[6 + axis]) - corners[axis];
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const int y = (axis + 1) % 3;
    const int z = (axis + 2) % 3;
    if (first[y] * second[z] != first[z] * second[y])
    {
      return true;
    }
  }
  return false;
}

} // namespace

TriangleReader::TriangleReader(const TriangleSource& source, const MeshAttributes& attributes)
  : Source(source)
  , Attributes(attributes)
  , Layout(attributes)
{
}

RecordKind TriangleReader::GetKind() const
{
  return { "mesh", this->Attributes.Radii ? "tubes and spheres" : "triangles",
    this->Layout.GetBytes(), this->EstimateBrickBytes(), TriangleBrickHeader::LargestTriangles };
}

double TriangleReader::EstimateBrickBytes() const
{
  // A scanned surface has half as many points as triangles, and some are in several bricks.
  constexpr double verticesOfSurface = 0.6;
  constexpr double nodeBytesOfSurface = 5.0;
  // Tubes have a leaf each.
  constexpr double verticesOfTubes = 1.1;
  constexpr double nodeBytesOfTubes = 28.0;
  const MeshAttributes& has = this->Attributes;
  const double verticesPerTriangle = has.Radii ? verticesOfTubes : verticesOfSurface;
  const double nodeBytes = has.Radii ? nodeBytesOfTubes : nodeBytesOfSurface;
  const auto bytesOf = [=](Attachment attachment, double bytes)
  {
    return attachment == Attachment::None
      ? 0.0
      : bytes * (attachment == Attachment::Points ? verticesPerTriangle : 1.0);
  };
  return nodeBytes + 3 * sizeof(std::uint16_t) + verticesPerTriangle * sizeof(TriangleBrickVertex) +
    bytesOf(has.Values, 4.0) + bytesOf(has.Colors, 4.0) +
    bytesOf(has.TextureCoordinates ? Attachment::Points : Attachment::None, 8.0);
}

std::unique_ptr<RecordBrickBuilder> TriangleReader::CreateBuilder(
  const MortonCode& order, std::uint32_t largestCount) const
{
  return std::make_unique<TriangleBrickBuilder>(this->Attributes, order, largestCount);
}

PositionBounds TriangleReader::FindBounds(int threads) const
{
  return FindPositionBounds(threads, this->GetCount(),
    [this](std::uint64_t triangle, PositionBounds& bounds)
    {
      double positions[9];
      double radii[3];
      if (this->ReadPositions(triangle, positions) && this->ReadRadii(triangle, radii))
      {
        for (int corner = 0; corner < 3; ++corner)
        {
          const glm::dvec3 position = glm::make_vec3(positions + 3 * corner);
          bounds.Add(position - radii[corner]);
          if (this->Attributes.Radii)
          {
            bounds.Add(position + radii[corner]);
          }
        }
      }
    });
}

void TriangleReader::SetSpace(const BrickSpace& space, int)
{
  this->Space = space;
}

bool TriangleReader::ReadPositions(std::uint64_t triangle, double positions[9]) const
{
  const TriangleSource& source = this->Source;
  std::uint64_t points[3];
  source.GetTriangle(triangle, points);
  bool finite = true;
  for (int corner = 0; corner < 3; ++corner)
  {
    if (points[corner] >= source.GetPointCount())
    {
      throw dsm::Error("Triangle " + std::to_string(triangle) + " of the mesh refers to point " +
        std::to_string(points[corner]) + ", but the mesh has only " +
        std::to_string(source.GetPointCount()) + " points. Check the dataset's cells.");
    }
    double* position = positions + 3 * corner;
    source.GetPosition(points[corner], position);
    finite = finite && std::isfinite(position[0]) && std::isfinite(position[1]) &&
      std::isfinite(position[2]);
  }
  return finite;
}

bool TriangleReader::ReadRadii(std::uint64_t triangle, double radii[3]) const
{
  std::fill_n(radii, 3, 0.0);
  if (!this->Attributes.Radii)
  {
    return true;
  }
  for (int corner = 0; corner < 3; ++corner)
  {
    radii[corner] = this->Source.GetRadius(triangle, corner);
  }
  return std::all_of(radii, radii + 3, [](double radius) { return std::isfinite(radius); }) &&
    std::any_of(radii, radii + 3, [](double radius) { return radius > 0.0; });
}

std::uint64_t TriangleReader::FindCode(std::uint64_t triangle, const MortonCode& order) const
{
  float corners[9];
  int turned[3];
  return this->ReadCorners(triangle, corners, turned) ? order.GetOfTriangle(corners) : NoCode;
}

void TriangleReader::FindCodes(
  std::uint64_t begin, std::uint64_t end, const MortonCode& order, std::uint64_t* codes) const
{
  for (std::uint64_t triangle = begin; triangle < end; ++triangle)
  {
    codes[triangle - begin] = this->FindCode(triangle, order);
  }
}

bool TriangleReader::ReadCorners(std::uint64_t triangle, float corners[9], int order[3]) const
{
  double positions[9];
  if (!this->ReadPositions(triangle, positions))
  {
    return false;
  }
  float read[9];
  for (int word = 0; word < 9; word += 3)
  {
    PlaceInBrick(this->Space, positions + word, read + word);
  }
  double radii[3];
  if (!this->ReadRadii(triangle, radii))
  {
    return false;
  }
  int first = 0;
  for (int corner = 1; corner < 3 && !this->Attributes.Radii; ++corner)
  {
    if (std::lexicographical_compare(
          read + 3 * corner, read + 3 * corner + 3, read + 3 * first, read + 3 * first + 3))
    {
      first = corner;
    }
  }
  for (int corner = 0; corner < 3; ++corner)
  {
    order[corner] = (first + corner) % 3;
    std::copy_n(read + 3 * order[corner], 3, corners + 3 * corner);
  }
  return this->Attributes.Radii || HasArea(corners);
}

template <class GetWord>
void TriangleReader::WriteElements(Attachment attachment, std::uint64_t triangle,
  const std::uint64_t points[3], std::uint32_t* words, GetWord&& getWord)
{
  if (attachment == Attachment::Triangles)
  {
    *words = getWord(triangle);
  }
  else if (attachment == Attachment::Points)
  {
    std::transform(points, points + 3, words, getWord);
  }
}

void TriangleReader::ReadRecord(std::uint64_t triangle, std::uint32_t* record) const
{
  float corners[9];
  int order[3];
  this->ReadCorners(triangle, corners, order);
  std::memcpy(record, corners, sizeof(corners));
  std::uint64_t read[3];
  this->Source.GetTriangle(triangle, read);
  const std::uint64_t points[3] = { read[order[0]], read[order[1]], read[order[2]] };

  if (this->Attributes.Normals != Attachment::None)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      const bool own = this->Attributes.Normals == Attachment::Triangles;
      double normal[3];
      this->Source.GetNormal(own ? triangle : points[corner], normal);
      record[this->Layout.Normals + corner] = OctahedralNormal::Pack(normal);
    }
  }
  if (this->Attributes.Radii)
  {
    double radii[3];
    this->ReadRadii(triangle, radii);
    std::transform(radii, radii + 3, record + this->Layout.Normals,
      [this](double radius)
      { return GetBits(static_cast<float>(radius / this->Space.Scale) + 0.0f); });
  }
  WriteElements(this->Attributes.Values, triangle, points, record + this->Layout.Values,
    [this](std::uint64_t element)
    { return GetBits(static_cast<float>(this->Source.GetValue(element)) + 0.0f); });
  WriteElements(this->Attributes.Colors, triangle, points, record + this->Layout.Colors,
    [this](std::uint64_t element)
    {
      std::uint8_t rgba[4];
      this->Source.GetColor(element, rgba);
      std::uint32_t word;
      std::memcpy(&word, rgba, sizeof(word));
      return word;
    });
  if (this->Attributes.TextureCoordinates)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      double coordinate[2];
      this->Source.GetTextureCoordinate(points[corner], coordinate);
      std::uint32_t* words = record + this->Layout.TextureCoordinates + 2 * corner;
      words[0] = GetBits(static_cast<float>(coordinate[0]) + 0.0f);
      words[1] = GetBits(static_cast<float>(coordinate[1]) + 0.0f);
    }
  }
  if (this->Attributes.EdgeFlags)
  {
    const unsigned flags = this->Source.GetEdgeFlags(triangle);
    std::uint32_t turned = 0;
    for (int side = 0; side < 3; ++side)
    {
      turned |= (flags >> order[side] & 1u) << side;
    }
    record[this->Layout.EdgeFlags] = turned;
  }
}

void TriangleReader::ReadRecords(
  const std::uint64_t* triangles, std::size_t count, std::uint32_t* records) const
{
  const std::size_t words = this->Layout.GetBytes() / sizeof(std::uint32_t);
  for (std::size_t number = 0; number < count; ++number)
  {
    this->ReadRecord(triangles[number], records + number * words);
  }
}

} // namespace bricks
