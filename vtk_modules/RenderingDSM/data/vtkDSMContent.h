// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMContent_h
#define vtkDSMContent_h

#include <cstdint>

class vtkAbstractArray;

/// Finds out whether arrays have the same contents as before, whatever object they are in and whether or not the
/// application called Modified: a simulation may write to the same memory, a reader may read the same again.
namespace vtkDSMContent
{
/// Local. Returns a hash of the array's type, shape and values: equal, for all practical purposes, only for
/// equal arrays. The hash of an array that is not numeric differs from any other, also of the same array.
/// Null is an array, too. Reads with as many threads, but with one if the array computes its values.
std::uint64_t Hash(vtkAbstractArray* array, int threads);
}

#endif
