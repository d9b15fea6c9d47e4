#include "layers.hpp"

#include <fmt/format.h>

#include <istream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace incise::architecture {

Layers read_layers(std::istream& table) {
  Layers layers;
  std::string line;
  for (std::size_t number = 1; std::getline(table, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream row(line);
    Module module;
    std::string name;
    if (!(row >> module.layer >> name))
      throw std::runtime_error(fmt::format("layers.txt line {}: expected a layer and a module", number));
    module.may_include.insert(name);
    for (std::string used; row >> used;) {
      const auto found = layers.find(used);
      if (found == layers.end())
        throw std::runtime_error(fmt::format("layers.txt line {}: {} has no row above", number, used));
      if (found->second.layer >= module.layer) {
        throw std::runtime_error(fmt::format("layers.txt line {}: {} lies in layer {} and may not use {} of layer {}",
                                             number, name, module.layer, used, found->second.layer));
      }
      module.uses.insert(used);
      module.may_include.insert(found->second.may_include.begin(), found->second.may_include.end());
    }
    layers[name] = std::move(module);
  }
  return layers;
}

std::string to_string(const Offence& offence) {
  return fmt::format("{}:{}: {}  <- {}", offence.file, offence.line, offence.text, offence.why);
}

std::vector<Offence> forbidden_includes(const Layers& layers, const std::string& module, const std::string& file,
                                        std::istream& text, bool is_public) {
  // <incise/module/file.hpp>, "incise/module/file.hpp" or the private "module/file.hpp"; "file.hpp" is of the own
  // folder.
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])(incise/)?(?:([a-z_]+)/)?([^>"]+)[>"])");
  const Module& own = layers.at(module);
  std::vector<Offence> offences;
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, kInclude)) continue;
    const bool is_quoted = match[1] == "\"";
    const bool is_ours = match[2].matched || is_quoted;
    const std::string from = match[3].matched ? match[3].str() : "";
    if (!is_ours) continue;
    if (is_public && !match[2].matched) {
      offences.push_back({file, number, line, "a public header may not include a private one"});
    } else if (from.empty()) {
      if (match[2].matched) offences.push_back({file, number, line, "names no module"});
    } else if (layers.count(from) == 0) {
      if (match[2].matched)
        offences.push_back({file, number, line, fmt::format("cmake/layers.txt has no module {}", from)});
    } else if (own.may_include.count(from) == 0) {
      offences.push_back({file, number, line, fmt::format("{} may not include {}", module, from)});
    } else if (is_quoted && !match[2].matched && from != module) {
      offences.push_back({file, number, line, fmt::format("a private header of {}", from)});
    }
  }
  return offences;
}

std::set<std::string> linked_modules(const std::string& list_file_text) {
  std::set<std::string> modules;
  // A closing bracket ends the list: it stays, as a word of its own.
  const std::string plain = std::regex_replace(list_file_text, std::regex("#[^\n]*|[(]"), " ");
  std::istringstream words(std::regex_replace(plain, std::regex("[)]"), " ) "));
  bool is_in_uses = false;
  for (std::string word; words >> word;) {
    if (word == "USES") {
      is_in_uses = true;
    } else if (word == "PUBLIC" || word == "PRIVATE" || word == "SOURCES" ||
               !std::regex_match(word, std::regex("[a-z_]+"))) {
      is_in_uses = false;
    } else if (is_in_uses) {
      modules.insert(word);
    }
  }
  return modules;
}

}  // namespace incise::architecture
