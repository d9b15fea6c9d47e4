#include "arguments.hpp"
#include "calls.hpp"
#include "command_line.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/median.hpp>
#include <incise/geometry/neighbours.hpp>
#include <incise/imaging/photo_doubts.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/laboratory/bench_steps.hpp>
#include <incise/robot/arm_hulls.hpp>
#include <incise/robot/player.hpp>
#include <incise/robot/program_audit.hpp>
#include <incise/steps/camera_steps.hpp>
#include <incise/steps/cut_steps.hpp>
#include <incise/steps/registration_trust.hpp>
#include <incise/steps/robot_steps.hpp>
#include <incise/steps/tissue_steps.hpp>
#include <incise/storage/case_edit.hpp>
#include <incise/storage/case_run.hpp>
#include <incise/storage/registration_json.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <set>

namespace incise::studio {
namespace fs = std::filesystem;
namespace {

using Json = Calls::Json;

constexpr std::size_t kMostPixels = 20000;  // greatest number of points of a contour that is drawn by hand
constexpr double kFrameS = 0.04;            // between two pictures of the arm
constexpr const char* kNoMark = "none";     // for a frame without a mark on the tissue
constexpr double kFrameVoxelMm = 1.0;       // one point of a frame's tissue in each cube of this size
constexpr double kFarMm = 5.0;              // a point of a surface this far from every point of a cloud was not seen

void append(std::vector<std::string>& words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
}

Json pixels_json(const std::vector<Vec2>& pixels) {
  Json json = Json::array();
  for (const Vec2& p : pixels) json.push_back({p.x(), p.y()});
  return json;
}

/// Returns every file of a folder of results, named relative to the case's folder.
Json files_in(const fs::path& folder, const fs::path& of_case) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_proximate(of_case).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Returns the folder for the results of a file, `PREFIX_STEM` in the case's folder: the same as before for the same
/// file, and a new one for another file of that name.
fs::path folder_of_finding(const CaseFile& file, const std::string& prefix, const fs::path& source) {
  for (int k = 1;; ++k) {
    fs::path folder = file.folder / (k == 1 ? prefix + source.stem().string()
                                            : fmt::format("{}{}_{}", prefix, source.stem().string(), k));
    if (!fs::exists(fs::symlink_status(folder))) return folder;
    try {
      const std::vector<ManifestInput> inputs = read_manifest(folder).inputs;
      if (!inputs.empty() && inputs.front().path == source.string()) return folder;
    } catch (const DataError&) {  // not incise's own
    }
  }
}

// --- The photograph. ---

steps::ScaleRequest scale_in(const Json& arguments) {
  const Json given = argument<Json>(arguments, "scale", "the length of a pixel");
  if (!given.is_object()) throw CaseError("request", "scale", given.dump().substr(0, 80), "an object");
  static const std::set<std::string> known{"mm_per_pixel", "ruler",     "ruler_mm",
                                           "two_points",   "rectangle", "rectangle_mm"};
  for (const auto& [key, value] : given.items()) {
    if (!known.contains(key))
      throw CaseError("request", "scale", "'" + key.substr(0, 40) + "'", fmt::format("{}", fmt::join(known, ", ")));
  }
  const auto lengths = [&](const char* name, std::size_t count) {
    if (!given.contains(name)) return std::vector<double>{};
    const std::string expected = fmt::format("{} numbers", count);
    auto numbers = argument<std::vector<double>>(given, name, expected.c_str());
    if (numbers.size() == count) return numbers;
    throw CaseError("request", name, fmt::format("{} numbers", numbers.size()), expected);
  };
  steps::ScaleRequest scale;
  if (given.contains("mm_per_pixel")) scale.mm_per_pixel = positive_argument(given, "mm_per_pixel");
  if (given.contains("ruler")) scale.ruler = word_argument<RulerKind>(given, "ruler");
  if (given.contains("ruler_mm")) scale.ruler_mm = positive_argument(given, "ruler_mm");
  scale.two_points = lengths("two_points", 5);
  scale.rectangle = lengths("rectangle", 8);
  scale.rectangle_mm = lengths("rectangle_mm", 2);
  if (scale.ways() != 1)
    throw CaseError("request", "scale", fmt::format("{} scales", scale.ways()),
                    "one of mm_per_pixel, ruler, two_points, rectangle");
  return scale;
}

std::vector<std::string> scale_words(const steps::ScaleRequest& scale) {
  std::vector<std::string> words;
  const auto add = [&](const char* option, const std::vector<double>& numbers) {
    if (numbers.empty()) return;
    words.emplace_back(option);
    for (const double number : numbers) words.push_back(fmt::format("{}", number));
  };
  if (scale.mm_per_pixel > 0.0) add("--mm-per-pixel", {scale.mm_per_pixel});
  if (scale.ruler) append(words, {"--ruler", std::string(to_string(*scale.ruler))});
  if (scale.ruler_mm) add("--ruler-mm", {*scale.ruler_mm});
  add("--two-points", scale.two_points);
  add("--rectangle", scale.rectangle);
  add("--rectangle-mm", scale.rectangle_mm);
  return words;
}

/// Contours that a person drew over a photograph, in its pixels; empty: not drawn.
struct DrawnContours {
  std::vector<Vec2> incision_px, tumor_edge_px;
  bool incision_is_closed = true;
  [[nodiscard]] bool has_both() const { return !incision_px.empty() && !tumor_edge_px.empty(); }
  [[nodiscard]] bool has_any() const { return !incision_px.empty() || !tumor_edge_px.empty(); }
};

DrawnContours drawn_in(const Json& arguments) {
  DrawnContours drawn;
  const auto take = [&](const char* name, std::vector<Vec2>& pixels) {
    if (!arguments.contains(name)) return;
    pixels = pixels_argument(arguments, name);
    if (pixels.size() < 3 || pixels.size() > kMostPixels)
      throw CaseError("request", name, fmt::format("{} points", pixels.size()),
                      fmt::format("3 to {} points", kMostPixels));
  };
  take("incision_px", drawn.incision_px);
  take("tumor_edge_px", drawn.tumor_edge_px);
  drawn.incision_is_closed = argument_or(arguments, "incision_closed", "true or false", true);
  return drawn;
}

Contour in_plane(const std::vector<Vec2>& pixels, bool is_closed, const PhotoScale& scale) {
  Contour contour;
  contour.is_closed = is_closed;
  for (const Vec2& pixel : pixels) {
    const Vec2 at = scale.plane_mm(pixel);
    contour.points.emplace_back(at.x(), at.y(), 0.0);
  }
  return contour;
}

steps::EvaluateRequest evaluation_of(const CaseFile& file, const Json& arguments) {
  const Case& settings = file.settings;
  steps::EvaluateRequest request;
  request.photo = text_argument(arguments, "file");
  request.scale = scale_in(arguments);
  request.contour = ContourKind::InnerEdge;
  request.settings.target_mm = settings.plan.lateral_margin_mm - radius_mm(settings.tool);
  request.settings.close_margin_mm = settings.close_margin_mm;
  request.max_gap_mm = argument_or(arguments, "max_gap_mm", "a length", request.max_gap_mm);
  if (!(request.max_gap_mm >= 0.0 && request.max_gap_mm <= 10.0))
    throw CaseError("request", "max_gap_mm", fmt::format("{}", request.max_gap_mm), "0 to 10 mm");
  if (arguments.contains("red")) request.red = word_argument<RedLine>(arguments, "red");
  return request;
}

std::vector<std::string> words_of_settings(const steps::EvaluateRequest& request) {
  return {"--target-mm", fmt::format("{}", *request.settings.target_mm), "--close-margin-mm",
          fmt::format("{}", request.settings.close_margin_mm)};
}

void require_in_picture(const std::vector<Vec2>& pixels, const char* name, const ColorPicture& picture) {
  const Vec2 last(picture.width - 0.5, picture.height - 0.5);
  for (const Vec2& p : pixels) {
    if ((p.array() >= -0.5).all() && (p.array() <= last.array()).all()) continue;
    throw CaseError("request", name, fmt::format("a point at pixel ({:.4g}, {:.4g})", p.x(), p.y()),
                    fmt::format("points in the photograph of {} x {}", picture.width, picture.height));
  }
}

/// Measures contours of which a person drew at least one; both are written beside the measures.
/// @param found  contours in the photograph, in place of the one that was not drawn.
steps::EvaluatedCut evaluate_drawn(const steps::EvaluateRequest& request, const DrawnContours& drawn,
                                   const steps::FoundPixels& found, const fs::path& to,
                                   const steps::StepContext& context) {
  const ColorPicture picture = decode_picture(read_text(request.photo), request.photo);
  require_in_picture(drawn.incision_px, "incision_px", picture);
  require_in_picture(drawn.tumor_edge_px, "tumor_edge_px", picture);
  const steps::FoundScale scale = steps::find_scale(request.scale, picture, request.photo);
  const bool has_incision = !drawn.incision_px.empty(), has_edge = !drawn.tumor_edge_px.empty();
  steps::FoundPixels pixels{scale.marks_px, has_incision ? drawn.incision_px : found.incision_px,
                            has_incision ? drawn.incision_is_closed : found.incision_is_closed,
                            has_edge ? drawn.tumor_edge_px : found.tumor_edge_px};
  write_contour_csv(to / "incision.csv", in_plane(pixels.incision_px, pixels.incision_is_closed, scale.scale));
  write_contour_csv(to / "tumor_edge.csv", in_plane(pixels.tumor_edge_px, true, scale.scale));
  steps::EvaluateRequest of_contours;
  of_contours.incision = to / "incision.csv";
  of_contours.tumor = to / "tumor_edge.csv";
  of_contours.is_open = !pixels.incision_is_closed;
  of_contours.contour = request.contour;
  of_contours.settings = request.settings;
  steps::StepResult step = steps::evaluate_cut(of_contours, context);
  step.json["photo"] = request.photo.string();
  step.json["mm_per_pixel"] = scale.scale.mm_per_pixel(pixels.tumor_edge_px.front());
  step.json["scale"] = scale.summary;
  Verdict of_scale;
  if (scale.ruler) add_ruler_doubts(*scale.ruler, of_scale);
  step.json["verdict"] = to_json(of_scale);
  return {std::move(step), std::move(pixels)};
}

// --- The cloud. ---

ScaleRange scale_range_in(const Json& arguments) {
  if (!arguments.contains("scale")) return ScaleRange::fixed();
  const Json& given = arguments.at("scale");
  if (given == "fixed") return ScaleRange::fixed();
  if (given == "free") return ScaleRange::free();
  if (given.is_array() && given.size() == 2 && given[0].is_number() && given[1].is_number()) {
    const ScaleRange range{given[0].get<double>(), given[1].get<double>()};
    if (range.low > 0.0 && range.low <= range.high && range.high < 1e6) return range;
  }
  throw CaseError("request", "scale", given.dump().substr(0, 80), "fixed, free, or [low, high] with 0 < low <= high");
}

std::string scale_word(const ScaleRange& range, const Json& arguments) {
  const Json given = arguments.value("scale", Json("fixed"));
  return given.is_string() ? given.get<std::string>() : fmt::format("{},{}", range.low, range.high);
}

Points moved_by(const Mat4& T, const Points& points) {
  Points moved;
  moved.reserve(points.size());
  for (const Vec3& p : points) moved.emplace_back((T * p.homogeneous()).head<3>());
  return moved;
}

/// Returns the distance of each point from the cloud, mm, along its normal (if it has one): the median over the nearest
/// points of the cloud, so that their noise does not hide the difference of the surfaces. Not a number where no point
/// of the cloud is near.
std::vector<float> residuals_of(const PointCloud& surface, const Points& cloud) {
  constexpr std::size_t kNear = 9;
  const NeighbourSearch search(cloud);
  std::vector<float> residuals;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    std::vector<double> along;
    for (const Neighbour& near : search.nearest(surface.points[i], kNear)) {
      const Vec3 way = surface.points[i] - cloud[near.index];
      if (near.squared_mm2 <= kFarMm * kFarMm)
        along.push_back(surface.normals.empty() ? way.norm() : way.dot(surface.normals[i]));
    }
    residuals.push_back(along.empty() ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(median(along)));
  }
  return residuals;
}

/// Returns the line that `frame` or `incise track` found with a cloud; nothing for another cloud.
std::optional<Contour> marked_beside(const fs::path& cloud) {
  const fs::path of_frame = cloud.parent_path() / "track" / "contour.csv",
                 of_track = cloud.parent_path() / "contour.csv";
  if (cloud.filename() == "tissue.ply" && fs::exists(of_frame)) return read_contour(of_frame);
  if (cloud.filename() == "cloud.ply" && fs::exists(of_track)) return read_contour(of_track);
  return std::nullopt;
}

/// Returns the case's edge on a cloud, and the distances of the marked edge's points from it.
Json edges_json(const Points& simulated, const std::optional<Contour>& marked) {
  Json json{
      {"simulated_mm", points_json(simulated)}, {"marked_mm", nullptr}, {"mean_mm", nullptr}, {"greatest_mm", nullptr}};
  if (!marked || simulated.empty()) return json;
  const Contour edge{simulated, true};
  double sum = 0.0, greatest = 0.0;
  for (const Vec3& place : marked->points) {
    const double distance = nearest_on(edge, place).distance_mm;
    sum += distance;
    greatest = std::max(greatest, distance);
  }
  json["marked_mm"] = points_json(marked->points);
  json["mean_mm"] = sum / static_cast<double>(marked->points.size());
  json["greatest_mm"] = greatest;
  return json;
}

/// Returns the colour of a frame's mark; nothing: it has none.
std::optional<InkColor> mark_in(const Json& arguments) {
  const auto word = argument<std::string>(arguments, "mark", "red, green or none");
  if (word == kNoMark) return std::nullopt;
  if (const auto colour = value_of<InkColor>(word)) return *colour;
  throw CaseError("request", "mark", "'" + word.substr(0, 40) + "'", "red, green or none");
}

fs::path surface_folder(const CaseFile& file) {
  return file.folder / "simulated_surface";
}

fs::path registration_folder(const CaseFile& file) {
  return file.folder / "registration";
}

std::vector<std::string> words_of(const steps::ProjectRequest& laying) {
  std::vector<std::string> words{"project",   laying.path.string(),   "--transform", laying.transform.string(),
                                 "--surface", laying.surface.string()};
  if (!laying.camera.empty()) append(words, {"--camera", laying.camera.string()});
  if (laying.settings.kind == PathKind::Mark) append(words, {"--kind", "mark"});
  append(words, {"-o", laying.output.string()});
  return words;
}

std::vector<std::string> words_of(const steps::ExportRequest& making, const fs::path& case_file) {
  std::vector<std::string> words{"export",    making.path.string(),    "--case",         case_file.string(),
                                 "--surface", making.surface.string(), "--registration", making.registration.string()};
  if (!making.intended.empty()) append(words, {"--intended", making.intended.string()});
  for (const std::string& id : making.accepted) append(words, {"--accept", id});
  append(words, {"-o", making.output.string()});
  return words;
}

/// Says why a gate lets no program through.
std::string why_closed(const Json& gate) {
  const auto listed = [&](const char* key) {
    std::string names;
    for (const Json& id : gate.at(key)) names += (names.empty() ? "" : ", ") + id.get<std::string>();
    return names;
  };
  if (const std::string refused = listed("refused"); !refused.empty()) return "refused: " + refused;
  return "cautions that nobody has accepted: " + listed("missing");
}

/// Writes the surface of the stretched specimen as the camera would see it: `surface.ply` in its own folder.
void write_simulated_surface(const CaseFile& file, const steps::StepContext& step) {
  AtomicFolder target(surface_folder(file));
  steps::SurfaceRequest seen;
  seen.input = file.file;
  seen.output = target.path() / "surface.ply";
  static_cast<void>(steps::see_surface(seen, step));
  write_manifest(target.path(), steps::manifest_of(step.run, "{}", {file.file}, step.wall_s()));
  target.commit();
}

void remove_registration(const CaseFile& file) {
  remove_laid(file);
  remove_replaceable(registration_folder(file));
}

/// Returns why the arm would not run a program to its end as it was checked; empty: it would.
std::string fault_of(const fs::path& script) {
  const WrittenProgram program = program_from_text(read_text(script), script);
  Replay replay = play(program);
  judge_audit(replay, audit_program(program));
  if (replay.outcome == ReplayOutcome::Completed) return {};
  return fmt::format("replay: {}{}{}", to_string(replay.outcome), replay.reason.empty() ? "" : ": ", replay.reason);
}

/// Positions of the arm along a program, every kFrameS, with the last cycle among them.
struct ArmFrames {
  std::vector<float> time_s, ends;
  Points tips;
  std::vector<std::uint8_t> phases;
};

ArmFrames frames_of(const Replay& replay, const ArmModel& arm, const Instrument& instrument, double table_z_mm) {
  ArmFrames frames;
  double next_s = 0.0;
  for (std::size_t i = 0; i < replay.samples.size(); ++i) {
    const ReplaySample& sample = replay.samples[i];
    if (sample.time_s < next_s && i + 1 < replay.samples.size()) continue;
    next_s = sample.time_s + kFrameS;
    frames.time_s.push_back(static_cast<float>(sample.time_s));
    frames.tips.push_back(sample.tip_mm);
    frames.phases.push_back(static_cast<std::uint8_t>(sample.phase));
    for (const Capsule& hull : hulls_at(arm, sample.q_rad, instrument, table_z_mm)) {
      for (const Vec3& end : {hull.from_mm, hull.to_mm}) {
        for (int a = 0; a < 3; ++a) frames.ends.push_back(static_cast<float>(end[a]));
      }
    }
  }
  return frames;
}

Json picture_json(BlobFolder& blobs, const std::string& slot, const fs::path& file) {
  const ColorPicture picture = decode_picture(read_text(file), file);
  return {{"width", picture.width},
          {"height", picture.height},
          {"rgb", blobs.put(slot, std::span<const std::uint8_t>(picture.rgb))}};
}

}  // namespace

