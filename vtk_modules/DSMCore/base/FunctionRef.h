// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FunctionRef_h
#define dsm_FunctionRef_h

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

namespace dsm
{

template <class Signature>
class FunctionRef;

/// Refers to something that can be called, for a parameter: unlike std::function it needs no memory, so that
/// calling a function that other ranks count on cannot fail. The referenced function must outlive it.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)>
{
public:
  /// Refers to nothing.
  FunctionRef() = default;

  /// To nothing when `function` is an empty std::function.
  template <class Function,
    class = std::enable_if_t<!std::is_same_v<std::decay_t<Function>, FunctionRef>>>
  FunctionRef(Function&& function)
    : Object(const_cast<void*>(static_cast<const void*>(std::addressof(function))))
    , Call(
        [](void* object, Arguments... arguments) -> Result
        {
          return (*static_cast<std::remove_reference_t<Function>*>(object))(
            std::forward<Arguments>(arguments)...);
        })
  {
    if constexpr (std::is_same_v<std::decay_t<Function>, std::function<Result(Arguments...)>>)
    {
      this->Call = function ? this->Call : nullptr;
    }
  }

  explicit operator bool() const { return this->Call != nullptr; }

  Result operator()(Arguments... arguments) const
  {
    return this->Call(this->Object, std::forward<Arguments>(arguments)...);
  }

private:
  void* Object = nullptr;
  Result (*Call)(void*, Arguments...) = nullptr;
};

} // namespace dsm

#endif
