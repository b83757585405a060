// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelSets_h
#define rt_LevelSets_h

#include <vector>

namespace rt
{

/// The places where a field has one of some values.
template <class FieldType>
struct LevelSets
{
  FieldType Field;
  /// Ascending, finite, no duplicates.
  std::vector<double> Isovalues;
};

} // namespace rt

#endif
