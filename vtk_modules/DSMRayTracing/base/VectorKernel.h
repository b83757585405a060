// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VectorKernel_h
#define rt_VectorKernel_h

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <vector>

// A kernel is a table of functions: a struct with `const char* Name`, `int Width` (rays at once), pointers to
// functions, and two functions that the macros below define:
//
//   static const Kernel& GetBest();         // the fastest that this processor can run
//   static std::vector<Kernel> GetAll();    // all that it can run, that of width 1 first; for tests
//
// Its source is compiled once for each instruction set (VectorTargets.h, foreach_target.h). A template
// `Steps<D>`, with vectors D, has `static Kernel Create(const char* name)`.

/// In the namespace of an instruction set: creates the kernel with vectors of up to `lanes` numbers, and of one.
#define RT_CREATE_KERNEL(Kernel, Steps, number, lanes)                                             \
  Kernel CreateWide##Kernel()                                                                      \
  {                                                                                                \
    return Steps<hwy::HWY_NAMESPACE::CappedTag<number, lanes>>::Create(                            \
      hwy::TargetName(HWY_TARGET));                                                                \
  }                                                                                                \
  Kernel CreateSingle##Kernel()                                                                    \
  {                                                                                                \
    return Steps<hwy::HWY_NAMESPACE::CappedTag<number, 1>>::Create("one ray at a time");           \
  }

/// In the namespace of the kernel, once (HWY_ONCE): picks the instruction set.
#define RT_DISPATCH_KERNEL(Kernel)                                                                 \
  namespace                                                                                        \
  {                                                                                                \
  HWY_EXPORT(CreateWide##Kernel);                                                                  \
  HWY_EXPORT(CreateSingle##Kernel);                                                                \
  }                                                                                                \
  const Kernel& Kernel::GetBest()                                                                  \
  {                                                                                                \
    static const Kernel best = HWY_DYNAMIC_DISPATCH(CreateWide##Kernel)();                         \
    return best;                                                                                   \
  }                                                                                                \
  std::vector<Kernel> Kernel::GetAll()                                                             \
  {                                                                                                \
    return rt::CreateForAllTargets<Kernel>({ HWY_DYNAMIC_DISPATCH(CreateSingle##Kernel)() },       \
      [] { return HWY_DYNAMIC_DISPATCH(CreateWide##Kernel)(); });                                  \
  }

namespace rt
{

/// `kernels`, and what `create` makes for each instruction set that this processor has. Changes what Highway
/// dispatches to while it runs, so no other thread may dispatch or trace meanwhile.
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
