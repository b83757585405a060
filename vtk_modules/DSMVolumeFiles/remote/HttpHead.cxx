// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/remote/HttpHead.h"

#include "DSMVolumeFiles/base/SmallFile.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

namespace vol
{

namespace
{

/// Values of headers that are longer are as if they were not there.
constexpr std::size_t MostHeaderBytes = 1024;

std::string_view TrimHeader(std::string_view text)
{
  constexpr const char* blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos
    ? std::string_view()
    : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Takes a number from the front of a text.
std::optional<std::uint64_t> TakeHeaderNumber(std::string_view& text)
{
  std::uint64_t number = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  if (parsed.ec != std::errc())
  {
    return std::nullopt;
  }
  text.remove_prefix(static_cast<std::size_t>(parsed.ptr - text.data()));
  return number;
}

/// Such as "bytes 0-99/1000".
std::optional<HttpHead::Part> ParseContentRange(std::string_view text)
{
  constexpr std::string_view unit = "bytes ";
  if (text.substr(0, unit.size()) != unit)
  {
    return std::nullopt;
  }
  text.remove_prefix(unit.size());
  const auto take = [&](char behind) -> std::optional<std::uint64_t>
  {
    const auto number = TakeHeaderNumber(text);
    const bool isRight = behind == '\0' ? text.empty() : !text.empty() && text.front() == behind;
    text.remove_prefix(isRight && behind != '\0' ? 1 : 0);
    return isRight ? number : std::nullopt;
  };
  const auto first = take('-');
  const auto last = first ? take('/') : std::nullopt;
  const auto total = last ? take('\0') : std::nullopt;
  return total && *first <= *last && *last < *total
    ? std::optional<HttpHead::Part>({ *first, *last, *total })
    : std::nullopt;
}

} // namespace

std::string HttpRange::Write() const
{
  return this->FromEnd
    ? "-" + std::to_string(this->Bytes)
    : std::to_string(this->Offset) + "-" + std::to_string(this->Offset + this->Bytes - 1);
}

void HttpHead::Add(const char* line, std::size_t bytes)
{
  std::string_view text(line, bytes);
  if (text.substr(0, 5) == "HTTP/")
  {
    *this = HttpHead();
    const std::size_t blank = text.find(' ');
    text = TrimHeader(text.substr(std::min(blank, text.size())));
    this->Status =
      static_cast<int>(std::min<std::uint64_t>(TakeHeaderNumber(text).value_or(0), 999));
    return;
  }
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos)
  {
    return;
  }
  const std::string name = ToLower(std::string(TrimHeader(text.substr(0, colon))));
  std::string_view value = TrimHeader(text.substr(colon + 1));
  if (value.size() > MostHeaderBytes)
  {
    return;
  }
  const std::string whole(value);
  if (name == "etag")
  {
    this->Validator.Tag = whole;
  }
  else if (name == "last-modified")
  {
    this->Validator.Modified = whole;
  }
  else if (name == "content-length")
  {
    const auto number = TakeHeaderNumber(value);
    this->Length = value.empty() ? number : std::nullopt;
  }
  else if (name == "content-range")
  {
    this->Content = ParseContentRange(value);
  }
  else if (name == "content-encoding")
  {
    this->Encoding = ToLower(whole) == "identity" ? std::string() : whole;
  }
  else if (name == "retry-after") // a date stays 0
  {
    const auto number = TakeHeaderNumber(value);
    this->RetryAfter = value.empty() && number ? static_cast<double>(*number) : 0.0;
  }
  else if (name == "x-amz-bucket-region")
  {
    this->Region = whole;
  }
}

std::string HttpHead::Check(const std::optional<HttpRange>& wanted, std::uint64_t bytes) const
{
  if (!this->Encoding.empty())
  {
    return "the server sends it in the encoding " + Quote(this->Encoding) +
      ", which was not asked for";
  }
  if (this->Length && *this->Length != bytes)
  {
    return "the answer has " + std::to_string(bytes) + " bytes instead of the " +
      std::to_string(*this->Length) + " that it declares";
  }
  if (!wanted)
  {
    return this->Status == 200 ? "" : "the server sends a part, but all was asked for";
  }
  if (this->Status != 206)
  {
    return "the server sends all of it where a part was asked for. Shards and large chunks without "
           "compression need a server that knows byte ranges";
  }
  if (!this->Content)
  {
    return "the server sends a part, but does not say which one";
  }
  const std::uint64_t total = this->Content->Total;
  const std::uint64_t count = std::min(wanted->Bytes, total);
  const std::uint64_t first = wanted->FromEnd ? total - count : wanted->Offset;
  // At the end of a key there may be fewer: who asks for them knows how many it has.
  const std::uint64_t end = first < total ? first + std::min(wanted->Bytes, total - first) : first;
  if (this->Content->First != first || this->Content->Last + 1 != end)
  {
    return "the server sends bytes " + std::to_string(this->Content->First) + " to " +
      std::to_string(this->Content->Last) + " of " + std::to_string(total) +
      ", but others were asked for";
  }
  return bytes == end - first ? ""
                              : "the answer has " + std::to_string(bytes) +
      " bytes instead of the " + std::to_string(end - first) + " that were asked for";
}

} // namespace vol
