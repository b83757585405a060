// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellSearches_h
#define rt_CellSearches_h

// All that CellField names.
#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/field/tetrahedra/CellMedia.h"
#include "DSMRayTracing/field/tetrahedra/CellSampler.h"
#include "DSMRayTracing/field/tetrahedra/CellSurfaces.h"
#include "DSMRayTracing/field/tetrahedra/CellWalk.h"
#include "DSMRayTracing/field/walk/WalkExtrema.h"
#include "DSMRayTracing/field/walk/WalkSections.h"

#endif
