// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HeaderText_h
#define vol_HeaderText_h

#include "DSMVolumeFiles/base/FileLimits.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vol
{

/// Reads the lines of a header from the beginning of a file, and no more of it than FileLimits::HeaderBytes.
class HeaderLines
{
public:
  /// Throws dsm::Error, as ReadBeginning does.
  explicit HeaderLines(const std::string& path);

  /// The next line, without its end. False at the end of the file. Throws dsm::Error when the header is too long.
  bool Next(std::string& line);
  /// Returns whether the file ends with the last line, so that no values can follow it.
  bool HasEnded() const { return this->Ended; }
  /// Returns the offset in the file at which the next line, or the values, begin.
  std::int64_t GetPlace() const { return static_cast<std::int64_t>(this->Place); }

private:
  std::string Path;
  std::string Text;   ///< the beginning of the file
  bool IsAll = false; ///< all of it
  bool Ended = false;
  std::size_t Place = 0;
};

/// A header of lines of text, as NRRD and MetaImage have: names and values.
class HeaderText
{
public:
  using OtherNames = std::vector<std::pair<std::string, std::string>>;
  /// `what`: the path of the file. `names`: each with another one that some programs write.
  explicit HeaderText(std::string what, OtherNames names = {})
    : What(std::move(what))
    , Names(std::move(names))
  {
  }

  /// A line "name SEPARATOR value"; spaces around either do not count, nor do capitals in the name. A line
  /// without the separator does nothing.
  void AddLine(const std::string& line, const std::string& separator);

  const std::string& GetPath() const { return this->What; }
  bool Has(const std::string& name) const { return this->Values.count(name) != 0; }
  /// Empty where there is none.
  std::string Get(const std::string& name) const;
  /// Throw dsm::Error for what is not a number, in any locale, and, when `count` is not 0, for another count; empty
  /// where there is no such name.
  std::vector<double> GetNumbers(const std::string& name, std::size_t count = 0) const;
  /// Likewise; also throws for a number that is not an integer, or is less than `least`.
  std::vector<std::int64_t> GetIntegers(
    const std::string& name, std::size_t count = 0, std::int64_t least = -MostInteger) const;
  /// A single one; `usual` where there is no such name.
  std::int64_t GetInteger(
    const std::string& name, std::int64_t usual, std::int64_t least = -MostInteger) const;
  /// Converts a part of the field `name` to numbers.
  std::vector<double> ToNumbers(const std::string& name, const std::string& text) const;

  [[noreturn]] void Refuse(const std::string& why) const;

  static std::string Trim(const std::string& text);
  static std::vector<std::string> Split(const std::string& text);

private:
  /// Beyond it, double does not have every integer.
  static constexpr std::int64_t MostInteger = std::int64_t(1) << 53;

  std::string What;
  OtherNames Names;
  std::map<std::string, std::string> Values;
};

} // namespace vol

#endif
