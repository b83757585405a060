// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_InterleavedHash_h
#define dsm_InterleavedHash_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace dsm
{

/// Goes through bytes in words of eight, which four states take in turn, as a processor does several multiplications
/// at once that do not wait for one another. `mix(state, word)` changes a state. Returns how many bytes were taken:
/// those that do not fill four words are left.
template <class State, class Mix>
std::size_t HashInterleaved(
  const std::byte* bytes, std::size_t count, std::array<State, 4>& states, const Mix& mix)
{
  std::array<std::uint64_t, 4> words;
  std::size_t at = 0;
  for (; at + sizeof(words) <= count; at += sizeof(words))
  {
    std::memcpy(words.data(), bytes + at, sizeof(words));
    for (std::size_t lane = 0; lane < words.size(); ++lane)
    {
      mix(states[lane], words[lane]);
    }
  }
  return at;
}

} // namespace dsm

#endif
