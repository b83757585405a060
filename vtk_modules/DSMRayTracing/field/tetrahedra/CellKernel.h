// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellKernel_h
#define rt_CellKernel_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/cells/CellBrick.h"
#include "DSMBricks/cells/SplitCell.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <cstdint>
#include <vector>

namespace rt
{

/// The steps of a packet through the bricks of a CellField, with the vector instructions of the processor. There is
/// one for each kind of processor in the same binary, and one for rays one by one. All find the same bits: numbers
/// come from the same operations in the same order, none of them contracted, and beyond that vectors only decide which
/// boxes and cells need not be looked at.
///
/// Pure, but for the sums of Integrate; any thread.
struct CellKernel
{
  /// The boxes of the children of a node: WideBvhNode.
  struct Boxes
  {
    const float* Origin;
    const std::uint8_t* Exponent;
    const std::uint8_t* Bounds;
  };
  /// Lanes that meet children, and where the first of them enters, in units of BoxRay.
  struct Children
  {
    RayMask Lanes[bricks::WideBvhWidth];
    float Enter[bricks::WideBvhWidth];
  };

  /// Cells that are split into tetrahedra, and their points, each once.
  struct Group
  {
    static constexpr int MostCells = bricks::CellGroup::MostCells;
    static constexpr int MostCorners = bricks::CellGroup::MostCorners;
    static constexpr int MostPoints = bricks::CellGroup::MostPoints;
    static constexpr int MostParts = MostCells * bricks::MostTetrahedra;

    struct Point
    {
      float Place[3]; ///< along the axes of the packet
      float Value;
    };
    struct Cell
    {
      std::uint8_t At[MostCorners]; ///< numbers of points
      std::uint8_t FirstPart;       ///< of its tetrahedra
      std::uint8_t Parts;
    };

    std::uint64_t Used = 0; ///< bits of the points that cells have; no others are known
    Point Points[MostPoints];
    int Corners; ///< of each cell
    int CellCount = 0;
    Cell Cells[MostCells];
    std::uint8_t Tetrahedra[MostParts][4]; ///< numbers of points
  };
  /// Where a ray enters and leaves a tetrahedron (T), and the values there.
  struct Crossing
  {
    double Enter;
    double Exit;
    double First;
    double Last;
    std::uint8_t Lane;
    std::uint8_t Part; ///< the tetrahedron's number
  };
  /// The way of a ray through a tetrahedron, between its Min and Max: as Crossing.
  struct Part
  {
    double Enter;
    double Exit;
    double First;
    double Last;
  };
  /// For each lane, parts in the order in which the ray passes them.
  struct Runs
  {
    const Part* First[CellPacket::Size];
    int Count[CellPacket::Size];
  };
  static constexpr int MostCrossings = Group::MostParts * CellPacket::Size;

  const char* Name;
  int Width; ///< rays at once

  /// Finds which of `lanes` meet the boxes of the `wanted` children (bits) of a node before they end. No others are
  /// written.
  void (*FindChildren)(
    const CellPacket& packet, RayMask lanes, const Boxes& boxes, unsigned wanted, Children& met);

  /// Returns those of `lanes` that end behind a place, in units of BoxRay.
  RayMask (*FindOpen)(const CellPacket& packet, RayMask lanes, float enter);

  /// Writes how those of `lanes` cross the tetrahedra of a group between their Min and Max. Returns the number of
  /// crossings, at most MostCrossings.
  int (*FindCrossings)(
    const CellPacket& packet, RayMask lanes, const Group& group, Crossing* crossings);

  /// Takes rays of a medium through parts, and adds what comes of it. Returns the lanes that are dark then.
  RayMask (*Integrate)(const CellPacket& packet, const Runs& runs, const TransferFunction& function,
    MediumLight& light);

  /// The fastest that this processor can run.
  static const CellKernel& GetBest();
  /// All that this processor can run, that of width 1 first. For tests: not while any thread traces.
  static std::vector<CellKernel> GetAll();
};

} // namespace rt

#endif
