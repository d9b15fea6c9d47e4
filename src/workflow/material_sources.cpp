#include <incise/core/described_bytes.hpp>
#include <incise/core/error.hpp>
#include <incise/core/sha256.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/workflow/material_sources.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace incise {
namespace {

constexpr const char* kLabel = "label";

Points centroids_of(const TetMesh& mesh) {
  Points centroids;
  centroids.reserve(mesh.tets.size());
  for (const auto& [a, b, c, d] : mesh.tets) {
    centroids.push_back(0.25 * (mesh.vertices[a.index()] + mesh.vertices[b.index()] + mesh.vertices[c.index()] +
                                mesh.vertices[d.index()]));
  }
  return centroids;
}

/// Returns the label of the tissue voxel nearest to a place, among the 27 around it, because the skin extends beyond
/// the centres of its voxels. 0: none is tissue.
std::uint8_t label_at(const LabelVolume& labels, const std::array<bool, 256>& is_tissue, const Vec3& place) {
  const VolumeGrid& grid = labels.grid;
  const Vec3 index = grid.index_from_world(place);
  const Eigen::Array3i middle = index.array().round().cast<int>();
  std::uint8_t label = 0;
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (int k = middle[2] - 1; k <= middle[2] + 1; ++k)
    for (int j = middle[1] - 1; j <= middle[1] + 1; ++j)
      for (int i = middle[0] - 1; i <= middle[0] + 1; ++i) {
        if (!grid.contains(i, j, k) || !is_tissue.at(labels.at(i, j, k))) continue;
        const double distance_mm = grid.spacing_mm.cwiseProduct(Vec3(i, j, k) - index).norm();
        if (distance_mm >= nearest_mm) continue;
        nearest_mm = distance_mm;
        label = labels.at(i, j, k);
      }
  return label;
}

/// Interpolates trilinearly between those of the eight voxels round a place that are known, by their weights; nullopt:
/// none is known.
std::optional<double> known_at(const GrayVolume& map, const Vec3& place) {
  const Vec3 index = map.grid.index_from_world(place);
  const Eigen::Array3i low = index.array().floor().cast<int>();
  double sum = 0.0, weights = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3i at = low + Eigen::Array3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    if (!map.grid.contains(at[0], at[1], at[2]) || !(map.at(at[0], at[1], at[2]) > 0.0F)) continue;
    const double weight = (1.0 - (index.array() - at.cast<double>()).abs()).prod();
    sum += weight * static_cast<double>(map.at(at[0], at[1], at[2]));
    weights += weight;
  }
  return weights > 0.0 ? std::optional(sum / weights) : std::nullopt;
}

void lay_labels(const LabelVolume& labels, const SegmentationSettings& settings, const Points& centroids,
                TetMesh& mesh) {
  const std::array<bool, 256> is_tissue = tissue_labels(settings);
  DataArray array{1, {}};
  for (const Vec3& place : centroids) array.values.push_back(label_at(labels, is_tissue, place));
  mesh.cell_data[kLabel] = std::move(array);
}

MapCoverage lay_map(const GrayVolume& map, const Points& centroids, std::vector<double>& modulus_kpa) {
  const char* field = "specimen.material.elasticity_map";
  MapCoverage coverage{0.0, std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t t = 0; t < centroids.size(); ++t) {
    const std::optional<double> value = known_at(map, centroids[t]);
    if (!value) continue;
    if (*value < kLeastYoungsModulusKpa || *value > kMostYoungsModulusKpa) {
      const Vec3& p = centroids[t];
      throw CaseError("case", field, fmt::format("{:.4g} at ({:.1f}, {:.1f}, {:.1f}) mm", *value, p.x(), p.y(), p.z()),
                      fmt::format("{} to {} kPa", kLeastYoungsModulusKpa, kMostYoungsModulusKpa));
    }
    modulus_kpa[t] = *value;
    coverage.share += 1.0 / static_cast<double>(centroids.size());
    coverage.least_kpa = std::min(coverage.least_kpa, *value);
    coverage.greatest_kpa = std::max(coverage.greatest_kpa, *value);
  }
  if (coverage.share > 0.0) return coverage;
  throw CaseError("case", field, "a map that is above 0 nowhere in the specimen",
                  "Young's modulus in kPa, in the frame of the scan (LPS, mm)");
}

