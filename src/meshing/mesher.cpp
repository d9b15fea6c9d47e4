#include "meshing/body_field.hpp"
#include "meshing/delaunay_mesher.hpp"
#include "meshing/mesh_order.hpp"
#include "meshing/sampled_sizing.hpp"
#include "meshing/volume_by_iso.hpp"
#include "meshing/voxel_grids.hpp"

#include <incise/core/error.hpp>
#include <incise/meshing/mesher.hpp>
#include <incise/meshing/occupancy.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace incise {
namespace {

using meshing_detail::BodyField;
using meshing_detail::BodyReport;
using meshing_detail::DelaunayCriteria;
using meshing_detail::DelaunayDomain;
using meshing_detail::DelaunayMesher;
using meshing_detail::RefineEnd;
using meshing_detail::SampledSizing;
using meshing_detail::VolumeByIso;

// Measured on a ball and a tongue-like body, 4k to 200k tets, with the default factors; inversely proportional to the
// cube of cell_size_factor.
constexpr double kTetsPerCube = 10.3;
constexpr double kCellSizeOfCalibration = 0.75;
constexpr double kLeftAfterPerturbation = 0.99;  ///< perturbation and exudation lose about 1 % of the tets
constexpr double kEnoughOfTolerance = 0.5;       ///< refinement stops correcting within half of the tolerance

/// Returns the number of vertices at which refinement gives up: three times as many as max_tets usually has.
std::size_t most_vertices(const MeshingSettings& settings) {
  return settings.max_tets / 2 + 1000;
}

/// The volume with which the mesh's volume is compared.
enum class TissueVolume {
  InsideSkin,      ///< enclosed by the surface of occupancy 0.5: correct for occupancy with a faint halo
  SumOfOccupancy,  ///< sum of the occupancy: the volume before a blur that preserves the sum
};

constexpr double kSkin = 0.5;

/// The state of one call.
class Meshing {
 public:
  Meshing(const GrayVolume& occupancy, TissueVolume meant, const SizingField& sizing, const MeshingSettings& settings,
          Monitor& monitor)
      : settings_(settings), monitor_(monitor), field_(sizing) {
    in_phase("body", 0.0, [&] {
      body_ = BodyField::largest_body(occupancy, report_);
      enclosed_.emplace(body_);
      label_mm3_ = meant == TissueVolume::SumOfOccupancy ? report_.volume_mm3 : enclosed_->volume_mm3(kSkin);
      const std::optional<double> iso = enclosed_->iso_for(label_mm3_);
      if (!iso) {
        throw InvalidArgument(
            fmt::format("labels: no surface of constant occupancy encloses the {:.4g} mm3 of the tissue: the body is "
                        "too thin for its voxels. Use a finer volume or less blur",
                        label_mm3_));
      }
      result_.iso = *iso;
    });
    in_phase("sizing", 0.05, [&] { sampled_.emplace(sizing, body_, result_.iso); });
  }

  MeshingResult run() {
    predict();
    refine_to_fit();
    improve();
    finish();
    return std::move(result_);
  }

 private:
  template <class Work>
  void in_phase(const std::string& name, double fraction, const Work& work) {
    throw_if_cancelled(monitor_, "meshing");
    progress_ = std::max(progress_, fraction);  // phases may repeat
    monitor_.progress("meshing", progress_);
    const auto start = std::chrono::steady_clock::now();
    work();
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto known = std::ranges::find(result_.phases, name, &MeshingPhase::name);
    if (known == result_.phases.end()) {
      result_.phases.push_back({name, wall_s});
    } else {
      known->wall_s += wall_s;
    }
  }

  [[nodiscard]] double predicted_tets(const SizingField& field) const {
    return tets_per_cube_ * sampled_->cubes(field);
  }

  /// Returns the scale of the sizing field at which the predicted count is the target.
  [[nodiscard]] double scale_for_target() const {
    constexpr int kBisections = 60;
    double low = 1.0e-2;
    double high = 1.0e2;
    for (int step = 0; step < kBisections; ++step) {
      const double middle = std::sqrt(low * high);
      (predicted_tets(field_.scaled(middle)) > *settings_.target_tets ? low : high) = middle;
    }
    return std::sqrt(low * high);
  }

  void predict() {
    tets_per_cube_ = kTetsPerCube * std::pow(kCellSizeOfCalibration / settings_.cell_size_factor, 3.0);
    if (settings_.target_tets) scale_ = scale_for_target();
    result_.predicted_tets = predicted_tets(field_.scaled(scale_));
    if (std::round(result_.predicted_tets) <= static_cast<double>(settings_.max_tets))
      return;  // a target is reproduced up to rounding
    throw InvalidArgument(
        fmt::format("mesh sizing: fine_mm = {:.3g} and coarse_mm = {:.3g} predict {:.0f} tetrahedra, "
                    "expected at most {}. Use longer edges or a smaller target count.",
                    scale_ * field_.settings().fine_mm, scale_ * field_.settings().coarse_mm, result_.predicted_tets,
                    settings_.max_tets));
  }

