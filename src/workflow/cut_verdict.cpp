#include "workflow/layer_line.hpp"

#include <incise/core/error.hpp>
#include <incise/workflow/cut_verdict.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

// Vertices held back to max_step_mm, per step and tet. The limit allows for loose bits: sound cuts of 41 000 tets have
// 5e-5 to 3e-4; a block of tets of 4 mm, whose body lags for numerical reasons only, has 0.02 to 0.03.
constexpr double kHeldBackShare = 0.002;
// Of the tets: one or two slivers at the kerf's teeth do not move a line that is measured over many tets.
constexpr double kInvertedShare = 1e-4;

void judge_outcome(const SimulatedCut& cut, Verdict& verdict) {
  if (cut.outcome != Outcome::Success) {
    verdict.add("outcome", {}, fmt::format("the cut {}", in_words(cut.outcome)));
  } else if (!cut.centerline.signed_error_mm) {
    verdict.add("outcome", {}, "the simulated cut left no mid-line to measure");
  }
}

void judge_layers(const SimulatedCut& cut, Verdict& verdict) {
  for (const KerfLayer& layer : cut.incision.kerf.layers) {
    const bool is_cut = cut.incision.is_closed_loop ? layer.is_closed.value_or(false) : layer.centerline.has_value();
    if (!layer.is_within_plan || is_cut) continue;
    const std::string bridge = layer.gap_mm ? fmt::format(", up to {:.1f} mm wide,", *layer.gap_mm) : std::string();
    verdict.add("open_layer", layer.gap_mm,
                fmt::format("the simulated cut is open at a depth of {} mm: uncut tissue{} still holds the piece there",
                            layer.depth_mm, bridge),
                VerdictPlace{{}, layer.gap_place_mm, fmt::format("{} mm below the skin", layer.depth_mm)});
  }
}

std::string share_in_words(double share) {
  return share < 0.01 ? std::string("less than 1 %") : fmt::format("{:.0f} %", 100.0 * share);
}

void judge_depth(const Case& settings, const SimulatedCut& cut, Verdict& verdict) {
  const DepthReached& depth = cut.incision.kerf.depth;
  const std::vector<DepthShare> shares = depth_shares(settings, depth);
  if (shares.empty()) return;
  const double limit = *verdict_rule("depth").limit;
  const DepthShare& least = *std::ranges::min_element(shares, {}, &DepthShare::share);
  if (least.share >= limit) return;
  const auto shallow = std::ranges::count_if(shares, [limit](const DepthShare& one) { return one.share < limit; });
  verdict.add(
      "depth", least.share,
      fmt::format("the simulated kerf is {:.2g} mm deep at its shallowest, {:.0f} % of the planned {:.2g} mm, and too "
                  "shallow on {} of the path",
                  depth.profile.depth_mm[least.at], 100.0 * least.share, least.planned_mm,
                  share_in_words(static_cast<double>(shallow) / static_cast<double>(shares.size()))),
      VerdictPlace{depth.profile.arclength_mm[least.at], depth.profile.course.points[least.at],
                   fmt::format("{:.0f} mm along the path", depth.profile.arclength_mm[least.at])});
}

/// The least tissue beside the tumour's edge in one line of the cut.
struct Tissue {
  double left_mm = std::numeric_limits<double>::infinity();
  std::string of;
  std::optional<VerdictPlace> at;
};

/// @param off_mm  distance from the line to the end of the tissue.
void note_line(const Points& places, const std::vector<double>& distance_mm, const std::vector<double>& beyond_mm,
               double off_mm, const std::string& name, Tissue& least) {
  for (std::size_t i = 0; i < distance_mm.size(); ++i) {
    const double left_mm = distance_mm[i] + beyond_mm[i] - off_mm;
    if (left_mm < least.left_mm) least = {left_mm, name, VerdictPlace{{}, places[i], {}}};
  }
}

void note_evaluation(const Case& settings, const ExpectedErrors& expected, const Evaluation& line, const Contour& edge,
                     double off_mm, const std::string& name, Tissue& least) {
  const Points& places = line.errors.points.points;
  note_line(places, line.errors.signed_distance_mm, expected.at(settings, places, edge), off_mm, name, least);
}

