// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMeshContent_h
#define vtkDSMMeshContent_h

#include "vtkDSMMeshInput.h"

#include <cstdint>
#include <functional>
#include <vector>

class vtkAbstractArray;

/// Digest of one rank's surfaces and of the arrays that are read from them. If it is the same on
/// every rank, so are the meshes.
struct vtkDSMMeshContent
{
  std::vector<std::uint64_t> Whole;
  std::vector<std::vector<std::uint64_t>>
    Blocks; ///< for each surface, in vtkDSMMeshBlock::Collect's order

  /// Local, quick: numbers that are others when anything may be.
  static std::vector<std::uint64_t> GetStamp(const vtkDSMMeshInput& input);

  /// Local, reads the data: numbers that are others when, and only when, this rank's data or what is
  /// read of them are.
  static vtkDSMMeshContent Hash(const vtkDSMMeshInput& input, int threads);

  /// Adds another number that a mesh depends on.
  static void AddNumber(std::vector<std::uint64_t>& numbers, double number);

private:
  /// Numbers an array, by its identity or by what it holds.
  using Identify = std::function<std::uint64_t(vtkAbstractArray*)>;

  static vtkDSMMeshContent Describe(const vtkDSMMeshInput& input, const Identify& identify);
  static std::vector<std::uint64_t> DescribeBlock(
    const vtkDSMMeshInput& input, const vtkDSMMeshBlock& block, const Identify& identify);
};

#endif
