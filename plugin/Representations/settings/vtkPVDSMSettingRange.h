// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMSettingRange_h
#define vtkPVDSMSettingRange_h

#include "vtkObject.h"

#include <algorithm>
#include <map>
#include <string>

/// Numbers that users give settings.
class vtkPVDSMSettingRange
{
public:
  /// Returns the valid number nearest to `value`, with a warning of `options` where that is another one. Warns once,
  /// however many displays pass the same number on, until the options that warned get a valid number: new displays have
  /// numbers of their own for a moment. Thread of ParaView's proxies.
  template <class Number>
  static Number Keep(
    vtkObject* options, const std::string& setting, Number value, Number least, Number most)
  {
    struct Warning
    {
      Number Value;
      const vtkObject* Options;
    };
    static std::map<std::string, Warning> warned;
    const auto before = warned.find(setting);
    const Number kept = std::clamp(value, least, most);
    if (kept == value)
    {
      if (before != warned.end() && before->second.Options == options)
      {
        warned.erase(before);
      }
      return kept;
    }
    if (before == warned.end() || before->second.Value != value)
    {
      warned[setting] = { value, options };
      vtkWarningWithObjectMacro(options, << setting << ": " << value << " is out of range; using "
                                         << kept
                                         << (value < least ? " (minimum)." : " (maximum)."));
    }
    return kept;
  }
};

#endif
