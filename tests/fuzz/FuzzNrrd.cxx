// SPDX-License-Identifier: BSD-3-Clause
// NRRD: a header, with values behind it or in "values.bin".
#include "FuzzedHeader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  fuzz::CheckHeader("input.nrrd", bytes, count);
  return 0;
}