Json Calls::picture(const Json& arguments) {
  return picture_json(blobs_, "picture.rgb", text_argument(arguments, "file"));
}

Json Calls::photograph(const Json& arguments) {
  const CaseFile file = read_case(file_);
  steps::EvaluateRequest request = evaluation_of(file, arguments);
  const DrawnContours drawn = drawn_in(arguments);
  const fs::path folder = folder_of_finding(file, "photograph_", request.photo);
  const steps::StepContext step{context(), workers_, monitor_};
  AtomicFolder target(folder);
  steps::EvaluatedCut cut;
  if (!drawn.has_both()) {
    request.figure = target.path() / "found.png";
    cut = steps::evaluate_in_pixels(request, step);
    cut.step.json["figure"] = (folder / "found.png").string();
  }
  if (drawn.has_any()) {
    steps::EvaluatedCut by_person = evaluate_drawn(request, drawn, cut.pixels, target.path(), step);
    for (const char* key : {"warnings", "verdict"}) {  // of the line that was found
      if (cut.step.json.contains(key)) by_person.step.json[key] = cut.step.json.at(key);
    }
    cut = std::move(by_person);
  }
  Json by_hand = Json::array();
  if (!drawn.incision_px.empty()) by_hand.push_back("incision");
  if (!drawn.tumor_edge_px.empty()) by_hand.push_back("tumor_edge");
  Json& evaluation = cut.step.json;
  evaluation["by_hand"] = by_hand;
  write_json(target.path() / "evaluation.json", evaluation);
  write_manifest(target.path(),
                 steps::manifest_of(step.run, Json{{"by_hand", by_hand}}.dump(), {request.photo}, step.wall_s()));
  target.commit();
  std::vector<std::string> words{"evaluate"};
  if (drawn.has_any()) {
    append(words, {"--incision", (folder / "incision.csv").string(), "--tumor", (folder / "tumor_edge.csv").string(),
                   "--contour", "inner_edge"});
    if (!cut.pixels.incision_is_closed) words.emplace_back("--open");
  } else {
    append(words, {request.photo.string()});
    append(words, scale_words(request.scale));
    append(words,
           {"--red", std::string(to_string(request.red)), "--max-gap-mm", fmt::format("{}", request.max_gap_mm)});
  }
  append(words, words_of_settings(request));
  return {{"mm_per_pixel", evaluation.at("mm_per_pixel")},
          {"scale", evaluation.at("scale")},
          {"marks_px", pixels_json(cut.pixels.marks_px)},
          {"incision_px", pixels_json(cut.pixels.incision_px)},
          {"incision_closed", cut.pixels.incision_is_closed},
          {"tumor_edge_px", pixels_json(cut.pixels.tumor_edge_px)},
          {"by_hand", by_hand},
          {"evaluation", evaluation},
          {"files", files_in(folder, file.folder)},
          {"command", command_line(words)}};
}

