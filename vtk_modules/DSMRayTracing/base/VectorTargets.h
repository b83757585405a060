// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VectorTargets_h
#define rt_VectorTargets_h

// To be included before foreach_target.h. Vectors of a size that is only known at run time cannot be members; SSSE3
// alone is not worth code of its own.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

#include <hwy/targets.h>

#include <vector>

namespace rt
{

/// For tests: `kernels`, and what `create` makes for each kind of vectors that this processor has.
/// Changes what Highway dispatches to while it runs, so no other thread may dispatch meanwhile.
template <class Kernel, class Create>
std::vector<Kernel> CreateForAllTargets(std::vector<Kernel> kernels, Create create)
{
  for (const auto target : hwy::SupportedAndGeneratedTargets())
  {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    kernels.push_back(create());
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return kernels;
}

} // namespace rt

#endif
