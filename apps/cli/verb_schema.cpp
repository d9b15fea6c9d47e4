#include "options.hpp"

#include <incise/io/atomic_file.hpp>

#include <cstdio>
#include <memory>
#include <ostream>

namespace incise::cli {

void add_schema(Application& application) {
  struct Arguments {
    std::string what = "case";
    bool defaults = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = application.add_verb(
      "schema", "Print the JSON Schema of an input file, or every default", "incise schema case --defaults > case.yaml",
      [arguments](const CommonOptions& options) {
        const std::string text = arguments->defaults ? case_defaults_yaml() : case_schema_json();
        if (options.output.empty()) {
          std::fwrite(text.data(), 1, text.size(), stdout);
        } else {
          write_atomically(options.output, [&text](std::ostream& out) { out << text; });
        }
        return kDone;
      });
  verb->add_option("what", arguments->what, "Which file")->check(CLI::IsMember({"case"}))->required();
  verb->add_flag("--defaults", arguments->defaults, "A file with every default instead of the schema");
}

}  // namespace incise::cli
