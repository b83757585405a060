// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/plain/HeaderText.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace vol
{

namespace
{

/// As in the "C" locale.
bool IsSpace(char letter)
{
  return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

/// Limit for the numbers in a field: one for each axis, or a matrix.
constexpr std::size_t MostNumbers = FileLimits::Axes;

/// Most headers are shorter.
constexpr std::size_t FirstBytes = 1 << 14;

} // namespace

HeaderLines::HeaderLines(const std::string& path)
  : Path(path)
  , Text(ReadBeginning(path, FirstBytes))
  , IsAll(Text.size() < FirstBytes)
{
}

bool HeaderLines::Next(std::string& line)
{
  std::size_t end = this->Text.find('\n', this->Place);
  if (end == std::string::npos && !this->IsAll)
  {
    this->Text = ReadBeginning(this->Path, FileLimits::HeaderBytes);
    this->IsAll = this->Text.size() < FileLimits::HeaderBytes;
    end = this->Text.find('\n', this->Place);
    if (end == std::string::npos && !this->IsAll)
    {
      throw FileError(this->Path,
        "has an invalid header: it does not end within " + std::to_string(FileLimits::HeaderBytes) +
          " bytes.");
    }
  }
  this->Ended = end == std::string::npos;
  if (this->Place >= this->Text.size())
  {
    return false;
  }
  line = this->Text.substr(this->Place, end - this->Place);
  this->Place = this->Ended ? this->Text.size() : end + 1;
  return true;
}

std::string HeaderText::Trim(const std::string& text)
{
  const auto first = std::find_if_not(text.begin(), text.end(), &IsSpace);
  const auto last = std::find_if_not(text.rbegin(), text.rend(), &IsSpace).base();
  return first < last ? std::string(first, last) : std::string();
}

std::vector<std::string> HeaderText::Split(const std::string& text)
{
  std::vector<std::string> found;
  for (auto word = text.begin(); word != text.end();)
  {
    const auto first = std::find_if_not(word, text.end(), &IsSpace);
    word = std::find_if(first, text.end(), &IsSpace);
    if (first != word)
    {
      found.emplace_back(first, word);
    }
  }
  return found;
}

void HeaderText::AddLine(const std::string& line, const std::string& separator)
{
  const std::size_t place = line.find(separator);
  if (place == std::string::npos)
  {
    return;
  }
  std::string name = ToLower(Trim(line.substr(0, place)));
  for (const auto& [known, other] : this->Names)
  {
    name = name == other ? known : name;
  }
  this->Values[name] = Trim(line.substr(place + separator.size()));
}

std::string HeaderText::Get(const std::string& name) const
{
  const auto known = this->Values.find(name);
  return known == this->Values.end() ? std::string() : known->second;
}

std::vector<double> HeaderText::GetNumbers(const std::string& name, std::size_t count) const
{
  std::vector<double> numbers = this->ToNumbers(name, this->Get(name));
  if (count != 0 && !numbers.empty() && numbers.size() != count)
  {
    this->Refuse("its field '" + name + "' has " + std::to_string(numbers.size()) +
      " numbers instead of " + std::to_string(count) + ".");
  }
  return numbers;
}

std::vector<std::int64_t> HeaderText::GetIntegers(
  const std::string& name, std::size_t count, std::int64_t least) const
{
  std::vector<std::int64_t> integers;
  for (const double number : this->GetNumbers(name, count))
  {
    const auto integer = ToInteger(number, least, MostInteger);
    if (!integer)
    {
      const std::string range =
        least == -MostInteger ? "" : " from " + std::to_string(least) + " on";
      this->Refuse("its field '" + name + "' is " + Quote(this->Get(name)) +
        "; integers are required" + range + ".");
    }
    integers.push_back(*integer);
  }
  return integers;
}

std::int64_t HeaderText::GetInteger(
  const std::string& name, std::int64_t usual, std::int64_t least) const
{
  const std::vector<std::int64_t> integers = this->GetIntegers(name, 1, least);
  return integers.empty() ? usual : integers.front();
}

std::vector<double> HeaderText::ToNumbers(const std::string& name, const std::string& text) const
{
  const std::vector<std::string> words = Split(text);
  if (words.size() > MostNumbers)
  {
    this->Refuse("its field '" + name + "' has " + std::to_string(words.size()) +
      " numbers; at most " + std::to_string(MostNumbers) + " are supported.");
  }
  std::vector<double> numbers;
  for (const std::string& word : words)
  {
    const char* const first = word.data() + (word.size() > 1 && word[0] == '+' ? 1 : 0);
    const char* const last = word.data() + word.size();
    double number = 0.0;
    const auto parsed = std::from_chars(first, last, number);
    if (parsed.ec != std::errc() || parsed.ptr != last)
    {
      this->Refuse(Quote(word) + " in its field '" + name + "' is not a number" +
        (parsed.ec == std::errc::result_out_of_range ? " in the range of double precision." : "."));
    }
    numbers.push_back(number);
  }
  return numbers;
}

void HeaderText::Refuse(const std::string& why) const
{
  throw FileError(this->What, "cannot be read: " + why);
}

} // namespace vol
