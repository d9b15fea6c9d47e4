#include "evaluation_figure.hpp"
#include "figure_file.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_text.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>

#include <memory>

namespace incise::cli {
namespace {

/// The settings are known to be valid here, so what `evaluate` refuses is the contours' fault.
Evaluation measured(const Contour& incision, const Contour& tumor_edge, const EvaluationSettings& settings,
                    const std::filesystem::path& file) {
  try {
    return evaluate(incision, tumor_edge, settings);
  } catch (const InvalidArgument& error) {
    throw DataError(file, "", without_function_name(error), "contours that can be measured");
  }
}

}  // namespace

void add_evaluate(Application& application) {
  struct Arguments {
    std::filesystem::path incision;
    std::filesystem::path tumor;
    std::string contour = "centerline";
    double target_mm = 0.0;
    EvaluationSettings settings;
    bool is_open = false;
    std::vector<double> approach;
    std::vector<double> twelve;
    std::filesystem::path figure;
    std::string colors = "safe";
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = application.add_verb(
      "evaluate", "Measure an incision contour against the tumour edge", "incise evaluate --incision aic.csv --tumor tec.csv --contour centerline",
      [arguments](const CommonOptions& options) {
        EvaluationSettings settings = arguments->settings;
        settings.contour = arguments->contour == "centerline" ? ContourKind::Centerline : ContourKind::InnerEdge;
        if (arguments->target_mm > 0.0) settings.target_mm = arguments->target_mm;
        if (!arguments->approach.empty()) settings.approach = Vec3(arguments->approach.data());
        if (!arguments->twelve.empty()) settings.twelve_o_clock = Vec3(arguments->twelve.data());
        if (!arguments->figure.empty()) require_figure_file(arguments->figure, "--figure");
        if (const auto violations = validate(settings); !violations.empty()) {
          throw CaseError("command line", "", violations.front(), "usable settings");
        }
        const Contour incision = read_contour(arguments->incision, !arguments->is_open);
        const Contour tumor_edge = read_contour(arguments->tumor, true);
        const Evaluation evaluation = measured(incision, tumor_edge, settings, arguments->tumor);
        nlohmann::ordered_json result = to_json(evaluation);
        result["points"] = points_json(evaluation);
        if (!arguments->figure.empty()) {
          const ErrorColors colors = arguments->colors == "jet" ? ErrorColors::Jet : ErrorColors::Safe;
          const std::string name = arguments->incision.stem().string();
          write_figure(arguments->figure, evaluation_figure_svg(evaluation, tumor_edge, settings, name, colors));
          result["figure"] = arguments->figure.string();
        }
        if (!options.output.empty()) write_json(options.output, result);
        print_result(options, result);
        return status_of(evaluation.outcome);
      });
  verb->add_option("--incision", arguments->incision, "The incision: .csv (x_mm,y_mm,z_mm), .vtp or .mrk.json")->required();
  verb->add_option("--tumor", arguments->tumor, "The tumour edge, same formats and frame")->required();
  verb->add_option("--contour", arguments->contour, "What was measured")->check(CLI::IsMember({"centerline", "inner_edge"}));
  verb->add_option("--target-mm", arguments->target_mm, "Distance aimed at; default: 5.0 for a mid-line, 4.5 for an inner edge")
      ->check(CLI::PositiveNumber);
  verb->add_option("--close-margin-mm", arguments->settings.close_margin_mm, "Clinical cut-off");
  verb->add_option("--approach", arguments->approach, "Direction in which the camera looks")->expected(3);
  verb->add_option("--twelve-o-clock", arguments->twelve, "Direction of 12 o'clock in by_clock; default: up in the picture")->expected(3);
  verb->add_option("--figure", arguments->figure, "Write the contours with the signed error in colour (.svg, .png)");
  verb->add_option("--colors", arguments->colors, "Of the figure: told apart with any colour vision, or as in the paper")
      ->check(CLI::IsMember({"safe", "jet"}));
  verb->add_flag("--open", arguments->is_open, "The incision is an open curve");
}

}  // namespace incise::cli
