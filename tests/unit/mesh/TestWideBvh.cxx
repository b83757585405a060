// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/accel/RangedBvhNode.h"
#include "DSMBricks/accel/WideBvhBuilder.h"
#include "DSMRayTracing/ray/ChildrenInRange.h"
#include "DSMRayTracing/ray/ChildrenOnRay.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace
{

bricks::BoundingBox CreateBox(const float lower[3], const float upper[3])
{
  const float low[4] = { lower[0], lower[1], lower[2], 0.0f };
  const float high[4] = { upper[0], upper[1], upper[2], 0.0f };
  return { bricks::Float4::Load(low), bricks::Float4::Load(high) };
}

std::vector<bricks::BoundingBox> CreateBoxes(int count, unsigned seed, float spread)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::vector<bricks::BoundingBox> boxes;
  for (int box = 0; box < count; ++box)
  {
    float lower[3];
    float upper[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      lower[axis] = spread * uniform(random);
      upper[axis] = lower[axis] + 0.05f * uniform(random);
    }
    boxes.push_back(CreateBox(lower, upper));
  }
  return boxes;
}

struct TestRay
{
  double Origin[3];
  double Direction[3];
  double Inverse[3];
  rt::BoxRay Line;

  /// Upward; every fifth along two axes only.
  TestRay(std::mt19937& random, int number)
  {
    std::uniform_real_distribution<double> uniform(-0.5, 1.5);
    const double origin[3] = { uniform(random), uniform(random), -1.0 };
    const double direction[3] = { 0.3 * uniform(random), 0.3 * uniform(random), 1.0 };
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Origin[axis] = origin[axis];
      this->Direction[axis] = axis == 0 && number % 5 == 0 ? 0.0 : direction[axis];
      this->Inverse[axis] = 1.0 / this->Direction[axis];
    }
    this->Line.Set(this->Origin, this->Inverse, 1e-6);
  }

  bool Meets(const bricks::BoundingBox& box, double last) const
  {
    float lower[4];
    float upper[4];
    box.Lower.Store(lower);
    box.Upper.Store(upper);
    double enter = 0.0;
    double leave = last;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double from = this->Origin[axis];
      if (this->Direction[axis] == 0.0)
      {
        leave = from < lower[axis] || from > upper[axis] ? -1.0 : leave;
        continue;
      }
      const double a = (lower[axis] - from) * this->Inverse[axis];
      const double b = (upper[axis] - from) * this->Inverse[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
  }
};

/// A hierarchy over items with values that grow along x.
template <class Reference>
struct RangedTree
{
  std::uint32_t LeafSize;
  std::vector<bricks::BoundingBox> Boxes = CreateBoxes(4000, 66, 1.0f);
  std::vector<bricks::ValueRange> Ranges;
  bricks::WideBvhBuilder<Reference> Tree{ LeafSize };
  std::vector<bricks::RangedBvhNode<Reference>> Nodes;

  explicit RangedTree(std::uint32_t leafSize)
    : LeafSize(leafSize)
  {
    for (const bricks::BoundingBox& box : this->Boxes)
    {
      float lower[4];
      box.Lower.Store(lower);
      this->Ranges.push_back({ lower[0], lower[0] + 0.01f });
    }
    this->Tree.Build(this->Boxes);
    this->Nodes = bricks::AddRanges(this->Tree.GetNodes(),
      [&](Reference leaf)
      {
        bricks::ValueRange range = bricks::ValueRange::GetEmpty();
        for (const std::uint32_t item : this->GetItems(leaf))
        {
          range.Add(this->Ranges[item]);
        }
        return range;
      });
  }

  std::vector<std::uint32_t> GetItems(Reference leaf) const
  {
    constexpr int countShift = 8 * sizeof(Reference) - 3;
    const std::uint32_t first = leaf & ((Reference(1) << countShift) - 1);
    const auto begin = this->Tree.GetOrder().begin() + first;
    return { begin, begin + (leaf >> countShift & 3u) + 1 };
  }

  /// Counts the nodes that are asked.
  template <class Wanted>
  struct Counted
  {
    const Wanted& Asked;
    int& Nodes;

    template <class Node>
    unsigned FindChildren(const Node& node, float enter[bricks::WideBvhWidth]) const
    {
      ++this->Nodes;
      return this->Asked.FindChildren(node, enter);
    }
    bool IsOpen(float enter) const { return this->Asked.IsOpen(enter); }
  };

