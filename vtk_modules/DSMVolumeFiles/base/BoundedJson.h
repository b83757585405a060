// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_BoundedJson_h
#define vol_BoundedJson_h

#include <nlohmann/json.hpp>

#include <string>

namespace vol
{

/// Parses a file's text. A member of the outermost object that is called `skipped` is left out. Throws dsm::Error,
/// which begins with "it", when the text is not valid JSON, or is deeper or has more values than FileLimits allows.
nlohmann::json ParseJson(const std::string& text, const char* skipped = "");

} // namespace vol

#endif
