// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VectorTargets_h
#define rt_VectorTargets_h

// To be included before foreach_target.h. Vectors of a size that is only known at run time cannot be members; SSSE3
// alone is not worth code of its own.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

#endif
