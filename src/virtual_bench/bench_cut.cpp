#include "virtual_bench/electrode.hpp"
#include "virtual_bench/loose_parts.hpp"
#include "virtual_bench/relaxation.hpp"

#include <incise/bench_kit/pictures.hpp>
#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/kerf_contours.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

constexpr const char* kCuttingStage = "cutting the virtual specimen";
constexpr int kKeptSteps = 10;     // steps for which the tangent of tissue away from the tool is kept
constexpr double kLivelyMm = 3.0;  // from the tool's way in these steps: tissue within it gets a new tangent each time
constexpr int kMoments = 3;        // of a step, at which the dose of steam is evaluated
constexpr int kMostSolutions =
    4;  // per step; one is enough if it moves no vertex too far (the next step corrects the remainder)
constexpr double kTolerance = 0.1;
constexpr double kLeastContact = 0.02;  // wet tissue always keeps some contact
constexpr double kAheadMm = 15.0;       // ahead of the tool: skin within it counts for the shove
constexpr double kBulgeMm = 5.0;        // ahead of the tool: skin within it counts for the bulge
constexpr double kAsideMm = 5.0;        // to either side of the tool's course, for both
constexpr double kBridgeMm =
    0.5;  // radius: a strip of skin narrower than 1 mm does not hold the plug (as in photographs)
constexpr double kSettleTolerance = 0.02;  // mm
// Rosenthal's moving line source in a thick-plate limit: peak rise at distance y is kPeak q / (rho c v y), q power per
// length.
const double kPeak = std::sqrt(2.0 / (units::kPi * std::exp(1.0))) / 2.0;
constexpr double kHeatCapacityMjMm3K = 3.73;  // 1090 kg/m3 x 3421 J/(kg K), in mJ/(mm3 K)
constexpr double kDamageRiseK = 40.0;         // from 20 to 60 degrees C: denaturation
constexpr double kImmersedMm = 5.0;           // of the needle: the paper's depth

TipPose pose_at(const std::vector<TipPose>& course, double time_s) {
  const auto after = std::upper_bound(course.begin(), course.end(), time_s,
                                      [](double t, const TipPose& pose) { return t < pose.time_s; });
  if (after == course.begin()) return course.front();
  if (after == course.end()) return course.back();
  const TipPose& from = *(after - 1);
  const double share = (time_s - from.time_s) / (after->time_s - from.time_s);
  TipPose pose = *after;
  pose.time_s = time_s;
  pose.tip_mm = from.tip_mm + share * (after->tip_mm - from.tip_mm);
  pose.axis = (from.axis + share * (after->axis - from.axis)).normalized();
  return pose;
}

/// The part of the course in tissue with the electrode on, its times from 0.
std::vector<TipPose> cutting_part(const std::vector<TipPose>& course) {
  std::vector<TipPose> part;
  for (std::size_t i = 0; i < course.size(); ++i) {
    const bool is_next = i + 1 < course.size() && course[i + 1].is_cutting;
    if (course[i].is_cutting || (part.empty() && is_next)) part.push_back(course[i]);
  }
  INCISE_REQUIRE(part.size() >= 2, "expected a course with at least 2 poses at which it cuts");
  const double start = part.front().time_s;
  for (std::size_t i = 0; i < part.size(); ++i) {
    INCISE_REQUIRE(part[i].tip_mm.allFinite() && part[i].axis.allFinite() && std::isfinite(part[i].time_s),
                   fmt::format("expected finite numbers, found a non-finite one at pose {} of the cut", i));
    part[i].time_s -= start;
    INCISE_REQUIRE(i == 0 || part[i].time_s >= part[i - 1].time_s, "expected poses in order of time");
  }
  return part;
}

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double mean_speed(const std::vector<TipPose>& course) {
  double way = 0.0;
  double time = 0.0;
  for (std::size_t i = 1; i < course.size(); ++i) {
    const double length = (course[i].tip_mm - course[i - 1].tip_mm).norm();
    if (length < 1e-9) continue;
    way += length;
    time += course[i].time_s - course[i - 1].time_s;
  }
  INCISE_REQUIRE(way > 0.0 && time > 0.0, "expected a course that moves");
  return way / time;
}

