// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeSearches_h
#define rt_LatticeSearches_h

// All that LatticeField names.
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/LatticeMedia.h"
#include "DSMRayTracing/field/lattice/LatticeSampler.h"
#include "DSMRayTracing/field/lattice/LatticeSections.h"
#include "DSMRayTracing/field/lattice/LatticeSurfaces.h"
#include "DSMRayTracing/field/lattice/VoxelExtrema.h"

#endif
