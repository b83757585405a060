// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TransferFunction_h
#define rt_TransferFunction_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/look/FunctionSamples.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace rt
{

/// Emission and absorption of a medium as a function of its value. Values outside of the function's
/// range are clamped to it. The function is integrated over the values beforehand, so a ray between
/// two values misses none of the values in between (Engel et al., "High-quality pre-integrated
/// volume rendering", 2001). It is linear in parts that begin and end where it bends or jumps,
/// however close to one another that is; the range is divided into even bins only to find parts
/// quickly. Any number of threads may call it.
///
/// Places are values in bins, 0 where the function's narrowest part begins, so that floats tell these apart.
class TransferFunction
{
public:
  /// Number of even bins in the range of values.
  static constexpr int Bins = 1024;

  /// `samples`: ascending, at least two, the function's range from the first to the last of them. Two of the same
  /// value are a jump. Their looks are red, green, blue (straight), and extinction (w): optical depth in a unit of
  /// length. `cellLength`: of two extinctions with which a cell is opaque, one is as good as the other.
  /// `others`: looks of other functions at the same values, whose Behavior counts, too.
  explicit TransferFunction(const std::vector<FunctionSample>& samples, double cellLength = 0.0,
    const std::vector<std::vector<glm::dvec4>>& others = {});
  /// The same of even samples from `first` to `last`, which is greater.
  TransferFunction(double first, double last, const std::vector<glm::dvec4>& samples);

  /// Samples a function as finely as it needs. `look(value)`: as the samples above. `nodes`: values
  /// where it may bend or jump. `least`: an extinction that makes no difference.
  static std::shared_ptr<const TransferFunction> Create(double first, double last,
    const std::function<glm::dvec4(double)>& look, const std::vector<double>& nodes, double least,
    double cellLength);

  /// The value at place 0.
  double GetOrigin() const { return this->Origin; }
  /// Bins in a unit of values.
  double GetScale() const { return this->Scale; }
  double GetPlace(double value) const { return (value - this->Origin) * this->Scale; }
  /// The largest red, green or blue that is emitted anywhere in a unit of length.
  double GetBrightest() const { return this->Brightest; }

  /// The function in single precision. Part 0 is what is below the range, the last one what is above. The part of a
  /// place is the last one that begins at or before it: Index[bin] or one of the 2^Steps - 1 parts behind it. Bins
  /// begin at place First.
  struct Table
  {
    float First;
    std::vector<float> Begin;        ///< of each part; infinite behind the last one
    std::vector<std::int32_t> Index; ///< for each bin: the part at its begin
    int Steps;
    /// For each part: red, green, blue and extinction where it begins, then their growth in a bin.
    std::vector<float> Rows;
    /// No place outside of these two is visible.
    float SeenFirst;
    float SeenLast;
  };
  const Table& GetTable() const { return this->Floats; }

  /// Emission (x, y, z) and extinction, integrated from the range's begin to a place.
  /// `slope`: what they are there.
  Lanes Integrate(double place, Lanes& slope) const
  {
    const Part& part = this->Parts[this->FindPart(place)];
    const double way = place - part.Begin;
    const Lanes change = part.Growth * Lanes(way);
    slope = part.Look + change;
    return part.Integral + (part.Look + Lanes(0.5) * change) * Lanes(way);
  }

  /// How the function behaves between two places, the second not less than the first.
  struct Behavior
  {
    double Extinction = 0.0; ///< the largest
    /// In the width of a bin, at most: of what is seen of a short way for its length, and of the color itself.
    double Change = 0.0;
    double Tinge = 0.0;
  };
  /// Values that cross a whole bin cross it in a small part of their way, so it counts how much the
  /// function changes in the bin; for values that stay within, how steep it is.
  Behavior FindBehavior(double begin, double end) const;
  /// No range behaves worse.
  const Behavior& GetWorstBehavior() const { return this->Worst; }

  /// Returns whether any value from `first` to `last` is visible.
  bool IsSeen(double first, double last) const
  {
    return first <= last && this->IsPlaceSeen(this->GetPlace(first), this->GetPlace(last));
  }
  bool IsSeenAtAll() const { return this->SeenBefore.back() > 0; }

  ///@{
  /// The bin of a place: 1 for the first one, 0 below the range, Bins + 1 above. Returns whether any bin from `first`
  /// to `last` has a visible value, or all of them have.
  int GetBin(double place) const
  {
    const double bin = place - this->Begin;
    return bin >= Bins ? Bins + 1 : bin >= 0.0 ? static_cast<int>(bin) + 1 : 0;
  }
  bool IsAnyBinSeen(int first, int last) const { return this->CountSeen(first, last) > 0; }
  bool AreAllBinsSeen(int first, int last) const
  {
    return this->CountSeen(first, last) > last - first;
  }
  ///@}

  /// Shared by functions that are the same, for all practical purposes.
  std::uint64_t GetDigest() const { return this->Digest; }

private:
  struct Part
  {
    double Begin; ///< place
    double End;
    Lanes Integral; ///< up to the begin
    Lanes Look;     ///< emission and extinction there
    Lanes Growth;   ///< in a bin
    double LastExtinction;
    double Jump; ///< of what is seen, from the end of the part before
    Behavior Steepness;
  };

  void AddPart(const FunctionSample& begin, const FunctionSample& end, double cellLength);
  /// How steep a part is that is `width` wide and has such looks at its ends.
  static Behavior GetSteepness(
    const glm::dvec4& begin, const glm::dvec4& end, double width, double cellLength);
  void SetBins();
  void SetWorst();
  void SetTable();
  /// The last part that begins at or before a place; that of a place that is not a number is part 0.
  std::size_t FindPart(double place) const;
  int CountSeen(int first, int last) const
  {
    return this->SeenBins[static_cast<std::size_t>(last) + 1] -
      this->SeenBins[static_cast<std::size_t>(first)];
  }
  bool IsPlaceSeen(double begin, double end) const;
  Behavior FindFineBehavior(double begin, double end) const;
  Behavior FindBinBehavior(int first, int last) const;

  double Origin;
  double Scale;
  double Begin; ///< place of the range's begin
  double Brightest = 0.0;
  std::vector<Part> Parts;
  Table Floats;
  std::vector<int> SeenBefore; ///< parts before each that are seen; one more at the end
  std::vector<int> SeenBins;   ///< bins before each that are seen; one more at the end
  /// Largest Behavior of 1, 2, 4 ... bins that follow one another, from each bin on.
  std::vector<std::vector<Behavior>> Largest;
  Behavior Worst;
  std::uint64_t Digest;
};

} // namespace rt

#endif
