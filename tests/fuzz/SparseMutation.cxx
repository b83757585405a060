// SPDX-License-Identifier: BSD-3-Clause
// Changes of HDF5 files for libFuzzer: most of their bytes are 0 and have no meaning, so that half of the changes
// are made around one that is not.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t count, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(
  std::uint8_t* bytes, std::size_t count, std::size_t most, unsigned seed)
{
  std::minstd_rand random(seed);
  const auto zeros = static_cast<std::size_t>(std::count(bytes, bytes + count, std::uint8_t(0)));
  if (zeros == count || random() % 2 == 0)
  {
    return LLVMFuzzerMutate(bytes, count, most);
  }
  std::size_t left = random() % (count - zeros);
  std::uint8_t* const place =
    std::find_if(bytes, bytes + count, [&](std::uint8_t byte) { return byte != 0 && left-- == 0; });
  // In place: what lies behind stays where other structures expect it.
  const std::size_t window = std::size_t(1) << random() % 7;
  const std::size_t some = std::min(window, static_cast<std::size_t>(bytes + count - place));
  LLVMFuzzerMutate(place, some, some);
  return count;
}
