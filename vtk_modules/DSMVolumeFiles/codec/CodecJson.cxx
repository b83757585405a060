// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/CodecJson.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

namespace vol
{

namespace
{

using Json = nlohmann::json;

struct TypeName
{
  std::string_view Code; ///< NumPy's, behind the byte order
  std::string_view Name;
  bricks::ScalarType Type;
};

constexpr TypeName TypeNames[] = { { "i1", "int8", bricks::ScalarType::Int8 },
  { "u1", "uint8", bricks::ScalarType::UInt8 }, { "i2", "int16", bricks::ScalarType::Int16 },
  { "u2", "uint16", bricks::ScalarType::UInt16 }, { "i4", "int32", bricks::ScalarType::Int32 },
  { "u4", "uint32", bricks::ScalarType::UInt32 }, { "i8", "int64", bricks::ScalarType::Int64 },
  { "u8", "uint64", bricks::ScalarType::UInt64 }, { "f4", "float32", bricks::ScalarType::Float32 },
  { "f8", "float64", bricks::ScalarType::Float64 } };

} // namespace

const Json& CodecJson::Find(const Json& configuration, const char* name)
{
  static const Json none;
  const auto found = configuration.is_object() ? configuration.find(name) : configuration.end();
  return found == configuration.end() ? none : *found;
}

std::optional<ElementType> CodecJson::FindType(const std::string& text)
{
  const bool hasOrder =
    !text.empty() && std::string_view("<>|=").find(text[0]) != std::string::npos;
  for (const TypeName& one : TypeNames)
  {
    if (text == one.Name || text.substr(hasOrder ? 1 : 0) == one.Code)
    {
      return ElementType{ one.Type, text[0] == '>' && bricks::GetBytes(one.Type) > 1 };
    }
  }
  return std::nullopt;
}

std::int64_t CodecJson::GetInteger(const Json& configuration, const char* name, std::int64_t usual,
  std::int64_t least, std::int64_t most)
{
  const Json& found = Find(configuration, name);
  const auto number = found.is_null() ? usual
    : found.is_number()               ? ToInteger(found.get<double>(), least, most)
                                      : std::nullopt;
  if (!number)
  {
    throw dsm::Error("has an invalid '" + std::string(name) + "'; " + std::to_string(least) +
      " to " + std::to_string(most) + " are valid.");
  }
  return *number;
}

double CodecJson::GetNumber(const Json& configuration, const char* name)
{
  const Json& found = Find(configuration, name);
  if (!found.is_number() || !std::isfinite(found.get<double>()))
  {
    throw dsm::Error("has no '" + std::string(name) + "' that is a number.");
  }
  return found.get<double>();
}

ElementType CodecJson::GetType(
  const Json& configuration, const char* name, const ElementType& usual)
{
  const Json& found = Find(configuration, name);
  if (found.is_null())
  {
    return usual;
  }
  const std::string text = found.is_string() ? found.get<std::string>() : std::string();
  if (const auto known = FindType(text))
  {
    return *known;
  }
  throw dsm::Error("has " + (found.is_string() ? Quote(text) : std::string("no text")) +
    " as its '" + name + "', which is not a supported scalar type.");
}

} // namespace vol
