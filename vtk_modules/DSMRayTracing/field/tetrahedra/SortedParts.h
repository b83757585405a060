// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SortedParts_h
#define rt_SortedParts_h

#include "DSMRayTracing/field/tetrahedra/CellKernel.h"

#include <cstddef>
#include <tuple>
#include <vector>

namespace rt
{

/// Parts of a ray, in the order in which it passes them. They are added about in that order, so most stay near the end.
class SortedParts
{
public:
  using Part = CellKernel::Part;

  void Insert(const Part& part)
  {
    std::size_t place = this->Parts.size();
    this->Parts.push_back(part);
    for (; place > this->Removed && IsBefore(part, this->Parts[place - 1]); --place)
    {
      this->Parts[place] = this->Parts[place - 1];
    }
    this->Parts[place] = part;
  }

  /// Valid until parts are inserted.
  const Part* GetFirst() const { return this->Parts.data() + this->Removed; }
  /// The number of parts that begin before a T.
  int CountBefore(double end) const
  {
    std::size_t last = this->Parts.size();
    while (last > this->Removed && this->Parts[last - 1].Enter >= end)
    {
      --last;
    }
    return static_cast<int>(last - this->Removed);
  }

  /// Removes the first ones.
  void Remove(int count)
  {
    this->Removed += static_cast<std::size_t>(count);
    if (this->Removed == this->Parts.size())
    {
      this->Clear();
    }
  }
  void Clear()
  {
    this->Parts.clear();
    this->Removed = 0;
  }

private:
  static bool IsBefore(const Part& one, const Part& other)
  {
    return one.Enter != other.Enter
      ? one.Enter < other.Enter
      : std::tie(one.Exit, one.First, one.Last) < std::tie(other.Exit, other.First, other.Last);
  }

  std::vector<Part> Parts;
  std::size_t Removed = 0; ///< of the first of Parts
};

} // namespace rt

#endif
