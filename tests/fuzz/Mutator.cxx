// SPDX-License-Identifier: BSD-3-Clause
#include "Mutator.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace fuzz
{

namespace
{

constexpr std::uint64_t Numbers[] = { 0, 1, 2, 3, 4, 7, 8, 16, 31, 32, 33, 63, 64, 65, 100, 127,
  128, 255, 256, 511, 512, 1000, 1024, 4096, 32767, 32768, 65535, 65536, 0xffffff, 0x1000000,
  0x7fffffff, 0x80000000, 0xffffffff, 0x100000000, 0x7fffffffffff, 0x3fffffffffffffff,
  0x4000000000000000, 0x7fffffffffffffff, 0x8000000000000000, 0xfffffffffffffff0,
  0xffffffffffffffff };

constexpr const char* Texts[] = { "0", "1", "-1", "2", "3", "5", "33", "64", "65536", "2147483647",
  "2147483648", "-2147483649", "4294967296", "9223372036854775807", "9223372036854775808",
  "18446744073709551615", "18446744073709551616", "1e9", "1e-9", "1e19", "1e308", "1e999", "0.5",
  "nan", "inf", "-0", "00", "1.0" };

std::uint8_t FromHex(const std::string& line, std::size_t at)
{
  std::size_t used = 0;
  const unsigned long value = std::stoul(line.substr(at, 2), &used, 16);
  if (used != 2)
  {
    throw std::runtime_error("not two hexadecimal digits behind \\x: " + line);
  }
  return static_cast<std::uint8_t>(value);
}

} // namespace

Mutator::Mutator(std::vector<Input> seeds, std::vector<Input> words, std::uint64_t number)
  : Seeds(std::move(seeds))
  , Words(std::move(words))
  , Random(number)
{
}

std::size_t Mutator::Choose(std::size_t count)
{
  return count == 0 ? 0 : static_cast<std::size_t>(this->Random() % count);
}

std::size_t Mutator::ChoosePlace(const Input& input)
{
  const auto zeros =
    static_cast<std::size_t>(std::count(input.begin(), input.end(), std::uint8_t(0)));
  if (zeros == input.size() || this->Choose(2) == 0)
  {
    return this->Choose(input.size());
  }
  std::size_t left = this->Choose(input.size() - zeros);
  const auto found = std::find_if(
    input.begin(), input.end(), [&](std::uint8_t byte) { return byte != 0 && left-- == 0; });
  return static_cast<std::size_t>(found - input.begin());
}

Input Mutator::Make(std::size_t mostBytes)
{
  Input input = this->Seeds[this->Choose(this->Seeds.size())];
  do
  {
    this->Change(input);
  } while (this->Choose(3) != 0);
  input.resize(std::min(input.size(), mostBytes));
  return input;
}

void Mutator::Change(Input& input)
{
  using Way = void (Mutator::*)(Input&);
  constexpr Way ways[] = { &Mutator::FlipBit, &Mutator::SetByte, &Mutator::SetNumber,
    &Mutator::SetNumber, &Mutator::SetDigits, &Mutator::Erase, &Mutator::CopyBlock,
    &Mutator::PutWord, &Mutator::PutWord, &Mutator::Splice };
  (this->*ways[this->Choose(std::size(ways))])(input);
}

void Mutator::FlipBit(Input& input)
{
  if (!input.empty())
  {
    input[this->ChoosePlace(input)] ^= static_cast<std::uint8_t>(1u << this->Choose(8));
  }
}

void Mutator::SetByte(Input& input)
{
  if (!input.empty())
  {
    input[this->ChoosePlace(input)] = static_cast<std::uint8_t>(this->Random());
  }
}

void Mutator::SetNumber(Input& input)
{
  const std::size_t place = this->ChoosePlace(input);
  const std::size_t bytes = std::min(std::size_t(1) << this->Choose(4), input.size() - place);
  const bool bigEndian = this->Choose(8) == 0;
  const auto at = [&](std::size_t byte) -> std::uint8_t&
  { return input[place + (bigEndian ? bytes - 1 - byte : byte)]; };
  std::uint64_t number = 0;
  for (std::size_t byte = bytes; byte-- > 0;)
  {
    number = number << 8 | at(byte);
  }
  switch (this->Choose(4))
  {
    case 0:
      number += this->Choose(17) - 8;
      break;
    case 1:
      number = number << 1 ^ this->Choose(2);
      break;
    default:
      number = Numbers[this->Choose(std::size(Numbers))];
  }
  for (std::size_t byte = 0; byte < bytes; ++byte)
  {
    at(byte) = static_cast<std::uint8_t>(number >> (8 * byte));
  }
}

void Mutator::SetDigits(Input& input)
{
  const auto isDigit = [](std::uint8_t byte) { return std::isdigit(byte) != 0; };
  const auto from = input.begin() + static_cast<std::ptrdiff_t>(this->Choose(input.size()));
  const auto first = std::find_if(from, input.end(), isDigit);
  const auto last = std::find_if_not(first, input.end(), isDigit);
  if (first == last)
  {
    this->FlipBit(input);
    return;
  }
  const std::string text = Texts[this->Choose(std::size(Texts))];
  const auto place = input.erase(first, last);
  input.insert(place, text.begin(), text.end());
}

void Mutator::Erase(Input& input)
{
  const std::size_t place = this->Choose(input.size());
  const std::size_t rest = input.size() - place;
  // Mostly a few bytes; sometimes all behind them, as of a file that was cut off.
  const std::size_t count =
    this->Choose(4) == 0 ? this->Choose(rest + 1) : std::min(rest, this->Choose(17));
  const auto first = input.begin() + static_cast<std::ptrdiff_t>(place);
  input.erase(first, first + static_cast<std::ptrdiff_t>(count));
}

void Mutator::CopyBlock(Input& input)
{
  const std::size_t place = this->ChoosePlace(input);
  const std::size_t count =
    std::min(input.size() - place, 1 + this->Choose(std::size_t(1) << this->Choose(10)));
  const auto first = input.begin() + static_cast<std::ptrdiff_t>(place);
  const Input block(first, first + static_cast<std::ptrdiff_t>(count));
  const std::size_t to = this->Choose(input.size() + 1);
  if (this->Choose(2) == 0)
  {
    input.insert(input.begin() + static_cast<std::ptrdiff_t>(to), block.begin(), block.end());
    return;
  }
  input.resize(std::max(input.size(), to + count));
  std::copy(block.begin(), block.end(), input.begin() + static_cast<std::ptrdiff_t>(to));
}

void Mutator::PutWord(Input& input)
{
  if (this->Words.empty())
  {
    this->SetNumber(input);
    return;
  }
  const Input& word = this->Words[this->Choose(this->Words.size())];
  const std::size_t place = this->ChoosePlace(input);
  if (this->Choose(2) == 0)
  {
    input.insert(input.begin() + static_cast<std::ptrdiff_t>(place), word.begin(), word.end());
    return;
  }
  input.resize(std::max(input.size(), place + word.size()));
  std::copy(word.begin(), word.end(), input.begin() + static_cast<std::ptrdiff_t>(place));
}

void Mutator::Splice(Input& input)
{
  const Input& other = this->Seeds[this->Choose(this->Seeds.size())];
  const std::size_t place = this->Choose(input.size() + 1);
  // At the same place of both, what lies behind has the same meaning more often.
  const std::size_t from =
    this->Choose(2) == 0 ? std::min(place, other.size()) : this->Choose(other.size() + 1);
  input.resize(place);
  input.insert(input.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
}

std::vector<Input> ReadDictionary(const std::string& path)
{
  std::ifstream file(path);
  if (!file)
  {
    throw std::runtime_error("the dictionary cannot be read: " + path);
  }
  std::vector<Input> words;
  for (std::string line; std::getline(file, line);)
  {
    if (line.empty() || line[0] == '#')
    {
      continue;
    }
    const std::size_t first = line.find('"');
    const std::size_t last = line.rfind('"');
    if (first == std::string::npos || last == first)
    {
      throw std::runtime_error("no word in quotes in " + path + ": " + line);
    }
    Input word;
    for (std::size_t at = first + 1; at < last; ++at)
    {
      const bool isEscaped = line[at] == '\\' && at + 1 < last;
      if (isEscaped && line[at + 1] == 'x')
      {
        word.push_back(FromHex(line, at + 2));
        at += 3;
      }
      else
      {
        at += isEscaped ? 1 : 0;
        word.push_back(static_cast<std::uint8_t>(line[at]));
      }
    }
    words.push_back(std::move(word));
  }
  return words;
}

} // namespace fuzz
