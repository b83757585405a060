// SPDX-License-Identifier: BSD-3-Clause
// A target with defects, for the test of FuzzMain.cxx (test_loop.py): each of three words in the input is one.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  const std::string text(bytes, bytes + count);
  const auto has = [&](const char* word) { return text.find(word) != std::string::npos; };
  if (has("throw"))
  {
    throw std::runtime_error("not caught");
  }
  if (has("large"))
  {
    const std::vector<char> large(std::size_t(300) << 20);
  }
  for (volatile bool forever = has("loop"); forever;)
  {
  }
  return 0;
}
