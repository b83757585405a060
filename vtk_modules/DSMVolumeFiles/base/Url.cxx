// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/Url.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>

namespace vol
{

bool IsUrl(const std::string& name)
{
  const std::size_t end = name.find("://");
  const auto isOfScheme = [](unsigned char letter)
  {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
      (letter >= '0' && letter <= '9') || letter == '+' || letter == '-' || letter == '.';
  };
  return end != std::string::npos && end > 0 &&
    std::all_of(
      name.begin(), name.begin() + static_cast<std::string::difference_type>(end), isOfScheme);
}

std::string HideCredentials(const std::string& name)
{
  if (!IsUrl(name))
  {
    return name;
  }
  const std::size_t host = name.find("://") + 3;
  const std::string beginning = name.substr(0, host);
  std::string rest = name.substr(host);
  const std::size_t query = rest.find_first_of("?#");
  const std::string behind = query == std::string::npos ? "" : rest.substr(query, 1) + "...";
  rest.resize(std::min(query, rest.size()));
  // A password may have a slash in it, where it should not.
  const std::size_t user = rest.rfind('@');
  return beginning + (user == std::string::npos ? rest : "...@" + rest.substr(user + 1)) + behind;
}

std::string GetWholePath(const std::string& path)
{
  std::error_code failure;
  return IsUrl(path) ? path : std::filesystem::absolute(path, failure).string();
}

} // namespace vol
