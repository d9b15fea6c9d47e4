#pragma once

#include <string>

namespace incise {

/// Returns the JSON Schema (draft 2020-12) of `path.json`: type, range, unit and meaning of every field that
/// read_tool_path reads, but not of `verdict`.
[[nodiscard]] std::string path_schema_json();

}  // namespace incise
