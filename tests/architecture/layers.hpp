#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace incise::architecture {

/// One row of cmake/layers.txt.
struct Module {
  int layer = 0;
  std::set<std::string> uses;         ///< as the row says
  std::set<std::string> may_include;  ///< itself, those, and whatever those may include
};
using Layers = std::map<std::string, Module>;

/// Reads the table. @throws std::runtime_error naming the line, for a row that names a module before its own row.
[[nodiscard]] Layers read_layers(std::istream& table);

/// An `#include` line that a source may not have.
struct Offence {
  std::string file;
  std::size_t line = 0;
  std::string text;  ///< the line itself
  std::string why;
};
[[nodiscard]] std::string to_string(const Offence& offence);

/// Checks the includes of one source text.
/// @param module    that the text belongs to.
/// @param is_public  a header under include/: it may use <incise/…> only, no private header.
[[nodiscard]] std::vector<Offence> forbidden_includes(const Layers& layers, const std::string& module,
                                                      const std::string& file, std::istream& text,
                                                      bool is_public = false);

/// Modules that a src/<module>/CMakeLists.txt names after USES.
[[nodiscard]] std::set<std::string> linked_modules(const std::string& list_file_text);

}  // namespace incise::architecture
