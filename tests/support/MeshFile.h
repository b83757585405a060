// SPDX-License-Identifier: BSD-3-Clause
#ifndef MeshFile_h
#define MeshFile_h

#include "tests/support/TriangleArrays.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

/// Positions and faces (as fans) of files in the formats PLY (all three encodings) and OBJ.
namespace MeshFile
{

using Mesh = TriangleArrays<float>;

inline void AddFan(Mesh& mesh, const std::vector<std::uint64_t>& points)
{
  for (std::size_t corner = 2; corner < points.size(); ++corner)
  {
    mesh.Triangles.insert(mesh.Triangles.end(), { points[0], points[corner - 1], points[corner] });
  }
}

inline Mesh ReadObj(std::istream& stream)
{
  Mesh mesh;
  for (std::string line; std::getline(stream, line);)
  {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v")
    {
      float position[3] = {};
      words >> position[0] >> position[1] >> position[2];
      mesh.Positions.insert(mesh.Positions.end(), position, position + 3);
    }
    else if (kind == "f")
    {
      std::vector<std::uint64_t> points;
      for (std::string corner; words >> corner;)
      {
        const long number = std::stol(corner); // up to the first slash
        points.push_back(number > 0 ? static_cast<std::uint64_t>(number - 1)
                                    : mesh.GetPointCount() - static_cast<std::uint64_t>(-number));
      }
      AddFan(mesh, points);
    }
  }
  return mesh;
}

/// Reads the numbers of a PLY file, one by one.
class PlyNumbers
{
public:
  PlyNumbers(std::istream& stream, const std::string& encoding)
    : Stream(stream)
    , Text(encoding == "ascii")
    , Swapped(encoding == "binary_big_endian")
  {
  }

  double Read(const std::string& type)
  {
    if (this->Text)
    {
      double number = 0.0;
      this->Stream >> number;
      return number;
    }
    static const std::map<std::string, std::string> names{ { "int8", "char" }, { "uint8", "uchar" },
      { "int16", "short" }, { "uint16", "ushort" }, { "int32", "int" }, { "uint32", "uint" },
      { "float32", "float" }, { "float64", "double" } };
    const auto known = names.find(type);
    const std::string& name = known == names.end() ? type : known->second;
    return name == "char" ? this->ReadAs<std::int8_t>()
      : name == "uchar"   ? this->ReadAs<std::uint8_t>()
      : name == "short"   ? this->ReadAs<std::int16_t>()
      : name == "ushort"  ? this->ReadAs<std::uint16_t>()
      : name == "int"     ? this->ReadAs<std::int32_t>()
      : name == "uint"    ? this->ReadAs<std::uint32_t>()
      : name == "float"   ? this->ReadAs<float>()
                          : this->ReadAs<double>();
  }

private:
  template <class T>
  double ReadAs()
  {
    char bytes[sizeof(T)] = {};
    this->Stream.read(bytes, sizeof(T));
    if (this->Swapped)
    {
      std::reverse(bytes, bytes + sizeof(T));
    }
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return static_cast<double>(value);
  }

  std::istream& Stream;
  bool Text;
  bool Swapped;
};

inline Mesh ReadPly(std::istream& stream)
{
  struct Property
  {
    std::string Name;
    std::string Type;
    std::string CountType; ///< of a list
  };
  struct Element
  {
    std::string Name;
    std::uint64_t Count = 0;
    std::vector<Property> Properties;
  };
  std::string encoding;
  std::vector<Element> elements;
  for (std::string line; std::getline(stream, line);)
  {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "format")
    {
      words >> encoding;
    }
    else if (kind == "element")
    {
      elements.emplace_back();
      words >> elements.back().Name >> elements.back().Count;
    }
    else if (kind == "property")
    {
      Property property;
      words >> property.Type;
      if (property.Type == "list")
      {
        words >> property.CountType >> property.Type;
      }
      words >> property.Name;
      elements.back().Properties.push_back(property);
    }
    else if (kind == "end_header")
    {
      break;
    }
  }
  Mesh mesh;
  PlyNumbers numbers(stream, encoding);
  for (const Element& element : elements)
  {
    for (std::uint64_t index = 0; index < element.Count; ++index)
    {
      for (const Property& property : element.Properties)
      {
        if (!property.CountType.empty())
        {
          std::vector<std::uint64_t> points(
            static_cast<std::size_t>(numbers.Read(property.CountType)));
          for (std::uint64_t& point : points)
          {
            point = static_cast<std::uint64_t>(numbers.Read(property.Type));
          }
          AddFan(mesh, points);
          continue;
        }
        const double number = numbers.Read(property.Type);
        if (property.Name == "x" || property.Name == "y" || property.Name == "z")
        {
          mesh.Positions.push_back(static_cast<float>(number));
        }
      }
    }
  }
  return mesh;
}