void note_layers(const Case& settings, const SimulatedCut& cut, const ExpectedErrors& expected, Tissue& least) {
  for (std::size_t i = 0; i < cut.layers.size() && i < cut.incision.kerf.layers.size(); ++i) {
    if (!cut.layers[i].signed_error_mm) continue;
    const KerfLayer& layer = cut.incision.kerf.layers[i];
    double error_mm = cut.layers[i].signed_error_mm->min;
    if (expected.is_any()) {
      const ContourErrors line = layer_line_errors(settings, layer, expected.tumor_edge);
      const std::vector<double> beyond = expected.at(settings, line.points.points, expected.tumor_edge);
      error_mm = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < beyond.size(); ++k)
        error_mm = std::min(error_mm, line.signed_error_mm[k] + beyond[k]);
    }
    const double left_mm = settings.plan.lateral_margin_mm + error_mm - 0.5 * layer.width_mm;
    if (left_mm >= least.left_mm) continue;
    const std::string place = fmt::format("{} mm below the skin", layer.depth_mm);
    least = {left_mm, "kerf " + place, VerdictPlace{{}, {}, place}};
  }
}

Tissue least_tissue(const Case& settings, const SimulatedCut& cut, const ExpectedErrors& expected) {
  Tissue least;
  if (settings.plan.kind == PlanKind::Line) {
    if (cut.line_to_edge_mm)
      least = {*cut.line_to_edge_mm - radius_mm(settings.tool), "mid-line, seen along the approach,", {}};
  } else {
    note_evaluation(settings, expected, cut.centerline, expected.tumor_edge, radius_mm(settings.tool), "mid-line",
                    least);
    note_evaluation(settings, expected, cut.inner_edge, cut.incision.final_tumor_edge, 0.0, "inner edge, the tool out,",
                    least);
    if (!cut.incision.kerf.deep_margin) note_layers(settings, cut, expected, least);
  }
  return least;
}

/// States the margin with which a ring with the same error would keep the close margin.
std::string margin_that_would_do(const Case& settings, double left_mm) {
  if (settings.plan.kind == PlanKind::Line) return {};
  const double needed_mm = settings.plan.lateral_margin_mm + settings.close_margin_mm - left_mm;
  return fmt::format(". With a lateral margin of {:.1f} mm, a cut with the same error would leave enough",
                     std::floor(10.0 * needed_mm + 1.0) / 10.0);
}

/// Formats "leaves 2.13 mm of tissue beside the tumour's edge", with enough digits to differ from the limit.
std::string tissue_in_words(double left_mm, double limit_mm) {
  if (left_mm < 0.0) return fmt::format("lies {:.2f} mm inside the tumour's edge", -left_mm);
  int digits = 2;
  while (digits < 4 && fmt::format("{:.{}f}", left_mm, digits) == fmt::format("{:.{}f}", limit_mm, digits)) ++digits;
  return fmt::format("leaves {:.{}f} mm of tissue beside the tumour's edge", left_mm, digits);
}

/// Formats "inner edge, the tool out, with the errors …, leaves 2.13 mm …": the expectation for a line.
std::string expected_in_words(const Tissue& least, double limit_mm) {
  return fmt::format("{}{} with the errors that compensation expects of real cuts, {}", least.of,
                     least.of.ends_with(',') ? "" : ",", tissue_in_words(least.left_mm, limit_mm));
}

/// Refuses a cut that is expected too near the tumour, or enters it in simulation. Errors learned from other cuts may
/// correct the simulation, but not by the whole margin.
void judge_margin(const Case& settings, const SimulatedCut& cut, const ExpectedErrors& expected, Verdict& verdict) {
  const double limit_mm = settings.close_margin_mm;
  const Tissue simulated = least_tissue(settings, cut, {});
  if (!std::isfinite(simulated.left_mm)) return;  // nothing was measured: the outcome says so
  const std::string as_simulated = fmt::format("{} {}", simulated.of, tissue_in_words(simulated.left_mm, limit_mm));
  const auto refuse = [&](const Tissue& least, const std::string& words) {
    verdict.add("lateral_margin", least.left_mm,
                fmt::format("the simulated cut's {}; more than {} mm of tissue is required{}", words, limit_mm,
                            margin_that_would_do(settings, least.left_mm)),
                least.at, limit_mm);
  };
  if (expected.is_any()) {
    const Tissue least = least_tissue(settings, cut, expected);
    const std::string as_expected = expected_in_words(least, limit_mm);
    if (least.left_mm <= limit_mm) return refuse(least, as_expected);
    if (simulated.left_mm > 0.0 && simulated.left_mm <= limit_mm) {
      verdict.add("simulated_margin", simulated.left_mm,
                  fmt::format("the simulated cut's {}; its {}. More than {} mm is required", as_simulated, as_expected,
                              limit_mm),
                  simulated.at, limit_mm);
      return;
    }
  }
  if (simulated.left_mm <= limit_mm) refuse(simulated, as_simulated);
}