/// One cut from plunge to photograph.
class Cut {
 public:
  Cut(const BenchBody& body, double power_w)
      : body_(body),
        mesh_(body.tissue->mesh),
        relaxation_(*body.tissue, body.stretched.positions),
        uncut_skin_(skin_at(body, body.stretched.positions)),
        loose_(mesh_, held_vertices(*body.tissue)),
        state_(body.stretched),
        dose_kpa_(mesh_.tets.size(), 0.0),
        slip_mm_s_(mesh_.tets.size(), 0.0) {
    const Specimen& s = body.specimen;
    // The steam's work per time and volume: the kernel's integral over the immersed needle is pi reach²/3 times the
    // immersed length.
    const double volume = units::kPi * Electrode::kSteamReachMm * Electrode::kSteamReachMm / 3.0 * kImmersedMm;
    const double work_uj_s = 1e6 * std::max(0.0, power_w - s.lost_power_w) * 0.01 * s.rupture_percent;
    steam_kpa_s_ = work_uj_s / volume;
    contact_share_ = std::clamp((s.full_arc_w - power_w) / (s.full_arc_w - s.lost_power_w), kLeastContact, 1.0);
    is_on_skin_.assign(mesh_.vertices.size(), 0);
    for (const BoundaryFace& face : body.skin)
      for (const VertexId v : face.corners) is_on_skin_[v.index()] = 1;
  }

  BenchCut run(const std::vector<TipPose>& course, double power_w, Workers& workers, Monitor& monitor);

 private:
  static std::vector<std::uint8_t> held_vertices(const TissueModel& model) {
    std::vector<std::uint8_t> held(model.is_fixed.size(), 0);
    for (std::size_t v = 0; v < held.size(); ++v)
      held[v] = model.is_fixed[v][0] || model.is_fixed[v][1] || model.is_fixed[v][2] ? 1 : 0;
    return held;
  }
  std::vector<DragPoint> drags(const std::vector<std::size_t>& touched, const Electrode& tool) const;
  void step(const TipPose& from, const TipPose& to, double step_s, Workers& workers);
  void slip_of(const std::vector<std::size_t>& touched, const Vec3& velocity, double step_s);
  void dose(const std::vector<std::size_t>& touched, const std::vector<DragPoint>& points, const TipPose& from,
            const TipPose& to, double step_s);
  void part_tissue(const std::vector<std::size_t>& touched);
  void watch_skin(const Vec3& tip, const Vec3& velocity);
  [[nodiscard]] std::vector<std::uint8_t> lively_tets(const std::vector<TipPose>& way) const;
  void settle(Workers& workers, Monitor& monitor);
  void read_edges();

  const BenchBody& body_;
  const TetMesh& mesh_;
  Relaxation relaxation_;
  SurfaceQuery uncut_skin_;
  LooseParts loose_;
  TissueState state_;
  Points before_;
  std::vector<double> dose_kpa_;
  std::vector<double> slip_mm_s_;  // per tet: tool's speed relative to it when last touched; 0: not touched yet
  std::vector<std::uint8_t> is_on_skin_;
  std::vector<double> shoves_mm_, bulges_mm_;  // per step in which the tool travels along the skin
  std::vector<double> forces_mn_;
  double steam_kpa_s_ = 0.0;
  double contact_share_ = 1.0;  // share of time in which electrode and tissue touch: no arc separates them
  bool is_finite_ = true;
  BenchCut result_;
};

std::vector<DragPoint> Cut::drags(const std::vector<std::size_t>& touched, const Electrode& tool) const {
  const Specimen& s = body_.specimen;
  std::vector<DragPoint> points;
  for (const std::size_t tet : touched) {
    // The adhesion's strength bounds the drag: viscosity falls with the slip speed.
    const double viscosity = contact_share_ * s.adhesion_kpa_s_mm2 /
                             (1.0 + s.adhesion_kpa_s_mm2 * slip_mm_s_[tet] / s.adhesion_limit_kpa_mm);
    for (const auto& weights : quadrature()) {
      const double share =
          kernel(tool.distance_mm(point_in(mesh_, state_.positions, tet, weights)), Electrode::kDragReachMm);
      if (share > 0.0) points.push_back({tet, weights, viscosity * share * 0.25 * body_.tissue->volumes_mm3[tet]});
    }
  }
  return points;
}

void Cut::slip_of(const std::vector<std::size_t>& touched, const Vec3& velocity, double step_s) {
  constexpr std::array<double, 4> kMiddle{0.25, 0.25, 0.25, 0.25};
  for (const std::size_t tet : touched) {
    const Vec3 moved = point_in(mesh_, state_.positions, tet, kMiddle) - point_in(mesh_, before_, tet, kMiddle);
    slip_mm_s_[tet] = (velocity - moved / step_s).norm();
  }
}

