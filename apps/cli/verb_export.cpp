#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/version.hpp>
#include <incise/cutting/cut_settings.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/path_io.hpp>
#include <incise/robot/program_text.hpp>

#include <fmt/format.h>

#include <memory>
#include <ostream>

namespace incise::cli {

void add_export(Application& application) {
  struct Arguments {
    std::filesystem::path path;
    std::filesystem::path intended;
    std::string robot = "ur10e";
    std::string format = "urscript";
    CheckSettings checks;
    ProgramSettings motion{.overlap_mm = CutSettings{}.overlap_mm};
    bool is_open = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = application.add_verb(
      "export", "Turn a path in the robot's frame into a program, after the safety checks",
      "incise export out/program/path.json --format urscript -o cut.script", [arguments](const CommonOptions& options) {
        Console console(options.level());
        const std::filesystem::path output = options.required_output("cut.script");
        const ToolPath path = read_tool_path(arguments->path);
        require_robot_frame(path, arguments->path);
        std::optional<ToolPath> intended;
        if (!arguments->intended.empty()) {
          intended = read_tool_path(arguments->intended);
          require_robot_frame(*intended, arguments->intended);
        }
        CheckSettings settings = arguments->checks;
        settings.must_be_ring = !arguments->is_open;
        const RobotProgram program = make_program(path, arguments->motion);
        const ProgramChecks checks = check_program(program, path, settings, intended ? &*intended : nullptr);
        nlohmann::ordered_json result = nlohmann::ordered_json::parse(to_json(program, &checks));
        result.erase("poses");
        if (!checks.all_passed()) {
          for (const ProgramCheck& check : checks.checks) {
            if (!check.passed) console.message(Severity::Warning, fmt::format("not exported: {}: {}", check.name, check.text));
          }
          print_result(options, result);
          return kNotAcceptable;
        }
        UrScriptSettings script;
        script.provenance = {fmt::format("incise {} ({})", version(), source_commit()),
                             fmt::format("from {}", arguments->path.filename().string())};
        const std::string text = arguments->format == "json" ? to_json(program, &checks) : to_urscript(program, script);
        write_atomically(output, [&text](std::ostream& out) { out << text; });
        result["program"] = output.string();
        print_result(options, result);
        return kDone;
      });
  verb->add_option("path", arguments->path, "path.json, frame robot")->required();
  verb->add_option("--robot", arguments->robot, "The arm")->check(CLI::IsMember({"ur10e"}));
  verb->add_option("--format", arguments->format, "Of the program")->check(CLI::IsMember({"urscript", "json"}));
  verb->add_option("--intended", arguments->intended, "The path before correction, to check the deviation");
  verb->add_option("--depth-mm", arguments->checks.planned_depth_mm, "Planned depth")->check(CLI::PositiveNumber);
  verb->add_option("--close-margin-mm", arguments->checks.close_margin_mm, "Least distance from the tumour edge")->check(CLI::PositiveNumber);
  verb->add_option("--overlap-mm", arguments->motion.overlap_mm, "How far a ring runs on beyond its start")->check(CLI::NonNegativeNumber);
  verb->add_flag("--open", arguments->is_open, "The path is an open cut");
}

}  // namespace incise::cli
