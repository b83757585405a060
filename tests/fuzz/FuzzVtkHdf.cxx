// SPDX-License-Identifier: BSD-3-Clause
// HDF5 files with VTK's group: images, active scalars, time steps and their offsets.
#include "FuzzedHdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  fuzz::CheckHdf("input.vtkhdf", bytes, count);
  return 0;
}
