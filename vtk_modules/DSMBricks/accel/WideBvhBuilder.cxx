// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/accel/WideBvhBuilder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace bricks
{

namespace
{

/// Which bin of each axis a place belongs to.
class Binning
{
public:
  Binning(const BoundingBox& centers, int bins)
    : Last(static_cast<float>(bins - 1))
  {
    float lower[4];
    float upper[4];
    float scale[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    centers.Lower.Store(lower);
    centers.Upper.Store(upper);
    for (int axis = 0; axis < 3; ++axis)
    {
      const float size = upper[axis] - lower[axis];
      this->Empty[axis] = !(size > 0.0f);
      scale[axis] = this->Empty[axis] ? 0.0f : 0.999f * static_cast<float>(bins) / size;
      if (!std::isfinite(scale[axis]))
      {
        this->Empty[axis] = true;
        scale[axis] = 0.0f;
      }
    }
    this->Lower = centers.Lower;
    this->Scale = Float4::Load(scale);
  }

  /// Along which nothing can be parted.
  bool IsEmpty(int axis) const { return this->Empty[axis]; }

  void Get(const BoundingBox& box, int bin[3]) const
  {
    float place[4];
    Min((box.Lower + box.Upper - this->Lower) * this->Scale, Float4::Fill(this->Last)).Store(place);
    for (int axis = 0; axis < 3; ++axis)
    {
      bin[axis] = static_cast<int>(place[axis]);
    }
  }

private:
  Float4 Lower;
  Float4 Scale;
  float Last;
  bool Empty[3];
};

} // namespace

template <class Reference>
void WideBvhBuilder<Reference>::Build(const std::vector<BoundingBox>& boxes)
{
  this->Boxes = boxes.data();
  this->Nodes.clear();
  this->Order.resize(boxes.size());
  std::iota(this->Order.begin(), this->Order.end(), 0u);
  if (!boxes.empty())
  {
    this->BuildNode(this->Measure(0, static_cast<std::uint32_t>(boxes.size())), 0);
  }
}

template <class Reference>
Reference WideBvhBuilder<Reference>::BuildNode(const Range& range, int depth)
{
  const bool byNumber = depth > LargestSplitDepth;
  std::uint32_t smallest = this->LeafSize; // of a child
  while (this->Shape == WideBvhShape::Full && smallest * Node::Width < range.GetCount())
  {
    smallest *= Node::Width;
  }
  Range children[Node::Width];
  float sizes[Node::Width]; // -1 for a leaf
  int count = 1;
  children[0] = range;
  const auto rate = [&](int child)
  {
    const std::uint32_t items = children[child].GetCount();
    sizes[child] = items <= smallest ? -1.0f
      : byNumber                     ? static_cast<float>(items)
                                     : children[child].Box.GetArea();
  };
  rate(0);
  while (count < Node::Width)
  {
    const int largest = static_cast<int>(std::max_element(sizes, sizes + count) - sizes);
    if (sizes[largest] < 0.0f)
    {
      break;
    }
    const Range parent = children[largest];
    this->Split(parent, byNumber, smallest, children[largest], children[count]);
    rate(largest);
    rate(count);
    ++count;
  }

  const std::size_t index = this->Nodes.size();
  this->Nodes.emplace_back();
  this->SetBounds(this->Nodes[index], range.Box, children, count);
  for (int child = 0; child < count; ++child)
  {
    const std::uint32_t items = children[child].GetCount();
    const Reference reference = items <= this->LeafSize
      ? GetLeaf(children[child].Begin, items)
      : this->BuildNode(children[child], depth + 1);
    this->Nodes[index].References[child] = reference;
  }
  return static_cast<Reference>(index);
}

template <class Reference>
void WideBvhBuilder<Reference>::Split(
  const Range& range, bool byNumber, std::uint32_t step, Range& first, Range& second)
{
  std::uint32_t middle = range.Begin + range.GetCount() / 2;
  int axis = 0;
  int bin = 0;
  if (this->Shape == WideBvhShape::Full)
  {
    middle = this->SplitFull(range, step);
  }
  else if (!byNumber && this->FindPlane(range, axis, bin))
  {
    const Binning binning(range.Centers, Bins);
    const auto isFirst = [&](std::uint32_t item)
    {
      int place[3];
      binning.Get(this->Boxes[item], place);
      return place[axis] < bin;
    };
    const auto begin = this->Order.begin();
    middle = static_cast<std::uint32_t>(
      std::partition(begin + range.Begin, begin + range.End, isFirst) - begin);
  }
  // `first` may be where `range` is.
  const std::uint32_t begin = range.Begin;
  const std::uint32_t end = range.End;
  first = this->Measure(begin, middle);
  second = this->Measure(middle, end);
}

template <class Reference>
std::uint32_t WideBvhBuilder<Reference>::SplitFull(const Range& range, std::uint32_t step)
{
  float size[4];
  (range.Centers.Upper - range.Centers.Lower).Store(size);
  const auto axis = std::max_element(size, size + 3) - size;
  const auto getCenter = [&](std::uint32_t item)
  {
    float center[4];
    (this->Boxes[item].Lower + this->Boxes[item].Upper).Store(center);
    return center[axis];
  };
  const std::uint32_t middle = range.Begin + (range.GetCount() + step) / 2 / step * step;
  const auto begin = this->Order.begin();
  std::nth_element(begin + range.Begin, begin + middle, begin + range.End,
    [&](std::uint32_t one, std::uint32_t other)
    {
      const float a = getCenter(one);
      const float b = getCenter(other);
      return a != b ? a < b : one < other;
    });
  return middle;
}

template <class Reference>
bool WideBvhBuilder<Reference>::FindPlane(const Range& range, int& bestAxis, int& bestBin) const
{
  const Binning binning(range.Centers, Bins);
  BoundingBox boxes[3][Bins];
  std::uint32_t counts[3][Bins] = {};
  for (std::uint32_t item = range.Begin; item < range.End; ++item)
  {
    const BoundingBox& box = this->Boxes[this->Order[item]];
    int bin[3];
    binning.Get(box, bin);
    for (int axis = 0; axis < 3; ++axis)
    {
      boxes[axis][bin[axis]].Add(box);
      ++counts[axis][bin[axis]];
    }
  }
  // Items that are intersected together cost as much as one.
  const auto cost = [&](const BoundingBox& box, std::uint32_t count)
  { return box.GetArea() * static_cast<float>((count + this->LeafSize - 1) / this->LeafSize); };
  float best = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    if (binning.IsEmpty(axis))
    {
      continue;
    }
    float costBehind[Bins] = {};
    BoundingBox behind;
    std::uint32_t countBehind = 0;
    for (int bin = Bins - 1; bin > 0; --bin)
    {
      behind.Add(boxes[axis][bin]);
      countBehind += counts[axis][bin];
      costBehind[bin] = countBehind > 0 ? cost(behind, countBehind) : 0.0f;
    }
    BoundingBox before;
    std::uint32_t countBefore = 0;
    for (int bin = 1; bin < Bins; ++bin)
    {
      before.Add(boxes[axis][bin - 1]);
      countBefore += counts[axis][bin - 1];
      if (countBefore == 0 || countBefore == range.GetCount())
      {
        continue;
      }
      const float total = cost(before, countBefore) + costBehind[bin];
      if (total < best)
      {
        best = total;
        bestAxis = axis;
        bestBin = bin;
      }
    }
  }
  return best < std::numeric_limits<float>::infinity();
}

template <class Reference>
typename WideBvhBuilder<Reference>::Range WideBvhBuilder<Reference>::Measure(
  std::uint32_t begin, std::uint32_t end) const
{
  Range range;
  range.Begin = begin;
  range.End = end;
  for (std::uint32_t item = begin; item < end; ++item)
  {
    const BoundingBox& box = this->Boxes[this->Order[item]];
    range.Box.Add(box);
    range.Centers.Add(box.Lower + box.Upper);
  }
  return range;
}

template <class Reference>
void WideBvhBuilder<Reference>::SetBounds(
  Node& node, const BoundingBox& box, const Range* children, int count) const
{
  constexpr double largest = 255.0;
  // Numbers of single precision; smaller exponents are not normal numbers.
  constexpr int bias = 127;
  constexpr int smallestExponent = -126;
  float lower[4];
  float upper[4];
  box.Lower.Store(lower);
  box.Upper.Store(upper);
  double scales[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double size = static_cast<double>(upper[axis]) - lower[axis];
    int exponent = smallestExponent;
    if (size > 0.0)
    {
      std::frexp(size / largest, &exponent);
      exponent = std::clamp(exponent, smallestExponent, bias);
    }
    node.Origin[axis] = lower[axis];
    node.Exponent[axis] = static_cast<std::uint8_t>(exponent + bias);
    scales[axis] = std::ldexp(1.0, -exponent);
  }
  node.Children = static_cast<std::uint8_t>(count);
  for (int child = 0; child < Node::Width; ++child)
  {
    float childLower[4] = {};
    float childUpper[4] = {};
    if (child < count)
    {
      children[child].Box.Lower.Store(childLower);
      children[child].Box.Upper.Store(childUpper);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto place = [&](float plane)
      { return (static_cast<double>(plane) - node.Origin[axis]) * scales[axis]; };
      // A missing child: no ray passes its planes in this order.
      node.Bounds[axis * Node::Width + child] = child < count
        ? static_cast<std::uint8_t>(std::clamp(std::floor(place(childLower[axis])), 0.0, largest))
        : 255;
      node.Bounds[(3 + axis) * Node::Width + child] = child < count
        ? static_cast<std::uint8_t>(std::clamp(std::ceil(place(childUpper[axis])), 0.0, largest))
        : 0;
    }
    node.References[child] = 0;
  }
}

template class WideBvhBuilder<std::uint16_t>;
template class WideBvhBuilder<std::uint32_t>;

} // namespace bricks
