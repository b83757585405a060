// SPDX-License-Identifier: BSD-3-Clause
// What dsm_convert writes: bricks with their halos, levels of detail, ranges and the index of bricks.
#include "FuzzedHdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  fuzz::CheckHdf("bricks.vtkhdf", bytes, count);
  return 0;
}