Json Calls::frame(const Json& arguments) {
  const CaseFile file = read_case(file_);
  const steps::StepContext step{context(), workers_, monitor_};
  steps::TrackRequest request;
  request.color = text_argument(arguments, "color");
  const auto given = [&](const char* name) {
    return arguments.contains(name) && !arguments.at(name).is_null() ? text_argument(arguments, name) : "";
  };
  request.depth = given("depth");
  request.intrinsics = given("intrinsics");
  const bool is_cloud = request.color.extension() == ".ply";
  if (request.depth.empty() != is_cloud)
    throw CaseError("request", "depth", is_cloud ? "a depth picture beside a cloud" : "nothing",
                    is_cloud ? "none: a cloud has its own depth" : "the depth picture of the frame");
  if (request.intrinsics.empty() != is_cloud)
    throw CaseError("request", "intrinsics", is_cloud ? "intrinsics beside a cloud" : "nothing",
                    is_cloud ? "none" : "the cameras' intrinsics (JSON)");
  if (arguments.contains("mark")) request.mark = mark_in(arguments);
  request.is_open = argument_or(arguments, "is_open", "true or false", false);
  const fs::path folder = folder_of_finding(file, "frame_", request.color);
  steps::SurfaceRequest cleaned;
  cleaned.approach = Vec3::UnitZ();  // a camera looks along its own z
  if (arguments.contains("planes"))
    cleaned.cleaning.planes = count_argument(arguments, "planes");
  else
    cleaned.cleaning.planes = 1;  // the table
  cleaned.cleaning.voxel_mm = kFrameVoxelMm;
  const std::vector<Problem> problems = validate(cleaned.cleaning);
  if (!problems.empty()) throw CaseError("request", problems.front());
  const auto lie_in = [&](const fs::path& place) {
    request.output = place / "track";
    cleaned.input = request.output / "cloud.ply";
    cleaned.output = place / "tissue.ply";
  };
  AtomicFolder target(folder);
  lie_in(target.path());
  Json summary = steps::track_mark(request, step).json;
  const Json tissue = steps::see_surface(cleaned, step).json;
  write_manifest(target.path(),
                 steps::manifest_of(step.run, "{}", {request.color, request.depth, request.intrinsics}, step.wall_s()));
  target.commit();
  lie_in(folder);
  for (const char* name : {"contour", "cloud", "figure"}) {
    if (summary.contains(name))
      summary[name] = (request.output / fs::path(summary.at(name).get<std::string>()).filename()).string();
  }
  Json found = nullptr, marked = nullptr;
  if (request.mark) {
    found = picture_json(blobs_, "frame.rgb", request.output / "found.png");
    marked = points_json(read_contour(request.output / "contour.csv", summary.at("closed_loop").get<bool>()).points);
  }
  std::vector<std::string> words{"track", request.color.string()};
  if (!request.depth.empty()) append(words, {request.depth.string(), "--intrinsics", request.intrinsics.string()});
  append(words, {"--mark", request.mark ? std::string(to_string(*request.mark)) : kNoMark});
  if (request.is_open) words.emplace_back("--open");
  append(words, {"-o", request.output.string()});
  const std::vector<std::string> cleaning{"surface",    cleaned.input.string(),
                                          "--approach", "0",
                                          "0",          "1",
                                          "--planes",   fmt::format("{}", cleaned.cleaning.planes),
                                          "--voxel-mm", fmt::format("{}", kFrameVoxelMm),
                                          "-o",         cleaned.output.string()};
  return {{"cloud", cleaned.output.string()},
          {"name", (folder.filename() / cleaned.output.filename()).string()},
          {"found", std::move(found)},
          {"mark_mm", std::move(marked)},
          {"summary", summary},
          {"points", tissue.at("points")},
          {"files", files_in(folder, file.folder)},
          {"commands", {command_line(words), command_line(cleaning)}}};
}

