// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/HeaderText.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>

namespace vol
{

std::string HeaderText::Trim(const std::string& text)
{
  const auto isSpace = [](unsigned char letter) { return std::isspace(letter) != 0; };
  const auto first = std::find_if_not(text.begin(), text.end(), isSpace);
  const auto last = std::find_if_not(text.rbegin(), text.rend(), isSpace).base();
  return first < last ? std::string(first, last) : std::string();
}

std::string HeaderText::ToLower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

std::vector<std::string> HeaderText::Split(const std::string& text)
{
  std::istringstream words(text);
  std::vector<std::string> found;
  for (std::string word; words >> word;)
  {
    found.push_back(word);
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
  for (const std::string& known : this->Names)
  {
    std::string together = known;
    together.erase(std::remove(together.begin(), together.end(), ' '), together.end());
    name = name == together ? known : name;
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

std::vector<double> HeaderText::ToNumbers(const std::string& name, const std::string& text) const
{
  std::vector<double> numbers;
  for (const std::string& word : Split(text))
  {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (end == word.c_str() || *end != '\0')
    {
      this->Refuse("'" + word + "' in its field '" + name + "' is no number.");
    }
  }
  return numbers;
}

void HeaderText::Refuse(const std::string& why) const
{
  throw dsm::Error("The header of '" + this->What + "' cannot be used: " + why);
}

} // namespace vol
