// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMeshColors_h
#define vtkDSMMeshColors_h

#include "DSMBricks/layout/MeshAttributes.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>

class vtkAbstractArray;
class vtkDataArray;
class vtkMapper;
class vtkPolyData;
class vtkUnsignedCharArray;

/// Source of the colors of one vtkPolyData, as the mapper's settings choose it: values, which the
/// color map turns into colors where a ray hits, or colors of the points or cells themselves.
class vtkDSMMeshColors
{
public:
  enum class State : std::int32_t
  {
    NotAsked,
    Usable,
    Missing,
    WrongLength,
    Text ///< and the color map has no colors for words
  };

  vtkDSMMeshColors() = default;
  /// Local. Looks the array up; no element is read yet.
  vtkDSMMeshColors(vtkMapper* mapper, vtkPolyData* data);

  State GetState() const { return this->Found; }
  /// Elements of the array, and of what it should have one for each.
  vtkIdType GetLength() const { return this->Length; }
  vtkIdType GetExpectedLength() const { return this->ExpectedLength; }

  /// At most one of the two is there.
  bricks::Attachment GetValues() const;
  bricks::Attachment GetColors() const;

  /// Returns the value of a point or cell. Several threads may call it at the same time.
  double GetValue(vtkIdType element) const;
  void GetColor(vtkIdType element, std::uint8_t rgba[4]) const;

  /// The array that the mapper names, or null.
  static vtkAbstractArray* FindArray(vtkMapper* mapper, vtkPolyData* data, int& field);
  /// Returns whether the colors themselves, and not only their source, depend on the lookup table.
  static bool DependsOnTable(vtkMapper* mapper, vtkAbstractArray* array);

private:
  /// Null when the colors are the array's own.
  vtkSmartPointer<vtkDataArray> Values;
  vtkSmartPointer<vtkUnsignedCharArray> Colors;
  bricks::Attachment Attached = bricks::Attachment::None;
  int Component = 0;          ///< -1 is the magnitude
  vtkIdType OnlyElement = -1; ///< the one that all share, or -1
  State Found = State::NotAsked;
  vtkIdType Length = 0;
  vtkIdType ExpectedLength = 0;
};

#endif