  /// The items of the leaves that are visited; adds the number of nodes that are asked.
  template <class Wanted>
  std::set<std::uint32_t> Find(const Wanted& wanted, int& nodes) const
  {
    std::set<std::uint32_t> found;
    rt::TraverseWideBvh(this->Nodes.data(), Counted<Wanted>{ wanted, nodes },
      [&](Reference leaf)
      {
        const std::vector<std::uint32_t> items = this->GetItems(leaf);
        found.insert(items.begin(), items.end());
      });
    return found;
  }
};

/// What a walk with a predicate on ranges finds is what all items hold, and it passes most nodes by.
template <class Reference>
void CheckRanges(std::uint32_t leafSize)
{
  const RangedTree<Reference> tree(leafSize);
  std::mt19937 random(67);
  int inAll = 0;
  int inRange = 0;
  for (int number = 0; number < 300; ++number)
  {
    const TestRay ray(random, number);
    const float last = 1.9f;
    const rt::ChildrenOnRay onRay(ray.Line, last);
    tree.Find(onRay, inAll);
    // The last one is beyond all values.
    const double isovalue = number / 299.0 * 1.1;
    const auto mayHold = [&](const bricks::ValueRange& range) { return range.MayHold(isovalue); };
    int nodes = 0;
    const std::set<std::uint32_t> found = tree.Find(rt::ChildrenInRange(onRay, mayHold), nodes);
    inRange += nodes;
    std::set<std::uint32_t> expected;
    for (std::uint32_t item = 0; item < tree.Boxes.size(); ++item)
    {
      if (tree.Ranges[item].MayHold(isovalue) && ray.Meets(tree.Boxes[item], last))
      {
        expected.insert(item);
        EXPECT_EQ(found.count(item), 1u) << item;
      }
    }
    // Others of the same leaves, and boxes are rounded outward.
    EXPECT_LE(found.size(), leafSize * (2 * expected.size() + 10));
    if (isovalue > 1.02)
    {
      EXPECT_EQ(nodes, 1) << "nothing below the root";
    }
  }
  EXPECT_LT(2 * inRange, inAll);
}

/// Every item stands in one leaf, and lies within the boxes of all nodes above it.
template <class Reference>
void CheckNode(const bricks::WideBvhBuilder<Reference>& tree,
  const std::vector<bricks::BoundingBox>& boxes, std::uint32_t leafSize, std::size_t index,
  std::multiset<std::uint32_t>& found, std::vector<std::uint32_t>& below, int depth)
{
  using Node = bricks::WideBvhNode<Reference>;
  ASSERT_LT(index, tree.GetNodes().size());
  ASSERT_LT(depth, 33);
  const Node& node = tree.GetNodes()[index];
  ASSERT_GE(node.Children, 1);
  ASSERT_LE(node.Children, Node::Width);
  for (int child = 0; child < node.Children; ++child)
  {
    std::vector<std::uint32_t> items;
    const Reference reference = node.References[child];
    if (reference & Node::LeafBit)
    {
      const int countShift = 8 * sizeof(Reference) - 3;
      const std::uint32_t count = (reference >> countShift & 3u) + 1;
      const std::uint32_t first = reference & ((Reference(1) << countShift) - 1);
      ASSERT_LE(count, leafSize);
      ASSERT_LE(first + count, tree.GetOrder().size());
      items.assign(tree.GetOrder().begin() + first, tree.GetOrder().begin() + first + count);
      found.insert(items.begin(), items.end());
    }
    else
    {
      CheckNode(tree, boxes, leafSize, reference, found, items, depth + 1);
    }
    for (const std::uint32_t item : items)
    {
      float lower[4];
      float upper[4];
      boxes[item].Lower.Store(lower);
      boxes[item].Upper.Store(upper);
      for (int axis = 0; axis < 3; ++axis)
      {
        const double scale = std::ldexp(1.0, node.Exponent[axis] - 127);
        const double low = node.Origin[axis] + scale * node.Bounds[8 * axis + child];
        const double high = node.Origin[axis] + scale * node.Bounds[8 * (3 + axis) + child];
        ASSERT_LE(low, lower[axis]);
        ASSERT_GE(high, upper[axis]);
      }
    }
    below.insert(below.end(), items.begin(), items.end());
  }
}

template <class Reference>
void CheckTree(const std::vector<bricks::BoundingBox>& boxes, std::uint32_t leafSize)
{
  bricks::WideBvhBuilder<Reference> tree(leafSize);
  tree.Build(boxes);
  std::multiset<std::uint32_t> found;
  std::vector<std::uint32_t> below;
  CheckNode(tree, boxes, leafSize, 0, found, below, 0);
  ASSERT_EQ(found.size(), boxes.size());
  EXPECT_EQ(std::set<std::uint32_t>(found.begin(), found.end()).size(), boxes.size());
}

} // namespace