Json Calls::virtual_cloud(const Json& arguments) {
  const CaseFile file = read_case(file_);
  const fs::path cloud = file.folder / "virtual_cloud.ply";
  const fs::file_status there = fs::symlink_status(cloud);
  if (fs::exists(there) && (!fs::is_regular_file(there) || !is_marked_virtual(read_cloud(cloud))))
    throw DataError(cloud, "", "a link, or a cloud that is not marked virtual", "none, or an earlier virtual cloud");
  const std::uint64_t seed = seed_argument(arguments, "seed");
  Json done = laboratory::make_virtual_cloud({file_, cloud}, {context(seed), workers_, monitor_}).json;
  done["name"] = cloud.filename().string();
  return done;
}

Json Calls::register_cloud(const Json& arguments) {
  const CaseFile file = read_case(file_);
  const fs::path target = text_argument(arguments, "file");
  const steps::StepContext step{context(), workers_, monitor_};
  steps::RegisterRequest request;
  request.source = surface_folder(file) / "surface.ply";
  request.target = target;
  request.approach = file.settings.plan.approach;
  request.output = registration_folder(file);
  request.settings.scale = scale_range_in(arguments);
  request.settings.settling_mm = argument_or(arguments, "settling_mm", "a length", 0.0);
  const std::vector<Problem> problems = validate(request.settings);
  if (!problems.empty()) throw CaseError("request", problems.front());
  const std::optional<Contour> marked = marked_beside(target);
  remove_registration(file);  // and the paths that were laid by it
  const bool has_edge = !file.inputs.tumor_contour.empty();
  const Study study = study_until(has_edge ? Stage::Plan : Stage::Stretch);
  write_simulated_surface(file, step);
  const Json found = steps::lay_clouds(request, step).json;
  const TriMesh cloud = read_cloud(target);
  const fs::path written = request.output / "registration.json";
  Json json{{"registration", found},
            {"verdict", to_json(steps::verdict_of(read_registration(written), written))},
            {"is_virtual", is_marked_virtual(cloud)}};
  json["target"] = {{"points", blobs_.put("register.target", std::span<const Vec3>(cloud.vertices))}};
  json["skin"] = nullptr;
  json["sample"] = nullptr;
  json["edges"] = {{"simulated_mm", nullptr}, {"marked_mm", nullptr}, {"mean_mm", nullptr}, {"greatest_mm", nullptr}};
  if (found.contains("T_target_source") && !found.at("T_target_source").is_null()) {
    const Mat4 T = transform_in(found, "T_target_source", written);
    const Skin skin = skin_of(study.model->mesh);
    json["skin"] = surface_json(blobs_, "register.skin",
                                moved_by(T, positions_on(skin, study.stretched->state.positions)), skin.triangles);
    const PointCloud laid = cloud_of(read_cloud(request.output / "moved_source.ply"));
    const std::vector<float> residuals = residuals_of(laid, cloud.vertices);
    json["sample"] = {{"points", blobs_.put("register.points", std::span<const Vec3>(laid.points))},
                      {"residuals_mm", blobs_.put("register.residuals", std::span<const float>(residuals))}};
    if (study.plan && has_edge) json["edges"] = edges_json(moved_by(T, study.plan->tumor_edge.points), marked);
  }
  json["files"] = files_in(request.output, file.folder);
  std::vector<std::string> words{"register",
                                 "--source",
                                 request.source.string(),
                                 "--target",
                                 target.string(),
                                 "--scale",
                                 scale_word(request.settings.scale, arguments)};
  append(words, {"--settling-mm", fmt::format("{}", request.settings.settling_mm), "-o", request.output.string()});
  json["command"] = command_line(words);
  return json;
}