void Cut::dose(const std::vector<std::size_t>& touched, const std::vector<DragPoint>& points, const TipPose& from,
               const TipPose& to, double step_s) {
  for (const std::size_t tet : touched) {
    double share = 0.0;
    for (int m = 0; m < kMoments; ++m) {
      const double t = (m + 0.5) / kMoments;
      const Electrode tool{from.tip_mm + t * (to.tip_mm - from.tip_mm), to.axis};
      for (const auto& weights : quadrature()) {
        const Vec3 p =
            (1.0 - t) * point_in(mesh_, before_, tet, weights) + t * point_in(mesh_, state_.positions, tet, weights);
        share += 0.25 / kMoments * kernel(tool.distance_mm(p), Electrode::kSteamReachMm);
      }
    }
    dose_kpa_[tet] += step_s * steam_kpa_s_ * share;
  }
  // The work of the drag where the tool slips.
  for (const DragPoint& point : points) {
    dose_kpa_[point.tet] += step_s * point.viscosity_mn_s_mm * slip_mm_s_[point.tet] * slip_mm_s_[point.tet] /
                            body_.tissue->volumes_mm3[point.tet];
  }
}

void Cut::part_tissue(const std::vector<std::size_t>& touched) {
  std::vector<std::size_t> gone;
  for (const std::size_t tet : touched) {
    if (dose_kpa_[tet] < body_.toughness_kpa[tet]) continue;
    state_.is_live[tet] = 0;
    gone.push_back(tet);
  }
  if (gone.empty()) return;
  const std::vector<std::size_t> loose = loose_.beside(gone, state_.is_live);
  for (const std::size_t tet : loose) state_.is_live[tet] = 0;
  result_.loose_tets += loose.size();
  result_.removed_tets += gone.size() + loose.size();
}

void Cut::watch_skin(const Vec3& tip, const Vec3& velocity) {
  const Vec3 flat = velocity - velocity.dot(body_.approach) * body_.approach;
  if (flat.norm() < 0.5 * velocity.norm() || flat.norm() < 1e-9) return;  // plunging or at rest
  const Vec3 heading = flat.normalized();
  const Vec3 aside = heading.cross(body_.approach);
  double shoved = 0.0;
  double risen = 0.0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < is_on_skin_.size(); ++v) {
    if (is_on_skin_[v] == 0) continue;
    const Vec3 from_tip = state_.positions[v] - tip;
    const double ahead = from_tip.dot(heading);
    if (ahead < 0.0 || ahead > kAheadMm || std::abs(from_tip.dot(aside)) > kAsideMm) continue;
    if (from_tip.dot(body_.approach) > 0.0) continue;  // on the underside
    const Vec3 moved = state_.positions[v] - body_.stretched.positions[v];
    shoved += moved.norm();
    ++count;
    result_.max_drag_mm = std::max(result_.max_drag_mm, moved.cross(body_.approach).norm());
    if (ahead > kBulgeMm) continue;
    if (const auto below = uncut_skin_.seen_at(state_.positions[v], body_.approach))
      risen = std::max(risen, below->distance_mm);
  }
  if (count == 0) return;
  shoves_mm_.push_back(shoved / static_cast<double>(count));
  bulges_mm_.push_back(risen);
}

void Cut::step(const TipPose& from, const TipPose& to, double step_s, Workers& workers) {
  const Electrode tool{to.tip_mm, to.axis};
  const Vec3 velocity = (to.tip_mm - from.tip_mm) / step_s;
  before_ = state_.positions;
  const std::vector<std::size_t> touched = tets_in_reach(mesh_, state_, tool, velocity.norm() * step_s);
  ++result_.steps;
  if (touched.empty()) return;
  std::vector<DragPoint> points;
  for (int n = 0; n < kMostSolutions; ++n) {
    points = drags(touched, tool);
    const RelaxReport report = relaxation_.solve(state_, before_, step_s, points, velocity, kTolerance, workers);
    result_.linear_iterations += report.iterations;
    ++result_.solutions;
    is_finite_ = is_finite_ && report.is_finite;
    if (!is_finite_) return;
    slip_of(touched, velocity, step_s);
    if (report.max_step_mm < Relaxation::kMostStepMm) break;
  }
  Vec3 force = Vec3::Zero();
  for (const DragPoint& point : points) {
    const Vec3 moved = point_in(mesh_, state_.positions, point.tet, point.weights) -
                       point_in(mesh_, before_, point.tet, point.weights);
    force += point.viscosity_mn_s_mm * (velocity - moved / step_s);
  }
  forces_mn_.push_back(force.norm());
  end_viscous_step(*body_.tissue, state_, step_s, workers);
  dose(touched, points, from, to, step_s);
  part_tissue(touched);
  watch_skin(to.tip_mm, velocity);
}

