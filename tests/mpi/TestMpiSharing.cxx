// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/MpiTransport.h"

#include "tests/unit/dsmcore/SharingScenarios.h"

namespace
{

#define RUN_SCENARIO(scenario)                                                                     \
  TEST(SharingOverMpi, scenario)                                                                   \
  {                                                                                                \
    dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));                                  \
    dsm_test::scenario(messenger);                                                                 \
  }

RUN_SCENARIO(EveryRankHasEveryBlock)
RUN_SCENARIO(EveryHostHasEveryBlockOnce)
RUN_SCENARIO(SharedBlocksAreHits)
RUN_SCENARIO(SharedMemoryOutlivesItsOwner)
RUN_SCENARIO(CopiesOnceAGroup)
RUN_SCENARIO(AutomaticFollowsTheData)
RUN_SCENARIO(OrganizationsChangeUnderTheData)
RUN_SCENARIO(TooLittleMemoryIsRefusedWithNumbers)

} // namespace

#undef RUN_SCENARIO
