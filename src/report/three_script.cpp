#include "report/three_script.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

/// The code of a module and its exports.
struct Code {
  std::string_view code;
  std::string exports;  ///< as the properties of an object
};

/// Returns the text between `open` and the next `close`; sets `after` to the end of `close`.
std::string_view between(std::string_view text, std::string_view open, std::string_view close, std::size_t& after) {
  const std::size_t from = text.find(open);
  const std::size_t to = from == std::string_view::npos ? from : text.find(close, from);
  INCISE_REQUIRE(to != std::string_view::npos, fmt::format("expected a module of three.js with {} … {}", open, close));
  after = to + close.size();
  return text.substr(from + open.size(), to - from - open.size());
}

/// "a as b,c" as properties: of an import "a:b,c", of an export "b:a,c".
std::string properties(std::string_view clause, bool is_export) {
  constexpr std::string_view kAs = " as ";
  std::string text;
  while (!clause.empty()) {
    const std::size_t comma = std::min(clause.find(','), clause.size());
    const std::string_view name = clause.substr(0, comma);
    const std::size_t as = name.find(kAs);
    if (as == std::string_view::npos) {
      text += name;
    } else {
      const std::string_view own = name.substr(0, as), other = name.substr(as + kAs.size());
      text += fmt::format("{}:{}", is_export ? other : own, is_export ? own : other);
    }
    text += ',';
    clause.remove_prefix(std::min(comma + 1, clause.size()));
  }
  return text;
}

/// A module that ends with its only list of exports.
Code code_of(std::string_view module) {
  const std::size_t last = module.rfind("export{");
  INCISE_REQUIRE(last != std::string_view::npos, "expected a module of three.js that ends with its exports");
  std::size_t after = 0;
  return {module.substr(0, last), properties(between(module.substr(last), "export{", "}", after), true)};
}

}  // namespace

std::string three_script(std::string_view core, std::string_view module) {
  constexpr std::string_view kFromCore = "}from\"./three.core.js\";";
  std::size_t after = 0;
  const std::string imports = properties(between(module, "import{", kFromCore, after), false);
  module.remove_prefix(after);
  static_cast<void>(between(module, "export{", kFromCore, after));  // the whole core is exported below
  module.remove_prefix(after);
  const Code inner = code_of(core);
  const Code outer = code_of(module);
  return fmt::format(
      "\"use strict\";\nconst THREE=(()=>{{\nconst core=(()=>{{\n{}\nreturn{{{}}};\n}})();\nconst{{{}}}=core;\n{}\n"
      "return{{...core,{}}};\n}})();\n",
      inner.code, inner.exports, imports, outer.code, outer.exports);
}

}  // namespace incise