/// Tets near the tool's way.
std::vector<std::uint8_t> Cut::lively_tets(const std::vector<TipPose>& way) const {
  std::vector<std::uint8_t> is_lively(mesh_.tets.size(), 0);
  for (std::size_t t = 0; t < is_lively.size(); ++t) {
    const Vec3& corner = state_.positions[mesh_.tets[t][0].index()];
    const auto is_near = [&](const TipPose& pose) {
      return Electrode{pose.tip_mm, pose.axis}.distance_mm(corner) < kLivelyMm;
    };
    is_lively[t] = std::any_of(way.begin(), way.end(), is_near) ? 1 : 0;
  }
  return is_lively;
}

/// Lets the tissue come to rest, the tool out: half a minute until the photograph, in growing steps.
void Cut::settle(Workers& workers, Monitor& monitor) {
  constexpr int kMostSettling = 25;
  const std::vector<std::uint8_t> none(mesh_.tets.size(), 0);
  for (const double step_s : {0.2, 0.8, 3.0, 10.0, 20.0}) {
    relaxation_.renew(state_, step_s, none, workers);
    for (int n = 0; n < kMostSettling; ++n) {
      throw_if_cancelled(monitor, kCuttingStage);
      const RelaxReport report =
          relaxation_.solve(state_, state_.positions, step_s, {}, Vec3::Zero(), kTolerance, workers);
      result_.linear_iterations += report.iterations;
      ++result_.solutions;
      is_finite_ = is_finite_ && report.is_finite;
      if (!is_finite_) return;
      result_.unrest_mm = report.max_step_mm;
      if (report.max_step_mm < kSettleTolerance) break;
    }
    end_viscous_step(*body_.tissue, state_, step_s, workers);
  }
}

void Cut::read_edges() {
  result_.tumor_edge = tumor_edge_at(body_, state_.positions);
  CutSurface surface;
  surface.vertices = state_.positions;
  surface.approach = body_.approach;
  surface.inside_mm = curve_centroid(result_.tumor_edge);
  add_faces(body_, state_.is_live, surface.triangles, surface.is_skin);
  InnerEdgeSettings settings;
  settings.opening_mm = kBridgeMm;
  result_.inner_edge = inner_edge_contour(surface, settings);
}

BenchCut Cut::run(const std::vector<TipPose>& given, double power_w, Workers& workers, Monitor& monitor) {
  const std::vector<TipPose> course = cutting_part(given);
  const double speed = mean_speed(course);
  const double duration = course.back().time_s;
  const int steps = std::max(1, static_cast<int>(std::ceil(duration * speed / body_.resolution.way_mm)));
  for (int n = 0; n < steps && is_finite_; ++n) {
    throw_if_cancelled(monitor, kCuttingStage);
    const auto at = [&](int k) { return pose_at(course, duration * std::min(k, steps) / steps); };
    if (n % kKeptSteps == 0) {
      std::vector<TipPose> way;
      for (int k = n; k <= n + kKeptSteps; ++k) way.push_back(at(k));
      relaxation_.renew(state_, duration / steps, lively_tets(way), workers);
    }
    step(at(n), at(n + 1), duration / steps, workers);
    monitor.progress(kCuttingStage, static_cast<double>(n + 1) / (steps + 10));
  }
  if (is_finite_) settle(workers, monitor);
  result_.thermal_width_mm = kPeak * power_w * 1000.0 * 0.01 * body_.specimen.heat_percent /
                             (kImmersedMm * kHeatCapacityMjMm3K * speed * kDamageRiseK);
  result_.shove_mm = mean_of(shoves_mm_);
  result_.bulge_mm = mean_of(bulges_mm_);
  result_.mean_force_mn = mean_of(forces_mn_);
  if (is_finite_) read_edges();
  const bool is_at_rest = is_finite_ && result_.unrest_mm < kSettleTolerance;
  result_.outcome = !is_at_rest ? Outcome::NotConverged : !result_.inner_edge ? Outcome::OpenLoop : Outcome::Success;
  result_.after = std::move(state_);
  return std::move(result_);
}

}  // namespace

BenchCut cut_specimen(const BenchBody& body, const std::vector<TipPose>& course, double power_w, Workers& workers,
                      Monitor& monitor) {
  INCISE_REQUIRE(power_w > 0.0 && std::isfinite(power_w), fmt::format("expected a power above 0 W, found {}", power_w));
  return Cut(body, power_w).run(course, power_w, workers, monitor);
}

std::vector<double> true_errors_mm(const BenchBody& body, const BenchCut& cut, double target_mm, std::size_t points) {
  INCISE_REQUIRE(cut.inner_edge.has_value(), "expected a cut with a closed inner edge");
  const ViewFrame view = view_along(body.approach);
  return errors_seen_mm(resample(flat_in_view(*cut.inner_edge, view), points).points,
                        flat_in_view(cut.tumor_edge, view), target_mm);
}

}  // namespace incise
