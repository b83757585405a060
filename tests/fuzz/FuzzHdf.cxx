// SPDX-License-Identifier: BSD-3-Clause
// Any HDF5 file, without VTK's group: layouts, indices of chunks, filters, values in other files.
#include "FuzzedHdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  fuzz::CheckHdf("input.h5", bytes, count);
  return 0;
}