Json Calls::lay(const Json& arguments) {
  const CaseFile file = read_case_with_inputs(file_);
  const std::string revision = case_revision(file_);
  const bool is_mark = arguments.contains("kind") && word_argument<PathKind>(arguments, "kind") == PathKind::Mark;
  const PathKind kind = is_mark ? PathKind::Mark : PathKind::Incise;
  const fs::path registration = registration_folder(file) / "registration.json";
  if (!fs::exists(registration))
    throw CaseError("request", "registration", "none in the case's folder", "a registered cloud");
  const std::string registration_sha256 = sha256_of_file(registration);
  steps::ExportRequest making;
  steps::take_case(file, making);
  making.registration = registration;
  making.accepted = accepted_in(arguments);
  if (!making.accepted.empty() && text_argument(arguments, "registration_sha256") != registration_sha256)
    throw CaseError("request", "registration_sha256", "the digest of another registration",
                    "the digest of the registration whose cautions are accepted");
  if (text_argument(read_json(registration), "source") != (surface_folder(file) / "surface.ply").string())
    throw CaseError(registration.string(), "source", "another surface",
                    "the surface of this case, registered in the studio");
  const steps::StepContext step{context(), workers_, monitor_};
  const fs::path output = output_beside(file_);
  write_simulated_surface(file, step);             // a surface other than the registered one is refused
  const Study study = study_until(Stage::Verify);  // the last stage: it leaves the paths with their verdicts
  if (!study.as_planned) throw CaseError(file_.string(), "plan", "nothing was cut", "a path that was cut");
  const fs::path planned = output / "plan" / "path.json";
  if (!study.is_accepted && !file.inputs.tool_path.empty())
    throw CaseError(file_.string(), "path", "a given path whose correction is not accepted",
                    "a path that was planned or corrected here", "Use incise project for a given path");
  steps::ProjectRequest laying;
  laying.path = study.is_accepted ? output / "correction" / "path.json" : planned;
  laying.settings.kind = kind;
  laying.transform = registration;
  laying.surface = text_argument(read_json(registration), "target");
  if (arguments.contains("camera") && !arguments.at("camera").is_null())
    laying.camera = text_argument(arguments, "camera");
  const fs::path folder = laid_folder(file, kind);
  AtomicFolder target(folder);
  // Where the files are: first where they are made, then at their destination.
  const auto lie_in = [&](const fs::path& place) {
    laying.output = place / "path";
    making.path = laying.output / "path.json";
    making.surface = laying.output / "surface.ply";
    making.output = place / "program.script";
    if (study.is_accepted && !is_mark) making.intended = place / "intended.json";
  };
  const auto intended_of = [&] {
    steps::ProjectRequest intended = laying;
    intended.path = planned;
    intended.output = making.intended;
    return intended;
  };
  lie_in(target.path());
  static_cast<void>(steps::project_onto_tissue(laying, step));
  if (!making.intended.empty()) static_cast<void>(steps::project_onto_tissue(intended_of(), step));
  const Json made = steps::export_program(making, step).json;
  Json json{{"path", tool_path_json(read_tool_path(making.path))},
            {"follows", is_mark             ? "edge"
                        : study.is_accepted ? "corrected"
                                            : "planned"}};
  for (const char* key : {"verdict", "gate", "checks"}) json[key] = made.at(key);
  std::string why = made.contains("program") ? fault_of(making.output) : why_closed(made.at("gate"));
  if (!why.empty()) fs::remove(making.output);
  json["program"] = why.empty() ? Json(read_text(making.output)) : Json(nullptr);
  json["why_without_program"] = std::move(why);
  json["registration_sha256"] = registration_sha256;
  Json read_from = Json::object();
  for (const fs::path& input :
       {file.inputs.tumor_contour, file.inputs.tumor_surface, file.inputs.elasticity_map, file.inputs.line_contour,
        file.inputs.tool_path, registration, laying.surface, laying.camera}) {
    if (!input.empty()) read_from[input.string()] = sha256_of_file(input);
  }
  write_json(target.path() / "laid.json", {{"case_sha256", revision}, {"inputs", read_from}});
  write_manifest(
      target.path(),
      steps::manifest_of(step.run, "{}", {laying.path, registration, laying.surface, laying.camera}, step.wall_s()));
  if (case_revision(file_) != revision) throw StaleRevision(file_);  // the run's results may be of another case
  target.commit();
  lie_in(folder);
  json["files"] = files_in(folder, file.folder);
  std::vector<std::string> commands{command_line(words_of(laying))};
  if (!making.intended.empty()) commands.push_back(command_line(words_of(intended_of())));
  commands.push_back(command_line(words_of(making, file_)));
  json["commands"] = commands;
  return json;
}