  DelaunayMesher start_mesher(double scale) {
    constexpr std::size_t kMostStartPoints = 40;
    constexpr std::size_t kLeastStartPoints = 12;
    constexpr double kStartSpacing = 3.0;  // in longest edges: start points must not force finer triangles
    const SizingField field = field_.scaled(scale);
    const double longest_mm = field.settings().coarse_mm;
    const double iso = result_.iso;
    DelaunayCriteria criteria{.facet_angle_deg = settings_.facet_angle_deg,
                              .facet_size_factor = settings_.facet_size_factor,
                              .facet_distance_mm = std::max(settings_.facet_distance_floor_mm,
                                                            settings_.facet_distance_factor * field.settings().fine_mm),
                              .cell_radius_edge_ratio = settings_.radius_edge_ratio,
                              .cell_size_factor = settings_.cell_size_factor,
                              .max_vertices = most_vertices(settings_)};
    DelaunayDomain domain{
        .is_inside = [this, iso](const Vec3& p) { return body_.value_at(p) > iso; },
        .edge_length_mm = [this, field](const Vec3& p) { return field.edge_length_at_mm(sampled_->distance_mm(p)); },
        .is_cancelled = [this] { return monitor_.is_cancelled(); },
        .box = body_.box(),
        .surface_points =
            body_.spread_surface_points(iso, kMostStartPoints, kLeastStartPoints, kStartSpacing * longest_mm)};
    return {std::move(domain), criteria};
  }

  DelaunayMesher refined(double scale, double fraction) {
    std::optional<DelaunayMesher> mesher;
    RefineEnd end = RefineEnd::Done;
    in_phase("refine", fraction, [&] {
      mesher.emplace(start_mesher(scale));
      end = mesher->refine();
    });
    throw_if_cancelled(monitor_, "meshing");
    if (end == RefineEnd::TooManyVertices) {
      throw InvalidArgument(
          fmt::format("mesh sizing: refinement exceeded {} vertices; use longer edges", most_vertices(settings_)));
    }
    if (mesher->tet_count() == 0) {
      throw InvalidArgument(fmt::format("mesh sizing: a body of {:.3g} mm3 is too small for edges of {:.3g} mm",
                                        label_mm3_, scale * field_.settings().fine_mm));
    }
    return std::move(*mesher);
  }

  /// Refines until count and volume fit; after each attempt, corrects the prediction and the iso value by its result.
  void refine_to_fit() {
    double aimed_mm3 = label_mm3_;
    for (;;) {
      mesher_.emplace(refined(scale_, 0.1 + 0.5 * result_.refinements / settings_.max_refinements));
      ++result_.refinements;
      const double tets = kLeftAfterPerturbation * static_cast<double>(mesher_->tet_count());
      const double missing_mm3 = label_mm3_ - volume_mm3(mesher_->extract());
      const bool count_fits = !settings_.target_tets || std::abs(tets / *settings_.target_tets - 1.0) <=
                                                            kEnoughOfTolerance * settings_.target_tolerance;
      const bool volume_fits = std::abs(missing_mm3) <= kEnoughOfTolerance * settings_.volume_tolerance * label_mm3_;
      if ((count_fits && volume_fits) || result_.refinements >= settings_.max_refinements) return;
      if (!count_fits) {
        tets_per_cube_ *= tets / predicted_tets(field_.scaled(scale_));
        scale_ = scale_for_target();
      }
      if (!volume_fits) {
        aimed_mm3 += missing_mm3;
        // A very coarse mesh of a round body cannot reach its volume: `meets_volume` is then false.
        result_.iso = enclosed_->iso_for(aimed_mm3).value_or(result_.iso);
      }
    }
  }

  /// Removes slivers. If some remain, starts again with slightly shorter edges, which gives a different mesh, and keeps
  /// the best.
  void improve() {
    constexpr double kShorter = 0.985;
    double best_deg = -1.0;
    for (double scale = scale_; result_.improvements < settings_.max_improvements; scale *= kShorter) {
      if (result_.improvements > 0) mesher_.emplace(refined(scale, 0.9));
      in_phase("perturb", 0.7, [&] { mesher_->perturb(settings_.sliver_bound_deg); });
      in_phase("exude", 0.9, [&] { mesher_->exude(settings_.sliver_bound_deg); });
      ++result_.improvements;
      TetMesh mesh = mesher_->extract();
      const double min_deg = quality_of(mesh).min_dihedral_deg;
      if (min_deg > best_deg) {
        best_deg = min_deg;
        result_.mesh = std::move(mesh);
        scale_ = scale;
      }
      if (best_deg >= settings_.min_dihedral_deg) return;
    }
  }

