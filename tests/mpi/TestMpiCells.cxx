// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/MpiTransport.h"

#include "tests/unit/raytracing/CellScenarios.h"

namespace
{

#define RUN_SCENARIO(scenario)                                                                     \
  TEST(CellsOverMpi, scenario)                                                                     \
  {                                                                                                \
    dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));                                  \
    dsm_test::scenario(messenger);                                                                 \
  }

RUN_SCENARIO(AveragesDoNotDependOnPieces)
RUN_SCENARIO(CopiesStandInForMissingPieces)

} // namespace

#undef RUN_SCENARIO
