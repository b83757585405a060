// SPDX-License-Identifier: BSD-3-Clause
// What a target does first where libFuzzer has the main function.
#include "CrashNotes.h"
#include "InputFolder.h"

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  fuzz::GetInputFolder();
  // With -fork=1, libFuzzer goes on after a process that ends so.
  fuzz::InstallCrashNotes(0);
  fuzz::LimitAllocations(std::size_t(256) << 20);
  return 0;
}

// The HDF5 library gets nothing then, as without a sanitizer; operator new still ends the process.
extern "C" const char* __asan_default_options()
{
  return "allocator_may_return_null=1";
}

// What the HDF5 library does with damaged files is not the project's.
extern "C" const char* __asan_default_suppressions()
{
  return "interceptor_via_lib:libhdf5\n";
}

extern "C" const char* __lsan_default_suppressions()
{
  return "leak:libhdf5\n";
}
