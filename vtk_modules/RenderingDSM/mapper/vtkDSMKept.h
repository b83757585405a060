// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMKept_h
#define vtkDSMKept_h

#include <optional>
#include <utility>

/// A value that is expensive to make, kept as long as nothing of its key changes. One thread.
template <class Key, class Value>
class vtkDSMKept
{
public:
  /// `make()` makes the value, unless it is there for the key.
  template <class Make>
  const Value& Get(const Key& key, const Make& make)
  {
    if (!this->Made || !(this->Made->first == key))
    {
      this->Made.emplace(key, make());
    }
    return this->Made->second;
  }

private:
  std::optional<std::pair<Key, Value>> Made;
};

#endif
