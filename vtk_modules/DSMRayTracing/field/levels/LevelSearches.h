// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelSearches_h
#define rt_LevelSearches_h

// All that LevelField names.
#include "DSMRayTracing/field/lattice/VoxelExtrema.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/field/levels/LevelMedia.h"
#include "DSMRayTracing/field/levels/LevelSampler.h"
#include "DSMRayTracing/field/levels/LevelSections.h"
#include "DSMRayTracing/field/levels/LevelSurfaces.h"

#endif
