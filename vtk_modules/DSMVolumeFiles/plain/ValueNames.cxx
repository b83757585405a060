// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/plain/ValueNames.h"

#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <optional>

namespace vol
{

namespace
{

std::optional<std::int64_t> ParseInteger(const std::string& word)
{
  constexpr std::int64_t most = std::int64_t(1) << 31;
  std::int64_t number = 0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), number);
  return parsed.ec == std::errc() && parsed.ptr == word.data() + word.size() &&
      std::abs(number) <= most
    ? std::optional<std::int64_t>(number)
    : std::nullopt;
}

/// "2" or "2D".
std::optional<std::int64_t> ParseAxes(const std::string& word)
{
  const bool hasLetter = word.size() > 1 && (word.back() == 'D' || word.back() == 'd');
  return ParseInteger(hasLetter ? word.substr(0, word.size() - 1) : word);
}

/// A name with a place for a number, as printf has it: "a%03d.raw".
struct Pattern
{
  std::string Before;
  std::string After;
  std::size_t Width = 0;
  char Fill = ' ';

  std::string Write(std::int64_t number) const
  {
    const bool isNegative = number < 0 && this->Fill == '0';
    std::string digits = std::to_string(isNegative ? -number : number);
    const std::size_t width = this->Width - (isNegative && this->Width > 0 ? 1 : 0);
    digits.insert(0, width - std::min(width, digits.size()), this->Fill);
    return this->Before + (isNegative ? "-" : "") + digits + this->After;
  }
};

/// Returns nothing unless there is one place for a number; "%%" is a percent sign.
std::optional<Pattern> ParsePattern(const std::string& text)
{
  constexpr std::size_t widest = 20;
  Pattern pattern;
  bool has = false;
  for (std::size_t at = 0; at < text.size(); ++at)
  {
    std::string& part = has ? pattern.After : pattern.Before;
    if (text[at] != '%' || text.compare(at, 2, "%%") == 0)
    {
      part += text[at];
      at += text[at] == '%' ? 1 : 0;
      continue;
    }
    const std::size_t end = text.find_first_not_of("0123456789", at + 1);
    if (has || end == std::string::npos || std::string("diu").find(text[end]) == std::string::npos)
    {
      return std::nullopt;
    }
    has = true;
    pattern.Fill = text[at + 1] == '0' ? '0' : ' ';
    const auto width = ParseInteger(end == at + 1 ? "0" : text.substr(at + 1, end - at - 1));
    pattern.Width =
      static_cast<std::size_t>(std::clamp<std::int64_t>(width.value_or(0), 0, widest));
    at = end;
  }
  return has ? std::optional<Pattern>(pattern) : std::nullopt;
}

/// A field of a header that names several files.
struct Several
{
  std::optional<Pattern> Numbered; ///< none: a list follows
  std::vector<std::int64_t> Numbers;
  std::optional<std::int64_t> Axes;
};

/// Returns nothing for a single file's name.
std::optional<Several> ParseSeveral(const std::string& place)
{
  const std::vector<std::string> words = HeaderText::Split(place);
  Several several;
  const auto takeAxes = [&](const std::string& word)
  {
    several.Axes = ParseAxes(word);
    return several.Axes.has_value();
  };
  if (IsList(place))
  {
    several.Axes = ParseAxes(words.back());
    return several;
  }
  // Two to four numbers end the field; a name may have blanks.
  std::size_t end = place.size();
  std::vector<std::string> last;
  while (last.size() < 4 && last.size() + 1 < words.size() &&
    (ParseInteger(words[words.size() - 1 - last.size()]) ||
      (last.empty() && takeAxes(words.back()))))
  {
    last.insert(last.begin(), words[words.size() - 1 - last.size()]);
    end = place.rfind(last.front(), end - 1);
  }
  if (last.size() < 2)
  {
    return std::nullopt;
  }
  several.Axes.reset();
  if (last.size() == 4)
  {
    takeAxes(last.back());
    last.pop_back();
  }
  for (const std::string& word : last)
  {
    const auto number = ParseInteger(word);
    if (!number)
    {
      return std::nullopt;
    }
    several.Numbers.push_back(*number);
  }
  several.Numbered = ParsePattern(HeaderText::Trim(place.substr(0, end)));
  return several.Numbered ? std::optional<Several>(several) : std::nullopt;
}

} // namespace

