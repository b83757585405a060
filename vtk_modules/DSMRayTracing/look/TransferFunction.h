// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TransferFunction_h
#define rt_TransferFunction_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/look/FunctionSamples.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
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
/// volume rendering", 2001). The range has even bins, so that a value's bin is found by a
/// multiplication; where a bin is too wide for the function, it is divided into parts. Any number of
/// threads may call it.
class TransferFunction
{
public:
  /// Number of even bins in the range of values.
  static constexpr int Bins = 4096;

  /// `samples`: one more than bins, evenly spaced from `first` to `last`, which is greater. Red,
  /// green, blue (straight), and extinction (w): optical depth in a unit of length.
  /// `between`: further samples, ascending. `cellLength`: of two extinctions with
  /// which a cell is opaque, one is as good as the other.
  TransferFunction(double first, double last, const std::vector<glm::dvec4>& samples,
    double cellLength = 0.0, const std::vector<FunctionSample>& between = {});

  /// Samples a function as finely as it needs. `look(value)`: as the samples above. `nodes`: values
  /// where it may bend or jump. `least`: an extinction that makes no difference.
  static std::shared_ptr<const TransferFunction> Create(double first, double last,
    const std::function<glm::dvec4(double)>& look, const std::vector<double>& nodes, double least,
    double cellLength);

  double GetFirst() const { return this->First; }
  /// Bins in a unit of values.
  double GetScale() const { return this->Scale; }

  /// Linear in each: bin 0 is what is below the function's range, the last one what is above. The
  /// begin of a divided bin is not a number: ask Integrate.
  struct Bin
  {
    Lanes Integral; ///< up to the bin's begin
    Lanes Begin;    ///< emission and extinction there
    Lanes Growth;   ///< in the width of an even bin
  };
  const Bin* GetTable() const { return this->Table.data(); }
  /// Number of even bins, with the two beyond the range.
  int GetTableSize() const { return this->AllBins; }

  /// Emission (x, y, z) and extinction, integrated from First to a place in bins from there.
  /// `slope`: what they are there.
  Lanes Integrate(double place, Lanes& slope) const
  {
    const int number = this->GetNumber(place);
    const Bin& bin = this->Table[static_cast<std::size_t>(number)];
    return std::isnan(bin.Begin[3]) ? this->IntegratePart(number, place, slope)
                                    : Integrate(bin, place - (number - 1), slope);
  }

  /// How the function behaves between two places in bins from First, the second not less than the first.
  struct Behavior
  {
    double Extinction = 0.0; ///< the largest
    /// In the width of an even bin, at most: of what is seen of a short way for its length, and of
    /// the color itself.
    double Change = 0.0;
    double Tinge = 0.0;
  };
  /// Values that cross a whole bin cross it in a small part of their way, so it counts how much the
  /// function changes in the bin; for values that stay within, how steep it is.
  Behavior FindBehavior(double begin, double end) const;

  /// Returns whether any value from `first` to `last` is visible.
  bool IsSeen(double first, double last) const
  {
    return first <= last &&
      this->IsPlaceSeen((first - this->First) * this->Scale, (last - this->First) * this->Scale);
  }
  bool IsSeenAtAll() const { return this->SeenBefore.back() > 0; }

  /// Shared by functions that are the same, for all practical purposes.
  std::uint64_t GetDigest() const { return this->Digest; }

private:
  /// The parts of a divided bin: numbers of the first one and of the one after the last.
  struct Division
  {
    std::size_t First = 0;
    std::size_t Last = 0;
  };
  /// Where parts meet: a place in even bins, and the look there.
  struct Corner
  {
    double Place;
    glm::dvec4 Look;
  };
  /// Properties of an entire bin: the mean of emission and extinction, and changes as in Behavior.
  struct Whole
  {
    glm::dvec4 Slope{ 0.0 };
    double Change = 0.0;
    double Tinge = 0.0;
  };
  /// Divides a bin, up to whose begin the function has an integral.
  Whole Divide(
    int number, const std::vector<Corner>& corners, const glm::dvec4& integral, double cellLength);
  std::size_t FindPart(const Division& division, double place) const;
  Lanes IntegratePart(int number, double place, Lanes& slope) const;
  static Lanes Integrate(const Bin& bin, double way, Lanes& slope)
  {
    const Lanes change = bin.Growth * Lanes(way);
    slope = bin.Begin + change;
    return bin.Integral + (bin.Begin + Lanes(0.5) * change) * Lanes(way);
  }

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
  bool IsPlaceSeen(double begin, double end) const
  {
    const int first = this->GetNumber(begin);
    const int last = this->GetNumber(end);
    return this->AnyIsSeen(first, last) &&
      (!this->IsFine(first, last) || this->FindFineBehavior(begin, end).Extinction > 0.0);
  }
  /// Returns whether parts tell more than bins of what is between two bins.
  bool IsFine(int first, int last) const
  {
    return !this->Places.empty() && last - first <= 1 &&
      (this->Divisions[static_cast<std::size_t>(first)] |
        this->Divisions[static_cast<std::size_t>(last)]) != 0;
  }
  /// Between two places in one bin, or in two that follow one another.
  Behavior FindFineBehavior(double begin, double end) const;
  Behavior FindBinBehavior(int first, int last) const;

  double First;
  double Scale;
  double Last; ///< end of the range, in bins from First
  int AllBins;
  std::vector<Bin> Table; ///< even bins, then the parts of all divided ones
  /// Division number for each even bin; 0 for a bin that is whole.
  std::vector<std::uint32_t> Divisions;
  std::vector<Division> Divided; ///< by division; the first one is of no bin
  std::vector<double> Places;    ///< where each part begins, in even bins
  std::vector<Behavior> Parts;   ///< of each part
  std::vector<int> SeenBefore;   ///< bins before each that are seen; one more at the end
  /// Largest Behavior of 1, 2, 4 ... groups of bins that follow one another, from each group on.
  std::vector<std::vector<Behavior>> Largest;
  std::uint64_t Digest;
};

} // namespace rt

#endif
