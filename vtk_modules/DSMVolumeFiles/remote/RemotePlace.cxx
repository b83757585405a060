// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/remote/RemotePlace.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/base/Url.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

namespace vol
{

namespace
{

/// Returns the first of some variables of the environment that is set; empty: none is.
std::string GetVariable(std::initializer_list<const char*> names)
{
  for (const char* name : names)
  {
    const char* const value = std::getenv(name);
    if (value && *value)
    {
      return value;
    }
  }
  return {};
}

/// Writes what an address cannot have as it is as %XX. `kept`: beside letters, digits and "-._~".
std::string EscapeForUrl(const std::string& text, const char* kept)
{
  constexpr const char* digits = "0123456789ABCDEF";
  std::string result;
  for (const char letter : text)
  {
    const auto byte = static_cast<unsigned char>(letter);
    const bool isPlain = (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') ||
      (byte >= '0' && byte <= '9') || (byte != 0 && std::strchr("-._~", byte)) ||
      (byte != 0 && std::strchr(kept, byte));
    if (isPlain)
    {
      result += letter;
    }
    else
    {
      result += '%';
      result += digits[byte >> 4];
      result += digits[byte & 15];
    }
  }
  return result;
}

} // namespace

RemotePlace::RemotePlace(const std::string& url)
  : Root(url)
{
  const std::size_t behind = url.find("://") + 3;
  const std::string scheme = ToLower(url.substr(0, behind - 3));
  const std::string rest = url.substr(behind);
  const auto refuse = [&](const std::string& why)
  { throw FileError(HideCredentials(url), "cannot be opened: " + why); };
  if (scheme != "http" && scheme != "https" && scheme != "s3")
  {
    refuse("only http, https and s3 are spoken.");
  }
  if (rest.find('@') != std::string::npos)
  {
    refuse("an address with a user or a password would be kept in states. Write them to ~/.netrc "
           "(machine HOST login USER password PASSWORD), and open the address without them.");
  }
  if (rest.find_first_of("?#") != std::string::npos)
  {
    refuse("it has a '?' or '#'. A Zarr store has many keys, and an address with a query names "
           "one. Open the store's folder.");
  }
  const bool hasControls = std::any_of(rest.begin(), rest.end(),
    [&](unsigned char letter)
    { return letter < ' ' || letter == 0x7f || (letter == ' ' && scheme != "s3"); });
  const std::string host = rest.substr(0, rest.find('/'));
  if (host.empty() || hasControls)
  {
    refuse("it has no host, or blanks. Write a blank as %20.");
  }
  if (scheme == "s3")
  {
    this->FindBucket(rest);
    return;
  }
  this->Split = url.size();
  this->Address =
    scheme + "://" + host + EscapeForUrl(rest.substr(host.size()), "/:%@!$&'()*+,;=[]");
}

void RemotePlace::FindBucket(const std::string& rest)
{
  const std::string bucket = rest.substr(0, rest.find('/'));
  std::string region = GetVariable({ "AWS_REGION", "AWS_DEFAULT_REGION" });
  region = region.empty() ? "us-east-1" : region;
  std::string endpoint = GetVariable({ "AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT_URL" });
  while (!endpoint.empty() && endpoint.back() == '/')
  {
    endpoint.pop_back();
  }
  if (!endpoint.empty() &&
    (ToLower(endpoint).compare(0, 4, "http") != 0 || !IsUrl(endpoint) ||
      endpoint.find_first_of("@?#") != std::string::npos))
  {
    throw FileError(this->Root,
      "cannot be opened: AWS_ENDPOINT_URL has to be an http or https address without a password.");
  }
  const std::string escaped = EscapeForUrl(bucket, "");
  // A certificate does not hold for a bucket with points.
  const bool isHost = bucket.find('.') == std::string::npos;
  this->Address = !endpoint.empty() ? endpoint + "/" + escaped
    : isHost                        ? "https://" + escaped + ".s3." + region + ".amazonaws.com"
                                    : "https://s3." + region + ".amazonaws.com/" + escaped;
  this->Split = this->Root.find("://") + 3 + bucket.size();
  this->Signing = { region, GetVariable({ "AWS_ACCESS_KEY_ID" }),
    GetVariable({ "AWS_SECRET_ACCESS_KEY" }), GetVariable({ "AWS_SESSION_TOKEN" }) };
  if (this->Signing.Key.empty() || this->Signing.Secret.empty())
  {
    this->Signing = {};
  }
}

std::string RemotePlace::GetAddress(const std::string& path) const
{
  if (path.compare(0, this->Split, this->Root, 0, this->Split) == 0)
  {
    return this->Address + EscapeForUrl(path.substr(this->Split), "/");
  }
  // Beside the store.
  return EscapeForUrl(path, "/:%@!$&'()*+,;=[]");
}

} // namespace vol
