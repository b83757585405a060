// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMColorBytes_h
#define vtkDSMColorBytes_h

#include "vtkSmartPointer.h"

class vtkDataArray;
class vtkUnsignedCharArray;

/// Converts arrays whose values are colors themselves, for images and meshes alike.
namespace vtkDSMColorBytes
{
/// Local. Returns the values as bytes, with the array's number of components: bytes as they are, unsigned integers
/// of 16 bits scaled (65535 becomes 255), other integers clamped to 0 and 255, and floating point numbers from [0,
/// 1], clamped. NaN becomes 0. VTK's own conversion wraps around where values are out of range.
vtkSmartPointer<vtkUnsignedCharArray> Convert(vtkDataArray* colors);
}

#endif
