#include <incise/meshing/mesher.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Accepts low < value <= high, low excluded.
void require_above(std::vector<std::string>& violations, const char* name, double value, double low, double high) {
  if (value > low && value <= high && std::isfinite(value)) return;
  const std::string limit = high < kNoLimit ? fmt::format(" and <= {}", high) : std::string();
  violations.push_back(fmt::format("{}: found {}, expected > {}{}", name, value, low, limit));
}

void require_count(std::vector<std::string>& violations, const char* name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  violations.push_back(fmt::format("{}: found {}, expected {} to {}", name, value, low, high));
}

}  // namespace

std::vector<std::string> validate(const MeshingSettings& s) {
  constexpr double kSteepestAngleDeg = 30.0;  // beyond it refinement need not end
  constexpr double kLargestTolerance = 0.999;
  std::vector<std::string> violations;
  if (s.target_tets && *s.target_tets < kFewestTets) {
    violations.push_back(fmt::format("target_tets: found {}, expected at least {}", *s.target_tets, kFewestTets));
  }
  require_above(violations, "target_tolerance", s.target_tolerance, 0.0, kLargestTolerance);
  require_above(violations, "facet_angle_deg", s.facet_angle_deg, 0.0, kSteepestAngleDeg);
  require_above(violations, "facet_size_factor", s.facet_size_factor, 0.0, kNoLimit);
  require_above(violations, "facet_distance_factor", s.facet_distance_factor, 0.0, kNoLimit);
  require_above(violations, "facet_distance_floor_mm", s.facet_distance_floor_mm, 0.0, kNoLimit);
  if (!(s.radius_edge_ratio >= 2.0) || !std::isfinite(s.radius_edge_ratio)) {
    violations.push_back(fmt::format("radius_edge_ratio: found {}, expected >= 2", s.radius_edge_ratio));
  }
  require_above(violations, "cell_size_factor", s.cell_size_factor, 0.0, kNoLimit);
  require_above(violations, "sliver_bound_deg", s.sliver_bound_deg, 0.0, kSteepestAngleDeg);
  if (!(s.min_dihedral_deg >= 0.0 && s.min_dihedral_deg <= s.sliver_bound_deg)) {
    violations.push_back(fmt::format("min_dihedral_deg: found {}, expected 0 to sliver_bound_deg = {}",
                                     s.min_dihedral_deg, s.sliver_bound_deg));
  }
  require_above(violations, "volume_tolerance", s.volume_tolerance, 0.0, kLargestTolerance);
  require_count(violations, "max_refinements", s.max_refinements, 1, 20);
  require_count(violations, "max_improvements", s.max_improvements, 1, 20);
  if (s.max_tets == 0) violations.push_back("max_tets: found 0, expected > 0");
  return violations;
}

}  // namespace incise