void lay_tumor(const TriMesh& tumor, double value_kpa, const Points& centroids, std::vector<double>& modulus_kpa) {
  const SurfaceQuery surface(tumor);
  const Vec3 along = Vec3(0.31, 0.53, 0.79).normalized();
  std::size_t inside = 0;
  for (std::size_t t = 0; t < centroids.size(); ++t) {
    if (!surface.contains(centroids[t], along)) continue;
    modulus_kpa[t] = value_kpa;
    ++inside;
  }
  if (inside > 0) return;
  throw CaseError("case", "specimen.material.tumor_modulus_kpa", "a tumor.surface that holds no tetrahedron",
                  "a surface within the tissue at rest",
                  "The surface must be in the frame of the scan (LPS, mm), closed and oriented outwards. A tumour "
                  "smaller than the tetrahedra may hold none: reduce meshing.survey_mm and meshing.coarse_mm");
}

}  // namespace

MaterialSources read_material_sources(const Case& settings, Inputs& inputs, Monitor& monitor) {
  MaterialSources sources;
  if (!settings.variation.labels.empty() || !settings.toughness.labels.empty())
    sources.labels = inputs.read_labels(monitor);
  sources.elasticity_kpa = inputs.read_elasticity_map();
  if (!settings.variation.tumor_modulus_kpa) return sources;
  const char* field = "specimen.material.tumor_modulus_kpa";
  if (settings.tumor_configuration != TumorConfiguration::Rest)
    throw CaseError("case", field, "a tumour that was drawn on the stretched tissue", "tumor.configuration: rest",
                    "The stretch depends on the tumour's stiffness, so the surface at rest must be known first");
  sources.tumor = inputs.read_tumor_surface();
  if (!sources.tumor) throw CaseError("case", field, "no tumor.surface", "the tumour's surface, at rest");
  return sources;
}

std::string digest_of(const MaterialSources& sources) {
  if (!sources.labels && !sources.elasticity_kpa && !sources.tumor) return {};
  std::string digests = sha256_of_text(bytes_of(sources.labels));  // one after the other: each may be large
  digests += sha256_of_text(bytes_of(sources.elasticity_kpa));
  digests += sha256_of_text(bytes_of(sources.tumor));
  return digests;
}

std::optional<MapCoverage> lay_on_mesh(const Case& settings, const MaterialSources& sources, TetMesh& mesh) {
  mesh.cell_data.erase(kLaidModulusArray);
  if (!sources.labels && !sources.elasticity_kpa && !sources.tumor) return std::nullopt;
  const Points centroids = centroids_of(mesh);
  if (sources.labels && !mesh.cell_data.contains(kLabel))
    lay_labels(*sources.labels, settings.segmentation, centroids, mesh);
  if (!sources.elasticity_kpa && !sources.tumor) return std::nullopt;
  std::vector<double> modulus_kpa(centroids.size(), settings.material.youngs_modulus_kpa);
  const auto own = mesh.cell_data.find("youngs_modulus_kpa");
  if (settings.variation.from_mesh && own != mesh.cell_data.end() && own->second.values.size() == centroids.size())
    modulus_kpa = own->second.values;
  std::optional<MapCoverage> coverage;
  if (sources.elasticity_kpa) coverage = lay_map(*sources.elasticity_kpa, centroids, modulus_kpa);
  if (sources.tumor) lay_tumor(*sources.tumor, *settings.variation.tumor_modulus_kpa, centroids, modulus_kpa);
  mesh.cell_data[kLaidModulusArray] = {1, std::move(modulus_kpa)};
  return coverage;
}

Verdict verdict_of_map(const MapCoverage& coverage) {
  constexpr double kLeastShare = 0.5;
  Verdict verdict;
  if (coverage.share >= kLeastShare) return verdict;
  verdict.add(
      "scan", coverage.share,
      fmt::format("the elasticity map is known in only {:.0f} % of the specimen: is it in the frame of the scan "
                  "(LPS, mm)? Elsewhere youngs_modulus_kpa applies",
                  100.0 * coverage.share),
      {}, kLeastShare);
  return verdict;
}

}  // namespace incise
