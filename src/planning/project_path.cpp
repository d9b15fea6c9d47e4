#include "planning/surface_walk.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/planning/project_path.hpp>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kBridgedMm = 0.5;
constexpr double kMostAsideMm = 1.0;  // from the local average of the shifts: the surfaces differ in shape

/// One rotation and one scale: p -> scale R p + t.
struct Similarity {
  explicit Similarity(const Mat4& T) : t(T.topRightCorner<3, 1>()) {
    const Mat3 A = T.topLeftCorner<3, 3>();
    const double determinant = A.determinant();
    INCISE_REQUIRE(T.allFinite() && determinant > 0.0,
                   fmt::format("expected a transform with a positive determinant, found {:.4g}", determinant));
    scale = std::cbrt(determinant);
    R = A / scale;
    const double shear = (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff();
    INCISE_REQUIRE(
        shear < 1e-4,
        fmt::format(
            "expected a rotation times one scale, found axes that miss being perpendicular and equally long by {:.2g}",
            shear));
  }
  [[nodiscard]] Vec3 operator*(const Vec3& p) const { return scale * (R * p) + t; }
  double scale = 1.0;
  Mat3 R;
  Vec3 t;
};

/// Projects points onto the surface one after the other and collects the measures.
class LayDown {
 public:
  LayDown(const MeasuredSurface& surface, const ProjectSettings& settings, const std::filesystem::path& name)
      : surface_(surface), settings_(settings), name_(name) {}

  void operator()(const Vec3& p, const std::string& what) {
    const std::optional<CloudPlace> place = surface_.at(p);
    const auto refuse = [&](const std::string& found, const std::string& expected) {
      throw DataError(name_, fmt::format("{} at {} mm", what, in_words(p)), found, expected,
                      "Does the transform belong to this surface, and is the whole path in view?");
    };
    if (!place) refuse("no measured surface", "the whole path on the measured surface, seen along the approach");
    if (place->is_extrapolated) refuse("a place beyond the measured surface's rim", "measured points all round");
    if (place->gap_mm > settings_.max_gap_mm) {
      refuse(fmt::format("a gap: the nearest measured point is {:.2f} mm away", place->gap_mm),
             fmt::format("at most {} mm", settings_.max_gap_mm));
    }
    const double shift = (p - place->position_mm).dot(surface_.approach());  // positive: p lies below the surface
    if (std::abs(shift) > settings_.max_shift_mm) {
      refuse(fmt::format("a point {:.2f} mm {} the measured surface", std::abs(shift), shift > 0.0 ? "below" : "above"),
             fmt::format("at most {} mm", settings_.max_shift_mm));
    }
    result.max_gap_mm = std::max(result.max_gap_mm, place->gap_mm);
    result.max_shift_mm = std::max(result.max_shift_mm, std::abs(shift));
    result.mean_shift_mm += shift;
    result.bridged += place->gap_mm > kBridgedMm ? 1 : 0;
    in_picture_.push_back(frame_.to_view(p).head<2>());
    before_.push_back(p);
    shifts_.push_back(shift);
    normals_.push_back(place->normal);
    names_.push_back(what);
  }
  /// Returns the k-th point, moved by the average of the shifts around it.
  Vec3 smoothed(std::size_t k) {
    if (settings_.smoothing_mm == 0.0 || !surface_.is_cloud()) return before_[k] - shifts_[k] * surface_.approach();
    const double average = averaged(k, [this](std::size_t i) { return Vec3(shifts_[i], 0.0, 0.0); }).x();
    const double aside = shifts_[k] - average;
    if (std::abs(aside) > kMostAsideMm) {
      throw DataError(
          name_, fmt::format("{} at {} mm", names_[k], in_words(before_[k])),
          fmt::format("a surface {:.2f} mm off the surface around it, measured from the simulated one", aside),
          fmt::format("at most {} mm", kMostAsideMm),
          "Is this the same tissue? --smoothing-mm 0 projects each point by itself.");
    }
    result.shift_noise_mm += aside * aside;
    return before_[k] - average * surface_.approach();
  }
  /// Averages the noise of neighbours out of the normals: a tool that nods from waypoint to waypoint demands too much
  /// of the arm. Two passes, because one leaves bends, and the joints' accelerations follow these.
  void smooth_normals() {
    constexpr int kPasses = 2;
    for (int pass = 0; pass < kPasses && settings_.smoothing_mm > 0.0; ++pass) {
      Points averages;
      for (std::size_t k = 0; k < normals_.size(); ++k)
        averages.push_back(averaged(k, [this](std::size_t i) { return normals_[i]; }).normalized());
      normals_ = std::move(averages);
    }
  }
  [[nodiscard]] const Vec3& normal(std::size_t k) const { return normals_[k]; }
  ProjectedPath finish() {
    if (const auto count = static_cast<double>(shifts_.size()); count > 0.0) {
      result.mean_shift_mm /= count;
      result.shift_noise_mm = std::sqrt(result.shift_noise_mm / count);
    }
    return result;
  }
  ProjectedPath result;

 private:
  /// Smooths three numbers per point: their value at the k-th point on planes fitted to the points around it.
  template <class ValueOf>
  [[nodiscard]] Vec3 averaged(std::size_t k, const ValueOf& value_of) const {
    Mat3 system = Mat3::Zero();
    Mat3 right = Mat3::Zero();  // a column for each number
    const double radius = settings_.smoothing_mm;
    for (std::size_t i = 0; i < shifts_.size(); ++i) {
      const Vec2 d = (in_picture_[i] - in_picture_[k]) / radius;
      if (d.squaredNorm() >= 1.0) continue;
      const double weight = std::pow(1.0 - d.squaredNorm(), 2);
      const Vec3 basis(1.0, d.x(), d.y());
      system += weight * basis * basis.transpose();
      right += weight * basis * value_of(i).transpose();
    }
    system.diagonal().tail<2>().array() += 1e-9 * system(0, 0);  // points on a line do not fix the slope across it
    return system.ldlt().solve(right).row(0).transpose();
  }

