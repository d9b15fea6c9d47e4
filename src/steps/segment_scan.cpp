#include <incise/io/manifest.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/steps/tissue_steps.hpp>
#include <incise/storage/own_files.hpp>
#include <incise/storage/result_json.hpp>

namespace incise::steps {
namespace {

nlohmann::json numbers_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::json settings_json(const SegmentRequest& request, double smoothing_mm) {
  const SegmentationSettings& s = request.settings;
  nlohmann::json json{{"window_hu", {s.window_low_hu, s.window_high_hu}},
                      {"opening_mm", s.opening_radius_mm},
                      {"smoothing_mm", smoothing_mm}};
  for (const char* key : {"roi_box_mm", "seed_mm", "spacing_mm", "hu"}) json[key] = nlohmann::json::array();
  if (s.roi_box_mm) {
    json["roi_box_mm"] = numbers_of(s.roi_box_mm->min());
    for (const double x : s.roi_box_mm->max()) json["roi_box_mm"].push_back(x);
  }
  if (!s.seeds_mm.empty()) json["seed_mm"] = numbers_of(s.seeds_mm.front());
  if (request.reading.spacing_mm) json["spacing_mm"] = numbers_of(*request.reading.spacing_mm);
  if (request.reading.hu) json["hu"] = {request.reading.hu->slope, request.reading.hu->intercept};
  return json;
}

}  // namespace

StepResult segment_scan(const SegmentRequest& request, const StepContext& context) {
  require_volume_name(request.output);
  require_own_manifest_beside(request.output);
  const Segmentation found = segment(read_ct(request.ct, request.reading, context.monitor).volume, request.settings,
                                     context.workers, context.monitor);
  report_reasons(found.verdict, context.monitor);
  Manifest manifest =
      manifest_of(context.run, settings_json(request, found.smoothing_mm).dump(), {request.ct}, context.wall_s());
  if (manifest.specimen_id.empty()) manifest.specimen_id = specimen_id_of_scan(manifest.inputs.front().sha256);
  write_labels(request.output, found.labels);
  write_manifest_beside(request.output, manifest);
  StepResult result{to_json(found)};
  result.json["labels"] = request.output.string();
  return result;
}

}  // namespace incise::steps