bool IsList(const std::string& place)
{
  const std::vector<std::string> words = HeaderText::Split(place);
  return !words.empty() && words.front() == "LIST" &&
    (words.size() == 1 || (words.size() == 2 && ParseAxes(words.back())));
}

std::vector<std::string> FindValueFiles(const HeaderText& header, const std::string& name,
  HeaderLines& lines, const std::vector<std::int64_t>& sizes)
{
  const std::string field = "its field '" + name + "'";
  const std::filesystem::path folder = std::filesystem::path(header.GetPath()).parent_path();
  const auto getPath = [&](const std::string& place)
  {
    if (place.size() > FileLimits::NameBytes || place.find('\0') != std::string::npos)
    {
      header.Refuse(field + " has something else than a file name: " + Quote(place) + ".");
    }
    return (folder / place).string();
  };
  const std::string place = header.Get(name);
  const std::string path = getPath(place);
  const std::optional<Several> several = ParseSeveral(place);
  if (!several || FindPathKind(path) != PathKind::Nothing)
  {
    return { path };
  }
  std::vector<std::string> paths;
  const auto add = [&](const std::string& file)
  {
    paths.push_back(getPath(file));
    CheckLimit(header.GetPath(), "files of values", paths.size(), FileLimits::Sources);
  };
  if (several->Numbered)
  {
    const std::int64_t first = several->Numbers[0];
    const std::int64_t last = several->Numbers[1];
    const std::int64_t step = several->Numbers.size() > 2 ? several->Numbers[2]
      : last < first                                      ? -1
                                                          : 1;
    if (step == 0 || (last != first && (last > first) != (step > 0)))
    {
      header.Refuse(field + " is " + Quote(place) +
        ": its numbers do not lead from the first to "
        "the last one.");
    }
    CheckLimit(header.GetPath(), "files of values",
      static_cast<std::uint64_t>((last - first) / step) + 1, FileLimits::Sources);
    for (std::int64_t count = 0; count <= (last - first) / step; ++count)
    {
      add(several->Numbered->Write(first + count * step));
    }
  }
  std::string line;
  while (!several->Numbered && lines.Next(line) && !HeaderText::Trim(line).empty())
  {
    add(HeaderText::Trim(line));
  }
  const auto axes = static_cast<std::int64_t>(sizes.size());
  const std::int64_t own = several->Axes.value_or(axes - 1);
  if (own < 1 || own > axes)
  {
    header.Refuse(field + " says that each file has " + std::to_string(own) + " axes of " +
      std::to_string(axes) + ".");
  }
  // Files with all axes each have a part of the last one.
  std::optional<std::uint64_t> wanted = 1;
  for (std::int64_t axis = own; axis < axes && wanted; ++axis)
  {
    const std::int64_t size = std::max<std::int64_t>(0, sizes[static_cast<std::size_t>(axis)]);
    wanted = MultiplyWithin(FileLimits::ArrayBytes, { *wanted, static_cast<std::uint64_t>(size) });
  }
  const bool isShared = own == axes && !paths.empty() && !sizes.empty() &&
    sizes.back() % static_cast<std::int64_t>(paths.size()) == 0;
  if (!isShared && wanted != paths.size())
  {
    header.Refuse(field + " names " + std::to_string(paths.size()) + " files instead of " +
      (own == axes ? "a number that divides " + std::to_string(sizes.empty() ? 0 : sizes.back())
                   : std::to_string(wanted.value_or(0))) +
      ".");
  }
  return paths;
}

} // namespace vol
