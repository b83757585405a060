// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMContent_h
#define vtkDSMContent_h

#include <cstdint>

class vtkAbstractArray;

/// Tells whether arrays hold what they held, whatever object they are in and whether or not anybody
/// called Modified: a simulation may write to the same memory, a reader may read the same again.
namespace vtkDSMContent
{
/// Local. Of the array's type, shape and values: equal, for all practical purposes, only for equal
/// ones. An array of what is no number is unlike any other and unlike itself. Null is an array, too. Reads
/// with as many threads, but values that are computed by one.
std::uint64_t Hash(vtkAbstractArray* array, int threads);
}

#endif
