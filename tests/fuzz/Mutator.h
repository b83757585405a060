// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_Mutator_h
#define fuzz_Mutator_h

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fuzz
{

using Input = std::vector<std::uint8_t>;

/// Makes inputs out of seeds by random changes, without looking at what the target does with them. The same seeds,
/// words and number give the same inputs.
class Mutator
{
public:
  /// `seeds`: at least one. `words`: of the dictionary.
  Mutator(std::vector<Input> seeds, std::vector<Input> words, std::uint64_t number);

  /// A seed with one to about a dozen changes; at most so many bytes.
  Input Make(std::size_t mostBytes);

private:
  void Change(Input& input);
  void FlipBit(Input& input);
  void SetByte(Input& input);
  /// A number of 1 to 8 bytes, either byte order, to one at which programs go wrong, or to a neighbor of what it is.
  void SetNumber(Input& input);
  /// Digits of a text, likewise.
  void SetDigits(Input& input);
  void Erase(Input& input);
  void CopyBlock(Input& input);
  /// Overwrites or inserts a word of the dictionary.
  void PutWord(Input& input);
  /// Goes on as another seed does from some place.
  void Splice(Input& input);

  std::size_t Choose(std::size_t count);
  /// A place in the input, half of the time one with a byte that is not 0: headers are sparse.
  std::size_t ChoosePlace(const Input& input);

  std::vector<Input> Seeds;
  std::vector<Input> Words;
  std::mt19937_64 Random;
};

/// The words of a dictionary in libFuzzer's format: lines such as name="bytes\x00", and comments behind #. Throws
/// std::runtime_error where a line is anything else.
std::vector<Input> ReadDictionary(const std::string& path);

} // namespace fuzz

#endif
