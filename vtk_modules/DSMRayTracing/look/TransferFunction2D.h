// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TransferFunction2D_h
#define rt_TransferFunction2D_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/look/TransferFunction.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace rt
{

/// Emission and absorption of a medium as a function of its value and of a second number, such as the length of the
/// gradient. It is an image: columns for the value, rows for the second number. Each row is integrated over the values
/// beforehand, so that a ray misses none of the values between two (see TransferFunction). Any number of threads may
/// call it.
class TransferFunction2D
{
public:
  /// Texels lie as in an OpenGL texture with the wrap mode "clamp to edge": the center of the first one is half a texel
  /// behind the begin of the range, and numbers before that have its look.
  struct Image
  {
    int Columns = 1;
    int Rows = 1;
    std::vector<glm::dvec4> Looks; ///< row by row: red, green, blue (straight) and opacity
    ///@{
    /// From the begin of the first column or row to the end of the last one. `y` is greater than `x`.
    glm::dvec2 Values{ 0.0, 1.0 };
    glm::dvec2 Seconds{ 0.0, 1.0 };
    ///@}
    /// True: a place has the look of the nearest texel. False: looks are interpolated.
    bool IsNearest = false;
  };

  /// `getExtinction(opacity)`: optical depth in a unit of length. `cellLength`: see TransferFunction.
  TransferFunction2D(
    const Image& image, const std::function<double(double)>& getExtinction, double cellLength);

  /// The largest extinction that each value has with any second number, in the color that it has there. It behaves as
  /// the worst of the rows. Not null.
  const std::shared_ptr<const TransferFunction>& GetEnvelope() const { return this->Envelope; }

  /// The amount (MediumPiece) of a way on which both numbers change evenly from its begin to the middle, and from there
  /// to its end. Its front hides a part of its back: the emission lacks that. `x`: value, as a place of the envelope;
  /// `y`: second number. `length`: of the whole way.
  Lanes GetAmount(
    const glm::dvec2& begin, const glm::dvec2& middle, const glm::dvec2& end, double length) const;

  /// See TransferFunction.
  std::uint64_t GetDigest() const { return this->Digest; }

private:
  /// Texels, or places between them at which looks are interpolated once. Emission is linear between two.
  struct Node
  {
    Lanes Emission;
    Lanes Integral; ///< of the emission, over the columns of nodes before this one
  };

  const Node* GetRow(std::size_t row) const { return &this->Nodes[row * this->Columns]; }
  /// The column of a place of the envelope.
  double GetColumn(double place) const { return (place - this->FirstPlace) * this->ColumnsInBin; }
  double GetRowNumber(double second) const
  {
    return (second - this->FirstSecond) * this->RowsInUnit;
  }
  Lanes Integrate(const Node* row, double column) const;
  Lanes Evaluate(const Node* row, double column) const;
  Lanes GetRowMean(std::size_t row, double begin, double end) const;
  Lanes GetNearest(double column, double row) const;
  /// The mean over the values between two columns, where the second number is that of a row, which may lie between two.
  Lanes GetMean(double row, double begin, double end) const;
  /// A way on which both numbers change evenly: calls `add(mean, part)` for its parts in order, of which each is so
  /// much of the way.
  template <class Add>
  void VisitParts(const glm::dvec2& begin, const glm::dvec2& end, const Add& add) const;
  void SetNodes(const Image& image, const std::function<double(double)>& getExtinction);
  void SetEnvelope(const Image& image, double cellLength);
  static glm::dvec4 GetLook(const Node& node);

  std::size_t Columns = 1; ///< of nodes
  std::size_t Rows = 1;
  int ColumnParts = 1; ///< nodes for each texel
  int RowParts = 1;
  bool IsNearest = false;
  std::vector<Node> Nodes;           ///< row by row
  std::vector<unsigned char> IsSeen; ///< for each row: whether any of it is visible
  std::shared_ptr<const TransferFunction> Envelope;
  double FirstPlace = 0.0; ///< place of column 0
  double ColumnsInBin = 1.0;
  double FirstSecond = 0.0; ///< second number of row 0
  double RowsInUnit = 1.0;
  std::uint64_t Digest = 0;
};

} // namespace rt

#endif
