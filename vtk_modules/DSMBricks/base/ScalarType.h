// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ScalarType_h
#define bricks_ScalarType_h

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <type_traits>

namespace bricks
{

/// The types a voxel may have; data is never converted.
enum class ScalarType : std::uint8_t
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float32,
  Float64
};

/// Calls `function(T{})` with the C++ type that `type` stands for.
template <class Function>
decltype(auto) Dispatch(ScalarType type, Function&& function)
{
  switch (type)
  {
    case ScalarType::Int8:
      return function(std::int8_t{});
    case ScalarType::UInt8:
      return function(std::uint8_t{});
    case ScalarType::Int16:
      return function(std::int16_t{});
    case ScalarType::UInt16:
      return function(std::uint16_t{});
    case ScalarType::Int32:
      return function(std::int32_t{});
    case ScalarType::UInt32:
      return function(std::uint32_t{});
    case ScalarType::Int64:
      return function(std::int64_t{});
    case ScalarType::UInt64:
      return function(std::uint64_t{});
    case ScalarType::Float32:
      return function(float{});
    case ScalarType::Float64:
      return function(double{});
  }
  throw std::logic_error("unknown scalar type");
}

inline std::size_t GetBytes(ScalarType type)
{
  return Dispatch(type, [](auto sample) { return sizeof(sample); });
}

} // namespace bricks

#endif
