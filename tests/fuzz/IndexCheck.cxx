// SPDX-License-Identifier: BSD-3-Clause
#include "IndexCheck.h"

#include "DSMCore/base/Error.h"

#include <optional>

namespace fuzz
{

namespace
{

/// As of one more brick, whose values are elsewhere.
bricks::IsovalueSurvey MakeOther(double least, double greatest, std::int64_t exponent)
{
  bricks::IsovalueSurvey other;
  other.All = 1;
  other.Exponent = exponent;
  other.Least = least;
  other.Greatest = greatest;
  other.First = static_cast<std::int64_t>(least);
  other.Values[0] = 4;
  return other;
}

} // namespace

void CheckIndex(const bricks::BrickLattice& lattice, const bricks::VoxelIndex& index)
{
  const bricks::MacrocellHierarchy levels(lattice, index.Bricks);
  levels.GetRange();
  for (const bricks::IsovalueSurvey& other :
    { bricks::IsovalueSurvey(), MakeOther(-255.0, 256.0, 0), MakeOther(0.0, 1.0, -3) })
  {
    bricks::IsovalueSurvey all;
    all.Add(index.Survey);
    all.Add(other);
    bricks::IsovalueSurvey turned = other;
    turned.Add(index.Survey);
    all.Accumulate();
    const std::size_t intervals = all.CountIntervals();
    for (const double border : { 0.0, 0.5, static_cast<double>(intervals) })
    {
      all.GetBorder(border);
    }
  }
}

void CheckIndex(const vol::FileArray& array, const vol::VolumeFile::Index& kept)
{
  std::optional<bricks::BrickLattice> lattice;
  try
  {
    lattice.emplace(array.Grid.Samples, array.Type, false, kept.BrickEdge);
  }
  catch (const dsm::Error&)
  {
    return; // no bricks can be cut so
  }
  const std::optional<bricks::VoxelIndex> index =
    bricks::VoxelIndex::Decode(kept.Bricks, lattice->GetBrickCount());
  if (index)
  {
    CheckIndex(*lattice, *index);
  }
}

} // namespace fuzz