/// Reports that expected errors could not be determined.
void judge_expectation(const ExpectedErrors& expected, Verdict& verdict) {
  if (expected.is_measured) return;
  verdict.add("simulated_margin", {},
              "the margin is judged as simulated: the errors that compensation expects of real cuts need those of the "
              "first simulated cut, and it left no ring round the middle of the tumour's edge");
}

void judge_tumor(const Case& settings, const SimulatedCut& cut, Verdict& verdict) {
  const std::optional<DeepMargin>& margin = cut.incision.kerf.deep_margin;
  if (!margin || margin->nearest_mm > settings.close_margin_mm) return;
  const std::string what = margin->nearest_mm < 0.0 ? fmt::format("enters the tumour by {:.2f} mm", -margin->nearest_mm)
                                                    : fmt::format("comes within {:.2f} mm of the tumour", margin->nearest_mm);
  verdict.add("tumor_distance", margin->nearest_mm,
              fmt::format("the simulated kerf {}: it must stay more than {} mm away", what, settings.close_margin_mm),
              {}, settings.close_margin_mm);
}

/// Heat spreads from the electrode, which runs in the kerf's middle.
void judge_heat(const SimulatedCut& cut, Verdict& verdict) {
  std::optional<double> left_mm = cut.thermal_margin_mm;
  if (const std::optional<DeepMargin>& margin = cut.incision.kerf.deep_margin) {
    const double to_surface_mm = margin->nearest_mm + 0.5 * cut.incision.kerf_width_mm - cut.thermal_half_width_mm;
    left_mm = std::min(left_mm.value_or(to_surface_mm), to_surface_mm);
  }
  if (!left_mm || *left_mm >= 0.0) return;
  verdict.add("heat", *left_mm,
              fmt::format("heat reaches the tumour: it damages tissue {:.2f} mm beside the electrode, {:.2f} mm more than the cut keeps away "
                          "(a closed form, not calibrated, an upper bound unless thermal.absorbed_fraction is below 1)",
                          cut.thermal_half_width_mm, -*left_mm));
}

void judge_convergence(const SimulatedCut& cut, Verdict& verdict) {
  const IncisionResult& incision = cut.incision;
  if (incision.outcome == Outcome::Cancelled) return;
  if (!incision.steps.empty() && !incision.is_at_rest) {
    verdict.add("convergence", {}, "the simulated tissue is not at rest after the tool is out: the inner edge may still move");
  }
  if (static_cast<double>(incision.inverted_tets) > kInvertedShare * static_cast<double>(cut.tets)) {
    verdict.add(
        "convergence", static_cast<double>(incision.inverted_tets),
        fmt::format("tetrahedra of the simulated tissue that are turned inside out: {}", incision.inverted_tets));
  }
  const double held_back = static_cast<double>(incision.held_back_vertices) / std::max(1.0, static_cast<double>(incision.steps.size() * cut.tets));
  if (held_back > kHeldBackShare) {
    verdict.add("convergence", held_back,
                fmt::format("vertices were held back in their motion {} times in {} steps: the body lags for "
                            "numerical reasons only",
                            incision.held_back_vertices, incision.steps.size()));
  }
}

double cross(const Vec2& o, const Vec2& a, const Vec2& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

/// Counter-clockwise convex hull, without points on its edges (Andrew's monotone chain). O(n log n).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  const auto add = [&hull](const Vec2& p, std::size_t least) {
    while (hull.size() >= least + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
    hull.push_back(p);
  };
  for (const Vec2& p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();
  return hull;
}

Contour flat(const std::vector<Vec2>& points) {
  Contour contour;
  for (const Vec2& p : points) contour.points.emplace_back(p.x(), p.y(), 0.0);
  return contour;
}

/// Notes the farthest point of `points` outside a polygon in the plane z = 0.
void note_outside(const Contour& points, const Contour& polygon, EdgeFit& fit) {
  for (const Vec3& p : points.points) {
    if (contains_in_view(polygon, p, -Vec3::UnitZ())) continue;
    const double distance = nearest_on(polygon, p).distance_mm;
    if (distance > fit.apart_mm) fit = {distance, p};
  }
}

}  // namespace

std::optional<double> nearest_to_tumor_mm(const Case& settings, const SimulatedCut& cut) {
  double nearest_mm = least_tissue(settings, cut, {}).left_mm;
  if (cut.incision.kerf.deep_margin) nearest_mm = std::min(nearest_mm, cut.incision.kerf.deep_margin->nearest_mm);
  return std::isfinite(nearest_mm) ? std::optional(nearest_mm) : std::nullopt;
}

