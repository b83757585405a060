// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_CodecJson_h
#define vol_CodecJson_h

#include "DSMVolumeFiles/codec/Codec.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>

/// Members of what Zarr's metadata say of a codec. Errors are dsm::Error, name the member, and continue "its codec
/// 'x' ".
namespace vol::CodecJson
{

/// Returns a member of an object; null if it is missing, or `object` is not an object.
const nlohmann::json& Find(const nlohmann::json& configuration, const char* name);

/// Returns the type that NumPy ("<f4") or Zarr 3 ("float32") calls so; nothing for those that bricks::ScalarType does
/// not have.
std::optional<ElementType> FindType(const std::string& text);

/// Returns `usual` where there is none, or null. Throws where it is not an integer in [least, most].
std::int64_t GetInteger(const nlohmann::json& configuration, const char* name, std::int64_t usual,
  std::int64_t least, std::int64_t most);

/// Throws if the member is missing, or is not a finite number.
double GetNumber(const nlohmann::json& configuration, const char* name);

/// Returns `usual` where there is none, or null. Throws for types that bricks::ScalarType does not have.
ElementType GetType(
  const nlohmann::json& configuration, const char* name, const ElementType& usual);

} // namespace vol::CodecJson

#endif