  void finish() {
    in_phase("finish", 0.95, [&] {
      TetMesh mesh = meshing_detail::largest_component(std::move(result_.mesh), result_.dropped_tets);
      mesh = meshing_detail::in_canonical_order(mesh);
      const bool is_mirrored = body_.grid().direction.determinant() < 0.0;
      for (Vec3& p : mesh.vertices) p = body_.world_from_local(p);
      if (is_mirrored) {
        for (Tet& tet : mesh.tets) std::swap(tet[2], tet[3]);
      }
      result_.quality = quality_of(mesh);
      result_.mesh = std::move(mesh);
    });
    result_.label_volume_mm3 = label_mm3_;
    result_.relative_volume_error = result_.quality.volume_mm3 / label_mm3_ - 1.0;
    result_.dropped_bodies = report_.dropped_bodies;
    result_.dropped_volume_mm3 = report_.dropped_volume_mm3;
    result_.fine_mm = scale_ * field_.settings().fine_mm;
    result_.coarse_mm = scale_ * field_.settings().coarse_mm;
    result_.meets_quality = result_.quality.min_dihedral_deg >= settings_.min_dihedral_deg;
    result_.meets_volume = std::abs(result_.relative_volume_error) <= settings_.volume_tolerance;
    result_.meets_target =
        !settings_.target_tets || std::abs(static_cast<double>(result_.quality.tets) / *settings_.target_tets - 1.0) <=
                                      settings_.target_tolerance;
    for (const MeshingPhase& phase : result_.phases) result_.wall_s += phase.wall_s;
    monitor_.progress("meshing", 1.0);
  }

  const MeshingSettings& settings_;
  Monitor& monitor_;
  SizingField field_;
  BodyField body_;
  BodyReport report_;
  double label_mm3_ = 0.0;
  std::optional<VolumeByIso> enclosed_;
  std::optional<SampledSizing> sampled_;
  std::optional<DelaunayMesher> mesher_;
  double scale_ = 1.0;
  double progress_ = 0.0;
  double tets_per_cube_ = kTetsPerCube;
  MeshingResult result_;
};

template <class Value, class IsTissue>
double longest_side_mm(const Volume<Value>& volume, const IsTissue& is_tissue) {
  INCISE_REQUIRE(volume.voxels.size() == volume.grid.voxel_count(), "expected one value per voxel");
  const Eigen::AlignedBox3i box =
      meshing_detail::box_of_voxels(volume.grid, [&](std::size_t at) { return is_tissue(volume.voxels[at]); });
  if (box.isEmpty()) return 0.0;
  return (box.sizes() + Eigen::Vector3i::Ones()).cast<double>().cwiseProduct(volume.grid.spacing_mm).maxCoeff();
}

}  // namespace

double longest_side_mm(const GrayVolume& occupancy) {
  return longest_side_mm(occupancy, [](float share) { return share >= 0.5F; });
}

double longest_side_mm(const LabelVolume& labels) {
  return longest_side_mm(labels, [](std::uint8_t label) { return label != 0; });
}

MeshingResult mesh_labels(const GrayVolume& occupancy, const SizingField& sizing, const MeshingSettings& settings,
                          Monitor& monitor) {
  require_none(validate(settings));
  return Meshing(occupancy, TissueVolume::InsideSkin, sizing, settings, monitor).run();
}

MeshingResult mesh_labels(const LabelVolume& labels, const SizingField& sizing, const MeshingSettings& settings,
                          Monitor& monitor) {
  require_none(validate(settings));
  return Meshing(occupancy_of(labels), TissueVolume::SumOfOccupancy, sizing, settings, monitor).run();
}

MeshingResult mesh_surface(const TriMesh& closed_surface, const SizingField& sizing, const MeshingSettings& settings,
                           Monitor& monitor, std::optional<double> voxel_mm) {
  constexpr double kVoxelsPerFineEdge = 2.0;
  require_none(validate(settings));
  const double edge_mm = voxel_mm.value_or(sizing.settings().fine_mm / kVoxelsPerFineEdge);
  const GrayVolume occupancy = occupancy_of(closed_surface, edge_mm);
  return Meshing(occupancy, TissueVolume::SumOfOccupancy, sizing, settings, monitor).run();
}

}  // namespace incise