std::vector<DepthShare> depth_shares(const Case& settings, const DepthReached& depth) {
  std::vector<DepthShare> shares;
  // A tool along the surface's normal goes less deep along the approach: then only the path's own depth counts.
  const double asked_mm = settings.plan.axis_mode == AxisMode::Approach ? settings.plan.depth_mm : 0.0;
  for (std::size_t i = 0; i < depth.profile.depth_mm.size(); ++i) {
    const double planned = std::max(depth.planned_at_mm.at(i), asked_mm);
    if (planned > 0.0) shares.push_back({i, planned, depth.profile.depth_mm[i] / planned});
  }
  return shares;
}

std::vector<double> open_layers_mm(const IncisionResult& incision) {
  std::vector<double> depths;
  for (const KerfLayer& layer : incision.kerf.layers) {
    const bool is_cut = incision.is_closed_loop ? layer.is_closed.value_or(false) : layer.centerline.has_value();
    if (layer.is_within_plan && !is_cut) depths.push_back(layer.depth_mm);
  }
  return depths;
}

Verdict verdict_of_cut(const Case& settings, const SimulatedCut& cut, const ExpectedErrors& expected) {
  Verdict verdict;
  judge_outcome(cut, verdict);
  judge_tumor(settings, cut, verdict);
  judge_margin(settings, cut, expected, verdict);
  judge_expectation(expected, verdict);
  judge_layers(cut, verdict);
  judge_depth(settings, cut, verdict);
  judge_heat(cut, verdict);
  judge_convergence(cut, verdict);
  return verdict;
}

EdgeFit edge_fit(const Contour& edge, const TriMesh& surface, const Vec3& approach) {
  INCISE_REQUIRE(edge.points.size() >= 3 && !surface.vertices.empty(), "expected an edge of at least 3 points and a surface with vertices");
  const ViewFrame view = view_along(approach);
  const auto seen = [&view](const Points& points) {
    std::vector<Vec2> places;
    places.reserve(points.size());
    for (const Vec3& p : points) places.emplace_back(view.to_view(p).head<2>());
    return places;
  };
  const Contour outline = flat(convex_hull(seen(surface.vertices)));
  const Contour drawn = flat(seen(edge.points));
  EdgeFit fit;
  note_outside(drawn, outline, fit);
  note_outside(outline, drawn, fit);
  fit.at_mm = view.from_view(fit.at_mm);
  return fit;
}

Verdict verdict_of_contour(const Contour& edge, const TriMesh& surface, const Vec3& approach) {
  Verdict verdict;
  const double limit_mm = *verdict_rule("contour_surface").limit;
  const EdgeFit fit = edge_fit(edge, surface, approach);
  if (fit.apart_mm <= limit_mm) return verdict;
  Contour turned = edge;
  for (Vec3& p : turned.points) p = Vec3(-p.x(), -p.y(), p.z());
  const EdgeFit turned_fit = edge_fit(turned, surface, approach);
  const VerdictPlace place{{}, fit.at_mm, {}};
  if (turned_fit.apart_mm <= limit_mm) {
    verdict.add("contour_flipped", fit.apart_mm,
                fmt::format("the tumour's edge lies {:.1f} mm off the tumour's surface, and {:.1f} mm with x and y "
                            "reversed: it seems to have been drawn in RAS and saved without that information "
                            "(coordinates of files are LPS)",
                            fit.apart_mm, turned_fit.apart_mm),
                place, limit_mm);
  } else {
    verdict.add("contour_surface", fit.apart_mm,
                fmt::format("the tumour's edge and its surface lie up to {:.1f} mm apart, seen along the approach: "
                            "one of the two has the wrong place, frame or unit",
                            fit.apart_mm),
                place);
  }
  return verdict;
}

std::string uncorrected_path(const std::string& note) {
  return fmt::format("the correction is not accepted: a program would follow the uncorrected path{}{}",
                     note.empty() ? "" : ". The correction: ", note);
}

std::string rejected_correction(const std::string& note) {
  return fmt::format("this is a correction that was not accepted{}{}", note.empty() ? "" : ": ", note);
}

Verdict verdict_of_run(const Case& settings, const Verdict& about_inputs, const SimulatedCut* cut,
                       const std::optional<std::string>& objection) {
  Verdict verdict = about_inputs;
  if (cut != nullptr) {
    verdict.add(cut->verdict);
  } else {
    verdict.add("outcome", {}, "no cut was simulated");
  }
  if (cut != nullptr && objection) verdict.add("not_corrected", {}, uncorrected_path(*objection));
  if (settings.T_robot_sim && !settings.is_virtual) {
    verdict.add("typed_transform", {},
                "robot.T_robot_sim was typed into the case: no registration confirms that the specimen lies there "
                "(register, project and export find and check it)");
  }
  return verdict;
}

}  // namespace incise