TEST(WideBvh, HoldsEveryItemOnceWithinItsBoxes)
{
  for (const int count : { 1, 2, 4, 5, 8, 9, 63, 1000, 8000 })
  {
    CheckTree<std::uint16_t>(CreateBoxes(count, 60, 1.0f), 4);
    CheckTree<std::uint32_t>(CreateBoxes(count, 61, 1.0f), 1);
  }
}

TEST(WideBvh, ItemsInOnePlaceAreCutByNumber)
{
  CheckTree<std::uint16_t>(std::vector<bricks::BoundingBox>(8191, CreateBoxes(1, 62, 1.0f)[0]), 4);
}

TEST(WideBvh, ItemsThatNoBinningPartsWell)
{
  // Each is a tenth of the size of the one before: every cut takes off one.
  std::vector<bricks::BoundingBox> boxes;
  for (int item = 0; item < 3000; ++item)
  {
    const float place = std::pow(0.98f, static_cast<float>(item));
    const float lower[3] = { place, 0.0f, 0.0f };
    const float upper[3] = { place, place, place };
    boxes.push_back(CreateBox(lower, upper));
  }
  CheckTree<std::uint16_t>(boxes, 4);
  CheckTree<std::uint32_t>(boxes, 1);
}

TEST(WideBvh, PointsAndHugeBoxes)
{
  std::vector<bricks::BoundingBox> boxes = CreateBoxes(100, 63, 1e18f);
  const float point[3] = { 0.0f, 0.0f, 0.0f };
  boxes.push_back(CreateBox(point, point));
  CheckTree<std::uint16_t>(boxes, 4);
  CheckTree<std::uint16_t>({ CreateBox(point, point) }, 4);
}

TEST(WideBvh, RangesOfValuesSkipSubtreesAndNothingThatIsLookedFor)
{
  CheckRanges<std::uint16_t>(4);
  CheckRanges<std::uint32_t>(1);
}

TEST(BrickBvh, RaysMeetEveryBrickOnTheirWayNearestFirst)
{
  const std::vector<bricks::BoundingBox> boxes = CreateBoxes(2000, 64, 1.0f);
  const bricks::BrickBvh bvh(boxes);
  std::mt19937 random(65);
  for (int count = 0; count < 500; ++count)
  {
    const TestRay ray(random, count);
    const float last = 1.9f;
    std::set<std::uint32_t> visited;
    rt::TraverseWideBvh(bvh.GetNodes(), rt::ChildrenOnRay(ray.Line, last),
      [&](std::uint32_t leaf)
      { EXPECT_TRUE(visited.insert(bricks::BrickBvh::GetBrick(leaf)).second); });
    std::size_t expected = 0;
    for (std::size_t brick = 0; brick < boxes.size(); ++brick)
    {
      if (ray.Meets(boxes[brick], last))
      {
        ++expected;
        EXPECT_EQ(visited.count(static_cast<std::uint32_t>(brick)), 1u) << brick;
      }
    }
    // The boxes are rounded outward, so a few more.
    EXPECT_LE(visited.size(), 2 * expected + 10);
  }
}

TEST(BrickBvh, ShorteningTheRayEndsTheWalk)
{
  std::vector<bricks::BoundingBox> boxes;
  for (int slab = 0; slab < 200; ++slab)
  {
    const float lower[3] = { 0.0f, 0.0f, static_cast<float>(slab) };
    const float upper[3] = { 1.0f, 1.0f, slab + 0.5f };
    boxes.push_back(CreateBox(lower, upper));
  }
  const bricks::BrickBvh bvh(boxes);
  const double origin[3] = { 0.5, 0.5, -1.0 };
  const double infinity = std::numeric_limits<double>::infinity();
  const double inverse[3] = { infinity, infinity, 1.0 };
  rt::BoxRay ray;
  ray.Set(origin, inverse, 1e-6);
  float last = 1000.0f;
  std::vector<std::uint32_t> visited;
  rt::TraverseWideBvh(bvh.GetNodes(), rt::ChildrenOnRay(ray, last),
    [&](std::uint32_t leaf)
    {
      visited.push_back(bricks::BrickBvh::GetBrick(leaf));
      last = visited.size() == 5 ? 6.2f : last;
    });
  EXPECT_EQ(visited, (std::vector<std::uint32_t>{ 0, 1, 2, 3, 4, 5 }));
  EXPECT_TRUE(bricks::BrickBvh(std::vector<bricks::BoundingBox>()).IsEmpty());
}
