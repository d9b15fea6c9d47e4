#include <incise/core/expect.hpp>
#include <incise/meshing/mesher.hpp>

#include <fmt/format.h>

namespace incise {

void describe(Visitor& v, MeshingSettings& s) {
  constexpr Range kAngleDeg{0.0, 30.0, true};  // beyond it refinement need not end
  constexpr Range kTolerance{0.0, 0.999, true};
  v("target_tets", s.target_tets, "Count to aim for, by scaling fine and coarse edge lengths alike.", {100.0});
  v("target_tolerance", s.target_tolerance, "Relative; `meets_target` says whether the count is this near.",
    kTolerance);
  v({"facet_angle_deg", "Smallest angle of a surface triangle.", "deg"}, s.facet_angle_deg, kAngleDeg);
  v("facet_size_factor", s.facet_size_factor, "Circumradius of surface triangles over the edge length.", kPositive);
  v("facet_distance_factor", s.facet_distance_factor,
    "Distance of surface triangles from the surface over the smallest edge length.", kPositive);
  v({"facet_distance_floor_mm", "That distance is never asked to be below this.", "mm"}, s.facet_distance_floor_mm,
    kPositive);
  v("radius_edge_ratio", s.radius_edge_ratio, "Circumradius over shortest edge of tets; 2 is theory's limit.", {2.0});
  v("cell_size_factor", s.cell_size_factor, "Circumradius of tets over the edge length.", kPositive);
  v({"sliver_bound_deg", "Dihedral angle that perturbation and exudation work towards.", "deg"}, s.sliver_bound_deg,
    kAngleDeg);
  v({"min_dihedral_deg", "What `meets_quality` demands, at most sliver_bound_deg.", "deg"}, s.min_dihedral_deg,
    kNotNegative);
  v("volume_tolerance", s.volume_tolerance, "Relative; what `meets_volume` demands.", kTolerance);
  v("max_refinements", s.max_refinements, "Tried to meet count and volume.", {1.0, 20.0});
  v("max_improvements", s.max_improvements, "Perturbed meshes tried to meet the angle.", {1.0, 20.0});
  v("max_tets", s.max_tets, "A prediction above this is refused.", {1.0});
}

std::vector<Problem> validate(const MeshingSettings& s) {
  std::vector<Problem> violations = problems_of(s);
  Expect{violations}(s.min_dihedral_deg <= s.sliver_bound_deg, "min_dihedral_deg", s.min_dihedral_deg,
                     fmt::format("at most sliver_bound_deg = {}", s.sliver_bound_deg));
  return violations;
}

}  // namespace incise
