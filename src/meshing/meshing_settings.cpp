#include <incise/core/expect.hpp>
#include <incise/meshing/mesher.hpp>

#include <fmt/format.h>

namespace incise {

void describe(Visitor& v, MeshingSettings& s) {
  constexpr Range kAngleDeg{0.0, 30.0, true};  // beyond it refinement need not end
  constexpr Range kTolerance{0.0, 0.999, true};
  v("target_tets", s.target_tets, "Number of tets to aim for, by scaling fine and coarse edge lengths alike.", {100.0});
  v("target_tolerance", s.target_tolerance,
    "Relative tolerance of that number; `meets_target` says whether the mesh is within it.", kTolerance);
  v({"facet_angle_deg", "Smallest angle of a surface triangle.", "deg"}, s.facet_angle_deg, kAngleDeg);
  v("facet_size_factor", s.facet_size_factor, "Circumradius of surface triangles over the edge length.", kPositive);
  v("facet_distance_factor", s.facet_distance_factor,
    "Distance of surface triangles from the surface over the smallest edge length.", kPositive);
  v({"facet_distance_floor_mm", "Least value of that distance.", "mm"}, s.facet_distance_floor_mm, kPositive);
  v("radius_edge_ratio", s.radius_edge_ratio, "Circumradius over shortest edge of tets; 2 is the limit in theory.",
    {2.0});
  v("cell_size_factor", s.cell_size_factor, "Circumradius of tets over the edge length.", kPositive);
  v({"sliver_bound_deg", "Dihedral angle that perturbation and exudation aim for.", "deg"}, s.sliver_bound_deg,
    kAngleDeg);
  v({"min_dihedral_deg", "Least dihedral angle for `meets_quality`, at most sliver_bound_deg.", "deg"},
    s.min_dihedral_deg, kNotNegative);
  v("volume_tolerance", s.volume_tolerance, "Greatest relative error of the volume for `meets_volume`.", kTolerance);
  v("max_refinements", s.max_refinements, "Greatest number of refinements tried to meet count and volume.",
    {1.0, 20.0});
  v("max_improvements", s.max_improvements, "Greatest number of perturbed meshes tried to meet the angle.",
    {1.0, 20.0});
  v("max_tets", s.max_tets, "Greatest predicted number of tets; a prediction above it is refused.", {1.0});
}

std::vector<Problem> validate(const MeshingSettings& s) {
  std::vector<Problem> violations = problems_of(s);
  Expect{violations}(s.min_dihedral_deg <= s.sliver_bound_deg, "min_dihedral_deg", s.min_dihedral_deg,
                     fmt::format("at most sliver_bound_deg = {}", s.sliver_bound_deg));
  return violations;
}

}  // namespace incise