/// Throws dsm::Error when the file cannot be opened or has no triangles.
inline Mesh Read(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  const bool isObj = path.size() > 4 && path.substr(path.size() - 4) == ".obj";
  Mesh mesh = isObj ? ReadObj(stream) : ReadPly(stream);
  if (!stream.is_open() || mesh.Triangles.empty())
  {
    throw dsm::Error(path + " cannot be opened, or holds no triangles in the format PLY or OBJ.");
  }
  return mesh;
}

/// Unit normals of the points: the mean of the faces around, by area.
inline void AddNormals(Mesh& mesh)
{
  std::vector<double> sums(mesh.Positions.size(), 0.0);
  for (std::uint64_t triangle = 0; triangle < mesh.GetTriangleCount(); ++triangle)
  {
    const std::uint64_t* points = mesh.Triangles.data() + 3 * triangle;
    double edges[2][3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double start = mesh.Positions[3 * points[0] + axis];
      edges[0][axis] = mesh.Positions[3 * points[1] + axis] - start;
      edges[1][axis] = mesh.Positions[3 * points[2] + axis] - start;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const int y = (axis + 1) % 3;
      const int z = (axis + 2) % 3;
      const double normal = edges[0][y] * edges[1][z] - edges[0][z] * edges[1][y];
      for (int corner = 0; corner < 3; ++corner)
      {
        sums[3 * points[corner] + axis] += normal;
      }
    }
  }
  // Not of unit length: what takes them must not mind.
  mesh.Normals.assign(sums.begin(), sums.end());
}

/// Cuts every triangle into four `times` times, at the middles of its edges; points are shared.
inline Mesh Subdivide(const Mesh& coarse, int times)
{
  Mesh mesh = coarse;
  for (int time = 0; time < times; ++time)
  {
    std::vector<std::uint64_t> edges; // smaller point << 32 | larger point
    for (std::size_t corner = 0; corner < mesh.Triangles.size(); ++corner)
    {
      const std::size_t other = corner % 3 == 2 ? corner - 2 : corner + 1;
      const auto ends = std::minmax(mesh.Triangles[corner], mesh.Triangles[other]);
      edges.push_back(ends.first << 32 | ends.second);
    }
    std::vector<std::uint64_t> sorted = edges;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    const std::uint64_t points = mesh.GetPointCount();
    for (const std::uint64_t edge : sorted)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        mesh.Positions.push_back(0.5f *
          (mesh.Positions[3 * (edge >> 32) + axis] +
            mesh.Positions[3 * (edge & 0xffffffffu) + axis]));
      }
    }
    std::vector<std::uint64_t> triangles;
    triangles.reserve(4 * mesh.Triangles.size());
    for (std::size_t triangle = 0; triangle < mesh.Triangles.size(); triangle += 3)
    {
      std::uint64_t middles[3];
      for (int edge = 0; edge < 3; ++edge)
      {
        middles[edge] = points +
          static_cast<std::uint64_t>(
            std::lower_bound(sorted.begin(), sorted.end(), edges[triangle + edge]) -
            sorted.begin());
      }
      const std::uint64_t* p = mesh.Triangles.data() + triangle;
      triangles.insert(triangles.end(),
        { p[0], middles[0], middles[2], middles[0], p[1], middles[1], middles[2], middles[1], p[2],
          middles[0], middles[1], middles[2] });
    }
    mesh.Triangles = std::move(triangles);
  }
  return mesh;
}

} // namespace MeshFile

#endif
