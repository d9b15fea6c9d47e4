#include "described_options.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/steps/tissue_steps.hpp>

#include <optional>
#include <string_view>

namespace incise::cli {

void add_segment(Application& application) {
  struct Arguments {
    std::filesystem::path ct;
    std::vector<double> window{-20.0, 180.0};
    std::vector<double> roi;
    std::vector<double> seed;
    std::vector<double> spacing;
    std::vector<double> hu;
    double opening_mm = 0.0;
    std::optional<double> smoothing_mm;
  };
  auto [verb, a] = application.add_verb<Arguments>(
      "segment", "", "incise segment specimen/ct --window-hu -20 180 -o labels.nrrd",
      [](const Arguments& arguments, const CommonOptions& options) {
        steps::SegmentRequest request{.ct = arguments.ct, .output = options.required_output("labels.nrrd")};
        refuse_input_as_output("-o", request.output, {request.ct});
        if (!arguments.spacing.empty()) request.reading.spacing_mm = Vec3(arguments.spacing.data());
        if (!arguments.hu.empty()) request.reading.hu = GrayToHu{arguments.hu[0], arguments.hu[1]};
        SegmentationSettings& settings = request.settings;
        settings.window_low_hu = arguments.window[0];
        settings.window_high_hu = arguments.window[1];
        settings.opening_radius_mm = arguments.opening_mm;
        settings.smoothing_mm = arguments.smoothing_mm;
        if (!arguments.roi.empty()) {
          settings.roi_box_mm = Box3(Vec3(arguments.roi.data()), Vec3(arguments.roi.data() + 3));
          if (settings.roi_box_mm->isEmpty()) {
            throw CaseError("command line", "--roi-box-mm", "a low corner above the high corner",
                            "low x y z, high x y z");
          }
        }
        if (!arguments.seed.empty()) settings.seeds_mm.emplace_back(arguments.seed.data());
        try {
          return run_step(options, [&](const auto& context) { return steps::segment_scan(request, context); });
        } catch (const CaseError& error) {  // the reader of a CT names keys, such as ct.spacing_mm
          constexpr std::string_view kGroup = "ct.";
          Problem problem = error.problem();
          if (!problem.path.starts_with(kGroup)) throw;
          problem.path = option_name(problem.path.substr(kGroup.size()));
          throw CaseError(request.ct.string(), problem);
        }
      });
  verb->add_option("ct", a.ct, "DICOM folder, .nrrd/.nhdr, .nii[.gz], .mhd/.mha, folder of PNG slices")->required();
  verb->add_option("--window-hu", a.window, "Least and greatest HU of tissue")->expected(2);
  verb->add_option("--roi-box-mm", a.roi, "Low x y z and high x y z of the box to look in, LPS")->expected(6);
  verb->add_option("--seed-mm", a.seed, "A point inside the specimen, LPS")->expected(3);
  verb->add_option("--opening-mm", a.opening_mm, "Cut bridges thinner than twice this length");
  verb->add_option("--smoothing-mm", a.smoothing_mm,
                   "Length over which the tissue's surface is smoothed; by default 0.6, or 1.2 voxels if that is less")
      ->check(CLI::Range(0.0, 5.0));
  verb->add_option("--spacing-mm", a.spacing, "PNG slices: column, row and slice spacing")->expected(3);
  verb->add_option("--hu", a.hu, "PNG slices: slope and intercept")->expected(2);
}

}  // namespace incise::cli
