// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TransferFunction_h
#define rt_TransferFunction_h

#include "DSMRayTracing/base/Lanes.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rt
{

/// Emission and absorption of a medium as a function of its value. Values outside of the function's
/// range are clamped to it. The function is integrated over the values beforehand, so a ray between
/// two values misses none of the values in between (Engel et al., "High-quality pre-integrated
/// volume rendering", 2001). Any number of threads may call it.
class TransferFunction
{
public:
  /// Number of bins in the range of values. Sufficient for most functions.
  static constexpr int Bins = 4096;

  /// `samples`: one more than bins, evenly spaced from `first` to `last`, which is greater. Red, green, blue (straight), and
  /// extinction (w): optical depth in a unit of length. `cellLength`: of two extinctions with which
  /// a cell is opaque, one is as good as the other.
  TransferFunction(
    double first, double last, const std::vector<glm::dvec4>& samples, double cellLength = 0.0);

  double GetFirst() const { return this->First; }
  /// Bins in a unit of values.
  double GetScale() const { return this->Scale; }

  /// Emission (x, y, z) and extinction, integrated from First to a place in bins from there. `slope`: what they are there.
  Lanes Integrate(double place, Lanes& slope) const
  {
    const int number = this->GetNumber(place);
    const Bin& bin = this->Table[static_cast<std::size_t>(number)];
    const double way = place - (number - 1);
    const Lanes change = bin.Growth * Lanes(way);
    slope = bin.Begin + change;
    return bin.Integral + (bin.Begin + Lanes(0.5) * change) * Lanes(way);
  }

  /// Linear in each: bin 0 is what is below the function's range, the last one what is above.
  struct Bin
  {
    Lanes Integral; ///< up to the bin's begin
    Lanes Begin;    ///< emission and extinction there
    Lanes Growth;   ///< up to the bin's end
  };
  const Bin* GetTable() const { return this->Table.data(); }
  int GetTableSize() const { return this->AllBins; }

  /// How the function behaves between two places in bins from First, the second not less than the first.
  struct Behavior
  {
    double Extinction = 0.0; ///< the largest
    /// From a bin to the next, at most: of what is seen of a short way for its length, and of the color itself.
    double Change = 0.0;
    double Tinge = 0.0;
  };
  Behavior FindBehavior(double begin, double end) const;

  /// Returns whether any value from `first` to `last` is visible.
  bool IsSeen(double first, double last) const
  {
    return first <= last &&
      this->AnyIsSeen(this->GetNumber((first - this->First) * this->Scale),
        this->GetNumber((last - this->First) * this->Scale));
  }
  bool IsSeenAtAll() const { return this->SeenBefore.back() > 0; }

  /// Shared by functions that are the same, for all practical purposes.
  std::uint64_t GetDigest() const { return this->Digest; }

private:
  /// A place that is not a number is in bin 0.
  int GetNumber(double place) const
  {
    return place >= this->Last ? this->AllBins - 1 : place >= 0.0 ? static_cast<int>(place) + 1 : 0;
  }
  bool AnyIsSeen(int first, int last) const
  {
    return this->SeenBefore[static_cast<std::size_t>(last) + 1] >
      this->SeenBefore[static_cast<std::size_t>(first)];
  }

  double First;
  double Scale;
  double Last; ///< end of the range, in bins from First
  int AllBins;
  std::vector<Bin> Table;
  std::vector<int> SeenBefore; ///< bins before each that are seen; one more at the end
  /// Largest Behavior of 1, 2, 4 ... groups of bins that follow one another, from each group on.
  std::vector<std::vector<Behavior>> Largest;
  std::uint64_t Digest;
};

} // namespace rt

#endif
