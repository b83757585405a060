// SPDX-License-Identifier: BSD-3-Clause
#ifndef FixedSizeCells_h
#define FixedSizeCells_h

#include "vtkCellArray.h"

/// Cells that are all of one size, whose offsets are computed and stored nowhere: since VTK 9.6, whose
/// filters make them.
namespace FixedSizeCells
{

template <class Cells>
auto Use(Cells* cells, vtkIdType size, bool wide, int)
  -> decltype(cells->UseFixedSize64BitStorage(size), bool())
{
  if (wide)
  {
    cells->UseFixedSize64BitStorage(size);
  }
  else
  {
    cells->UseFixedSize32BitStorage(size);
  }
  return true;
}

template <class Cells>
bool Use(Cells*, vtkIdType, bool, long)
{
  return false;
}

/// Makes the cells, which are empty, such ones. False where VTK has none.
inline bool Use(vtkCellArray* cells, vtkIdType size, bool wide)
{
  return Use(cells, size, wide, 0);
}

} // namespace FixedSizeCells

#endif
