// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HttpHead_h
#define vol_HttpHead_h

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace vol
{

/// Marks by which a server tells one state of a key from another.
struct HttpValidator
{
  std::string Tag;      ///< ETag
  std::string Modified; ///< Last-Modified

  bool IsEmpty() const { return this->Tag.empty() && this->Modified.empty(); }
  /// The time of a change says nothing where there are tags.
  bool operator==(const HttpValidator& other) const
  {
    return this->Tag == other.Tag && (!this->Tag.empty() || this->Modified == other.Modified);
  }
  bool operator!=(const HttpValidator& other) const { return !(*this == other); }
};

/// Which bytes of a key are asked for.
struct HttpRange
{
  std::uint64_t Offset = 0;
  std::uint64_t Bytes = 0;
  bool FromEnd = false; ///< the last ones; Offset does not count

  /// As the header "Range" has it, behind "bytes=".
  std::string Write() const;
};

/// The lines before an answer's body.
class HttpHead
{
public:
  /// Takes a line, which may be anything. A status line begins anew.
  void Add(const char* line, std::size_t bytes);

  int Status = 0;
  HttpValidator Validator;
  std::optional<std::uint64_t> Length; ///< of the body
  std::string Encoding;                ///< of the body; empty: it is as it is kept
  double RetryAfter = 0.0;             ///< in seconds
  std::string Region;                  ///< of an S3 bucket

  /// The first and the last byte of a part, and how many there are in all.
  struct Part
  {
    std::uint64_t First;
    std::uint64_t Last;
    std::uint64_t Total;
  };
  std::optional<Part> Content;

  /// Returns why an answer (200 or 206) with so many bytes cannot be what was asked for; empty: it can.
  std::string Check(const std::optional<HttpRange>& wanted, std::uint64_t bytes) const;
  /// Returns the bytes of the key, of a right answer.
  std::uint64_t GetTotal(std::uint64_t bytes) const
  {
    return this->Status == 206 && this->Content ? this->Content->Total : bytes;
  }
};

} // namespace vol

#endif
