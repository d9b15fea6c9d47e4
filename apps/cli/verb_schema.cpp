#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/laboratory/bench_files.hpp>
#include <incise/storage/path_schema.hpp>

#include <cstdio>

namespace incise::cli {
namespace {

std::string text_of(const std::string& what, bool has_defaults) {
  if (what == "bench") return has_defaults ? json_text(specimen_json(Specimen{})) : bench_schema_json();
  if (what == "bench2")
    return has_defaults ? json_text(specimen_json(second_bench::Specimen{})) : second_bench_schema_json();
  if (what == "path") return path_schema_json();
  return has_defaults ? case_defaults_yaml() : case_schema_json();
}

}  // namespace

void add_schema(Application& application) {
  struct Arguments {
    std::string what = "case";
    bool defaults = false;
  };
  auto [verb, a] = application.add_verb<Arguments>(
      "schema", "", "incise schema case --defaults > case.yaml",
      [](const Arguments& arguments, const CommonOptions& options) {
        if (arguments.what == "path" && arguments.defaults) {
          throw CaseError("command line", "--defaults", "path", "case: a path has no defaults");
        }
        const std::string text = text_of(arguments.what, arguments.defaults);
        if (options.output.empty()) {
          std::fwrite(text.data(), 1, text.size(), stdout);
        } else {
          write_atomically(options.output, text);
        }
        return kDone;
      });
  describe_output(*verb, "by default standard output");
  verb->add_option("what", a.what, "Kind of file: bench, bench2, case or path")
      ->check(CLI::IsMember({"bench", "bench2", "case", "path"}))
      ->required();
  verb->add_flag("--defaults", a.defaults, "Print a file with every default instead of the schema");
}

}  // namespace incise::cli