Json Calls::unregister(const Json&) {
  remove_registration(read_case(file_));
  return Json::object();
}

Json Calls::arm(const Json& arguments) {
  const CaseFile file = read_case(file_);
  remove_stale_laid(file);
  const auto of = argument_or<std::string>(arguments, "of", "run, tissue or mark", "run");
  if (of != "run" && of != "tissue" && of != "mark")
    throw CaseError("request", "of", "'" + of.substr(0, 40) + "'", "run, tissue or mark");
  const bool is_laid = of != "run";
  const fs::path laid = laid_folder(file, of == "mark" ? PathKind::Mark : PathKind::Incise);
  const fs::path script = (is_laid ? laid : output_beside(file_) / "program") / "program.script";
  if (!fs::exists(script))
    throw CaseError(file_.string(), "program", "none",
                    is_laid ? "a path on a cloud, with its program" : "a run that wrote a program");
  const WrittenProgram program = program_from_text(read_text(script), script);
  const std::optional<Mat4> T_robot_sim =
      is_laid ? read_tool_path(laid / "path" / "path.json").T_robot_sim : file.settings.T_robot_sim;
  if (!T_robot_sim) throw CaseError(file_.string(), "robot.T_robot_sim", "none", "where the specimen lies");
  Replay replay = play(program);
  judge_audit(replay, audit_program(program));
  const ArmSetup setup = program.record ? program.record->setup : ArmSetup{};
  const CheckSettings limits = program.record ? program.record->limits : CheckSettings{};
  const Instrument instrument = instrument_of(program.T_flange_tool, limits);
  const ArmFrames frames = frames_of(replay, setup.arm, instrument, setup.table_z_mm);
  Json hulls = Json::array();
  const Hulls of_arm = hulls_at(setup.arm, setup.near_rad, instrument, setup.table_z_mm);
  for (std::size_t h = 0; h < kHullCount; ++h)
    hulls.push_back({{"name", kHullNames[h]}, {"radius_mm", of_arm[h].radius_mm}});
  Json json{{"T_robot_sim", to_json(*T_robot_sim)}, {"hulls", std::move(hulls)}};
  json["time_s"] = blobs_.put("arm.time", std::span<const float>(frames.time_s));
  json["ends"] = blobs_.put("arm.ends", std::span<const float>(frames.ends));
  json["tip"] = blobs_.put("arm.tip", std::span<const Vec3>(frames.tips));
  json["phase"] = blobs_.put("arm.phase", std::span<const std::uint8_t>(frames.phases));
  json["phases"] = names_of(ProgramPhase{});
  json["outcome"] = to_string(replay.outcome);
  json["reason"] = replay.reason;
  json["duration_s"] = replay.duration_s();
  json["max_deviation_mm"] = replay.max_deviation_mm;
  json["table_z_mm"] = setup.table_z_mm;
  return json;
}

Json Calls::report(const Json&) {
  const fs::path page = output_beside(file_) / "report.html";
  if (!fs::exists(page)) throw CaseError(file_.string(), "report", "none", "a run");
  const std::string html = read_text(page);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(html.data()), html.size());
  return {{"name", page.filename().string()}, {"html", blobs_.put("report.html", bytes)}};
}

}  // namespace incise::studio
