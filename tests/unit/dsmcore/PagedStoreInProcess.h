// SPDX-License-Identifier: BSD-3-Clause
#ifndef PagedStoreInProcess_h
#define PagedStoreInProcess_h

#include "DSMCore/paged/PagedStore.h"

#include "tests/unit/dsmcore/PagedScenarios.h"

#include <cstdio>
#include <cstdlib>
#include <functional>

/// For tests of what the page store shares with its process, with and without asking first.
namespace dsm_test
{

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool HasSanitizer = true;
#else
constexpr bool HasSanitizer = false;
#endif

constexpr int Good = 7;

/// In a death test: runs `check`, and ends the process with Good when nothing failed in it.
inline void RunAndExit(const std::function<void()>& check)
{
  check();
  std::fflush(nullptr);
  std::_Exit(testing::Test::HasFailure() ? EXIT_FAILURE : Good);
}

class PagedStoreInProcess : public testing::TestWithParam<Way>
{
protected:
  void SetUp() override
  {
    GTEST_FLAG_SET(death_test_style, "fast");
    const std::string refusal = this->GetParam().GetRefusal();
    if (!refusal.empty())
    {
      GTEST_SKIP() << refusal;
    }
  }
};

} // namespace dsm_test

#endif
