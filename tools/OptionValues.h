// SPDX-License-Identifier: BSD-3-Clause
#ifndef OptionValues_h
#define OptionValues_h

#include "DSMCore/base/Error.h"

#include <functional>
#include <limits>
#include <locale>
#include <map>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

/// How the values of command line options are read. All throw dsm::Error, naming the option.
namespace OptionValues
{

/// Reads a number in [smallest, greatest], whatever the locale is.
template <class T>
T ToNumber(const std::string& name, const std::string& text, T smallest,
  T greatest = std::numeric_limits<T>::max())
{
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  T value{};
  const bool wraps = std::is_unsigned_v<T> && text.find('-') != std::string::npos;
  if (wraps || !(stream >> value) || !stream.eof() || value < smallest || value > greatest)
  {
    std::ostringstream message;
    message.imbue(std::locale::classic());
    message << name << " takes a number of at least " << smallest;
    if (greatest != std::numeric_limits<T>::max())
    {
      message << " and at most " << greatest;
    }
    message << ", not \"" << text << "\".";
    throw dsm::Error(message.str());
  }
  return value;
}

template <class T>
std::vector<T> ToNumbers(const std::string& name, const std::string& text, T smallest)
{
  std::vector<T> values;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');)
  {
    values.push_back(ToNumber<T>(name, part, smallest));
  }
  return values;
}

template <class T>
T ToChoice(const std::string& name, const std::string& text, const std::map<std::string, T>& known)
{
  const auto found = known.find(text);
  if (found == known.end())
  {
    std::string all;
    for (const auto& [word, value] : known)
    {
      all += (all.empty() ? "" : ", ") + word;
    }
    throw dsm::Error(name + " knows " + all + ", not \"" + text + "\".");
  }
  return found->second;
}

inline bool ToSwitch(const std::string& name, const std::string& text)
{
  return ToChoice<bool>(name, text, { { "on", true }, { "off", false } });
}

/// What to do with an option's name and value.
using Setters = std::map<std::string, std::function<void(const std::string&, const std::string&)>>;

/// Reads "--name value" pairs from argument 2 on.
inline void Parse(int argc, char** argv, const Setters& setters, const char* usage)
{
  for (int argument = 2; argument < argc; argument += 2)
  {
    const std::string name = argv[argument];
    const auto setter = setters.find(name);
    if (setter == setters.end() || argument + 1 >= argc)
    {
      throw dsm::Error("Option " + name +
        (setter == setters.end() ? " is not known.\n" : " lacks its value.\n") + usage);
    }
    setter->second(name, argv[argument + 1]);
  }
}

} // namespace OptionValues

#endif
