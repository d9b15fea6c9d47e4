#pragma once

#include <string>

namespace incise {

/// JSON Schema (draft 2020-12) of `path.json`: type, range, unit and meaning of every field, as read_tool_path has them.
[[nodiscard]] std::string path_schema_json();

}  // namespace incise
