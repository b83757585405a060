// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_IndexCheck_h
#define fuzz_IndexCheck_h

#include "DSMBricks/build/VoxelIndex.h"
#include "DSMVolumeFiles/format/VolumeFile.h"

namespace fuzz
{

/// Uses an index of bricks as the renderer does: builds the levels over the bricks, joins the survey with another one,
/// and asks for its intervals.
void CheckIndex(const bricks::BrickLattice& lattice, const bricks::VoxelIndex& index);

/// Decodes what a file has of an array, and does that.
void CheckIndex(const vol::FileArray& array, const vol::VolumeFile::Index& kept);

} // namespace fuzz

#endif
