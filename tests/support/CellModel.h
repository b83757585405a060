// SPDX-License-Identifier: BSD-3-Clause
#ifndef CellModel_h
#define CellModel_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/cells/CellSource.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

/// Cells that fill a block of boxes, each of which is of one kind, moved to any places.
class CellModel : public bricks::CellSource
{
public:
  using Index3 = bricks::Index3;
  enum class Kind
  {
    Hexahedron,
    Wedges,    ///< two
    Pyramids,  ///< six, around the middle
    Tetrahedra ///< six
  };
  /// Cells that a rank has, and of which kind a box is.
  struct Settings
  {
    Index3 Boxes{ 4 };
    std::function<glm::dvec3(const glm::dvec3&)> Move; ///< from [0, 1]^3; empty: stays
    std::function<Kind(const Index3&)> KindOf;         ///< empty: hexahedra
    std::function<bool(const Index3&)> IsOwn;          ///< empty: all boxes are this rank's
    bool IsGrid = false;                               ///< a structured grid, of hexahedra
    bool OnlyTetrahedra = false;
  };

  explicit CellModel(Settings settings)
    : Model(std::move(settings))
  {
    const Index3 points = this->Model.Boxes + Index3(1);
    bricks::ForEachIndex({ Index3(0), points },
      [&](const Index3& at) { this->AddPoint(glm::dvec3(at) / glm::dvec3(this->Model.Boxes)); });
    if (!this->Model.IsGrid)
    {
      bricks::ForEachIndex({ Index3(0), this->Model.Boxes },
        [&](const Index3& box)
        {
          if (!this->Model.IsOwn || this->Model.IsOwn(box))
          {
            this->AddBox(box);
          }
        });
    }
  }

  std::uint64_t GetCellCount() const override
  {
    const Index3& boxes = this->Model.Boxes;
    return this->Model.IsGrid ? static_cast<std::uint64_t>(boxes.x * boxes.y * boxes.z)
                              : this->Corners.size() / this->GetEach();
  }
  std::uint64_t GetPointCount() const override { return this->Places.size(); }
  std::vector<Grid> GetGrids() const override
  {
    return this->Model.IsGrid ? std::vector<Grid>{ { 0, 0, this->Model.Boxes + Index3(1) } }
                              : std::vector<Grid>();
  }
  bool HasOnlyTetrahedra() const override { return this->Model.OnlyTetrahedra; }
  void GetCorners(std::uint64_t cell, std::uint64_t points[MostCorners]) const override
  {
    if (this->Model.IsGrid)
    {
      this->GetBoxCorners(this->GetBox(cell), points);
      return;
    }
    for (std::size_t corner = 0; corner < this->GetEach(); ++corner)
    {
      points[corner] = this->Corners.at(cell * this->GetEach() + corner);
    }
  }
  bool IsShown(std::uint64_t cell) const override
  {
    return !this->Model.IsGrid || !this->Model.IsOwn || this->Model.IsOwn(this->GetBox(cell));
  }
  void GetPosition(std::uint64_t point, double position[3]) const override
  {
    const glm::dvec3& place = this->Places.at(point);
    position[0] = place.x;
    position[1] = place.y;
    position[2] = place.z;
  }
  const std::vector<glm::dvec3>& GetPlaces() const { return this->Places; }

private:
  std::size_t GetEach() const { return this->Model.OnlyTetrahedra ? 4 : 8; }
  Index3 GetBox(std::uint64_t cell) const
  {
    const Index3& boxes = this->Model.Boxes;
    const auto number = static_cast<std::int64_t>(cell);
    return { number % boxes.x, number / boxes.x % boxes.y, number / (boxes.x * boxes.y) };
  }
  std::uint64_t AddPoint(const glm::dvec3& place)
  {
    this->Places.push_back(this->Model.Move ? this->Model.Move(place) : place);
    return this->Places.size() - 1;
  }
  /// In VTK's order.
  void GetBoxCorners(const Index3& box, std::uint64_t points[8]) const
  {
    const Index3 size = this->Model.Boxes + Index3(1);
    const auto get = [&](int x, int y, int z)
    { return static_cast<std::uint64_t>(box.x + x + size.x * (box.y + y + size.y * (box.z + z))); };
    const std::uint64_t all[8] = { get(0, 0, 0), get(1, 0, 0), get(1, 1, 0), get(0, 1, 0),
      get(0, 0, 1), get(1, 0, 1), get(1, 1, 1), get(0, 1, 1) };
    std::copy_n(all, 8, points);
  }
  void Add(const std::vector<std::uint64_t>& corners)
  {
    this->Corners.insert(this->Corners.end(), corners.begin(), corners.end());
  }
  void AddTetrahedron(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d)
  {
    this->Add(this->Model.OnlyTetrahedra ? std::vector<std::uint64_t>{ a, b, c, d }
                                         : std::vector<std::uint64_t>{ a, b, c, c, d, d, d, d });
  }
  void AddBox(const Index3& box)
  {
    std::uint64_t c[8];
    this->GetBoxCorners(box, c);
    switch (this->Model.KindOf ? this->Model.KindOf(box) : Kind::Hexahedron)
    {
      case Kind::Hexahedron:
        this->Add({ c, c + 8 });
        return;
      case Kind::Wedges:
        this->Add({ c[0], c[1], c[2], c[2], c[4], c[5], c[6], c[6] });
        this->Add({ c[0], c[2], c[3], c[3], c[4], c[6], c[7], c[7] });
        return;
      case Kind::Pyramids:
      {
        const std::uint64_t middle =
          this->AddPoint((glm::dvec3(box) + 0.5) / glm::dvec3(this->Model.Boxes));
        const int faces[6][4] = { { 0, 1, 2, 3 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 }, { 3, 2, 6, 7 },
          { 0, 3, 7, 4 }, { 1, 2, 6, 5 } };
        for (const auto& face : faces)
        {
          this->Add(
            { c[face[0]], c[face[1]], c[face[2]], c[face[3]], middle, middle, middle, middle });
        }
        return;
      }
      case Kind::Tetrahedra:
        for (const auto& way : { std::pair(1, 2), std::pair(1, 5), std::pair(3, 2), std::pair(3, 7),
               std::pair(4, 5), std::pair(4, 7) })
        {
          this->AddTetrahedron(c[0], c[way.first], c[way.second], c[6]);
        }
        return;
    }
    throw std::logic_error("no such kind of cell");
  }

  Settings Model;
  std::vector<glm::dvec3> Places;
  std::vector<std::uint64_t> Corners;
};

#endif
