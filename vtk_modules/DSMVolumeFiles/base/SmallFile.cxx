// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/SmallFile.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/PositionedFile.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace vol
{

namespace
{

/// Reads `bytes` from the beginning of a file that has at least as many.
std::string ReadText(const PositionedFile& file, std::size_t bytes)
{
  if (file.IsDirectory())
  {
    throw FileError(file.GetPath(), "cannot be read: it is a directory.");
  }
  std::string text(bytes, '\0');
  // A process that uses a kept file changes its time, while others read it.
  file.ReadUnchecked(0, reinterpret_cast<std::byte*>(text.data()), text.size());
  return text;
}

} // namespace

PathKind FindPathKind(const std::string& path)
{
  std::error_code failure;
  const std::filesystem::file_type type = std::filesystem::status(path, failure).type();
  switch (type)
  {
    case std::filesystem::file_type::not_found:
      return PathKind::Nothing;
    case std::filesystem::file_type::regular:
      return PathKind::File;
    case std::filesystem::file_type::directory:
      return PathKind::Directory;
    case std::filesystem::file_type::none:
      throw FileError(path, "cannot be read: " + failure.message() + ".");
    default:
      return PathKind::Other;
  }
}

std::string ReadBeginning(const std::string& path, std::size_t most)
{
  const PositionedFile file(path);
  return ReadText(file, static_cast<std::size_t>(std::min<std::uint64_t>(most, file.GetBytes())));
}

std::string ReadWhole(const std::string& path, std::size_t most)
{
  const PositionedFile file(path);
  if (file.GetBytes() > most && !file.IsDirectory())
  {
    throw FileError(path,
      "has " + std::to_string(file.GetBytes()) + " bytes; at most " + std::to_string(most) +
        " are supported.");
  }
  return ReadText(file, static_cast<std::size_t>(std::min<std::uint64_t>(most, file.GetBytes())));
}

bool IsPlainName(const std::string& name)
{
  return !name.empty() && name != ".." && name.find('/') == std::string::npos;
}

std::string ListNames(const std::vector<std::string>& names, const std::vector<std::string>& notes)
{
  constexpr std::size_t most = 10;
  std::string list = names.empty() ? "none" : "";
  for (std::size_t index = 0; index < std::min(most, names.size()); ++index)
  {
    list += (index > 0 ? ", '" : "'") + names[index] + "'";
    list += notes.empty() ? "" : " (" + notes[index] + ")";
  }
  return list +
    (names.size() > most ? " and " + std::to_string(names.size() - most) + " more." : ".");
}

std::string GetStem(const std::string& path)
{
  const std::filesystem::path stem = std::filesystem::path(path).stem();
  return (stem.extension() == ".ome" ? stem.stem() : stem).string();
}

std::string ToLower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](char letter)
    { return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter; });
  return text;
}

std::string Quote(const std::string& text)
{
  constexpr std::size_t most = 100;
  std::string shown = text.substr(0, most);
  std::replace_if(
    shown.begin(), shown.end(), [](unsigned char letter) { return letter < ' '; }, '?');
  return "'" + shown + (text.size() > most ? "..." : "") + "'";
}

} // namespace vol