  const MeasuredSurface& surface_;
  const ProjectSettings& settings_;
  const std::filesystem::path& name_;
  ViewFrame frame_ = view_along(surface_.approach());
  std::vector<Vec2> in_picture_;
  Points before_;
  std::vector<double> shifts_;  // along the approach, mm
  Points normals_;              // of the surface, against the approach
  std::vector<std::string> names_;
};

/// Returns the tool's course before projection, in the robot's frame.
std::vector<Waypoint> course_of(const ToolPath& path, const Similarity& similarity, const Vec3& approach,
                                const ProjectSettings& settings) {
  std::vector<Waypoint> course;
  if (settings.kind == PathKind::Mark) {
    const Contour even = resample(path.tumor_edge, static_cast<std::size_t>(settings.mark_waypoints));
    for (const Vec3& p : even.points)
      course.push_back({similarity * p, approach, settings.mark_depth_mm, settings.mark_speed_mm_s});
    return course;
  }
  for (const Waypoint& w : path.waypoints) {
    course.push_back({similarity * w.position_mm, (similarity.R * w.axis).normalized(),
                      settings.incise_depth_mm.value_or(w.depth_mm),
                      settings.incise_speed_mm_s.value_or(w.speed_mm_s)});
  }
  return course;
}

}  // namespace

MeasuredSurface::MeasuredSurface(const TriMesh& surface, const Vec3& approach) : approach_(approach.normalized()) {
  if (surface.triangles.empty()) {
    cloud_.emplace(surface.vertices, approach_);
  } else {
    mesh_.emplace(surface);
  }
}

std::optional<CloudPlace> MeasuredSurface::at(const Vec3& p) const {
  if (cloud_) return cloud_->at(cloud_->frame().to_view(p).head<2>());
  const std::optional<SurfacePoint> seen = mesh_->seen_at(p, approach_);
  if (!seen) return std::nullopt;
  const Vec3 normal =
      seen->normal.dot(approach_) > 0.0 ? Vec3(-seen->normal) : seen->normal;  // an open mesh may be turned either way
  return CloudPlace{seen->position_mm, normal, 0.0, false};
}

Vec3 approach_of(const ToolPath& path, const Mat4& T_robot_sim) {
  INCISE_REQUIRE(!path.waypoints.empty(), "expected a path with waypoints");
  const Similarity similarity(T_robot_sim);
  Vec3 sum = Vec3::Zero();
  for (const Waypoint& w : path.waypoints) sum += similarity.R * w.axis;
  INCISE_REQUIRE(sum.norm() > 0.5 * static_cast<double>(path.waypoints.size()),
                 "expected axes that point into the tissue from one side");
  return sum.normalized();
}

Mat4 at_true_size(double scale, const Vec3& center_mm) {
  INCISE_REQUIRE(std::isfinite(scale) && scale > 0.0 && center_mm.allFinite(),
                 fmt::format("expected a scale above 0 and a finite centre, found a scale of {}", scale));
  Mat4 T = Mat4::Identity();
  T.topLeftCorner<3, 3>() /= scale;
  T.topRightCorner<3, 1>() = (1.0 - 1.0 / scale) * center_mm;
  return T;
}

ProjectedPath project_path(const ToolPath& path, const Mat4& T_robot_sim, const MeasuredSurface& surface,
                           const ProjectSettings& settings, const std::filesystem::path& name) {
  require_none(problems_of(settings));
  INCISE_REQUIRE(path.frame == PathFrame::SimStretched,
                 fmt::format("expected a path in frame sim_stretched, found {}", to_string(path.frame)));
  INCISE_REQUIRE(settings.kind == PathKind::Incise || path.tumor_edge.points.size() >= 3,
                 "expected a path with a tumour edge to mark");
  const Similarity similarity(T_robot_sim);
  LayDown lay_down(surface, settings, name);
  ToolPath& result = lay_down.result.path;
  result.frame = PathFrame::Robot;
  result.kind = settings.kind;
  result.is_closed = settings.kind == PathKind::Mark ? path.tumor_edge.is_closed : path.is_closed;
  result.T_robot_sim = T_robot_sim;
  result.tumor_edge.is_closed = path.tumor_edge.is_closed;
  const std::size_t edge = path.tumor_edge.points.size();
  for (std::size_t i = 0; i < edge; ++i)
    lay_down(similarity * path.tumor_edge.points[i], fmt::format("tumour edge point {}", i));
  for (const Waypoint& wanted : course_of(path, similarity, surface.approach(), settings)) {
    lay_down(wanted.position_mm, fmt::format("waypoint {}", result.waypoints.size()));
    result.waypoints.push_back(wanted);
  }
  for (std::size_t i = 0; i < edge; ++i) result.tumor_edge.points.push_back(lay_down.smoothed(i));
  if (settings.axis_mode == AxisMode::SurfaceNormal) lay_down.smooth_normals();
  for (std::size_t i = 0; i < result.waypoints.size(); ++i) {
    result.waypoints[i].position_mm = lay_down.smoothed(edge + i);
    if (settings.axis_mode == AxisMode::SurfaceNormal) result.waypoints[i].axis = -lay_down.normal(edge + i);
  }
  return lay_down.finish();
}

}  // namespace incise
