// SPDX-License-Identifier: BSD-3-Clause
// Random blocks, eight threads, a cache of three of the largest blocks, a million accesses, every
// byte checked; with and without asking first.
#include "DSMCore/paged/PagedStore.h"

#include "tests/unit/dsmcore/PagedScenarios.h"

namespace
{

class PagedStoreStress : public testing::TestWithParam<dsm_test::Way>
{
protected:
  void Run(int ranks, int workers, int accesses)
  {
    const dsm_test::Way way = this->GetParam();
    const std::string refusal = way.GetRefusal();
    if (!refusal.empty())
    {
      GTEST_SKIP() << refusal;
    }
    dsm_test::RunRanks(ranks,
      [&](dsm::Messenger& messenger)
      { dsm_test::PagedRandomAccess(messenger, way, workers, accesses); });
  }
};

INSTANTIATE_TEST_SUITE_P(Ways, PagedStoreStress, testing::ValuesIn(dsm_test::GetAllWays()),
  [](const testing::TestParamInfo<dsm_test::Way>& way) { return way.param.GetName(); });

TEST_P(PagedStoreStress, TwoRanksOfEightThreads)
{
  this->Run(2, 8, 62500);
}

TEST_P(PagedStoreStress, FourRanksOfTwoThreads)
{
  this->Run(4, 2, 20000);
}

} // namespace
