// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HeaderText_h
#define vol_HeaderText_h

#include <map>
#include <string>
#include <vector>

namespace vol
{

/// A header of lines of text, as NRRD and MetaImage have: names and values.
class HeaderText
{
public:
  /// `what` names the file in errors. `names`: of several words, which some programs write as one.
  explicit HeaderText(std::string what, std::vector<std::string> names = {})
    : What(std::move(what))
    , Names(std::move(names))
  {
  }

  /// A line "name SEPARATOR value"; spaces around either do not count, nor do capitals in the name. A line
  /// without the separator does nothing.
  void AddLine(const std::string& line, const std::string& separator);

  bool Has(const std::string& name) const { return this->Values.count(name) != 0; }
  /// Empty where there is none.
  std::string Get(const std::string& name) const;
  /// Throw dsm::Error for what is no number, and, when `count` is not 0, for another count; empty where there
  /// is no such name.
  std::vector<double> GetNumbers(const std::string& name, std::size_t count = 0) const;
  /// Of a part of the field `name`.
  std::vector<double> ToNumbers(const std::string& name, const std::string& text) const;

  [[noreturn]] void Refuse(const std::string& why) const;

  static std::string Trim(const std::string& text);
  static std::string ToLower(std::string text);
  static std::vector<std::string> Split(const std::string& text);

private:
  std::string What;
  std::vector<std::string> Names;
  std::map<std::string, std::string> Values;
};

} // namespace vol

#endif
