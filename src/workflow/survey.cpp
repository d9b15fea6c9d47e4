#include <incise/core/error.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/workflow/margin_room.hpp>
#include <incise/workflow/study.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

/// Returns the place, in the unstretched body, of a curve on the stretched surface.
Contour carried_to_rest(const Contour& curve, const TetMesh& mesh, std::span<const Vec3> stretched, double tolerance_mm) {
  const TetLocator locator(mesh, stretched);
  Contour rest{{}, curve.is_closed};
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const auto point = locator.locate(curve.points[i], tolerance_mm);
    if (!point) {
      throw CaseError("planned cut", fmt::format("point {}", i), "a place outside the surveyed tissue",
                      "a path on the stretched tissue");
    }
    rest.points.push_back(position_of(*point, mesh, mesh.vertices));
  }
  return rest;
}

std::string_view why_no_equilibrium(Outcome outcome) {
  return outcome == Outcome::ElementInverted ? "somewhere the tissue was turned inside out"
                                             : "no position was found in which the tissue is at rest";
}

void require_equilibrium(const Case& settings, const StaticResult& result, const char* which) {
  if (result.outcome == Outcome::Cancelled) throw Cancelled("the stretch was interrupted and will start over");
  if (result.outcome != Outcome::Success) {
    throw CaseError(
        "case", "specimen.constraints",
        fmt::format("no equilibrium of the {}: {} (after {} iterations)", which, why_no_equilibrium(result.outcome),
                    result.iterations),
        "constraints that the tissue can follow",
        settings.constraints
            ? std::string("Try a smaller displacement or a smaller Poisson's ratio")
            : fmt::format("The case states none, so the default ones hold the body. {}. State constraints: for a "
                          "block that was cut out of a scan, a clamp on the side where it was cut off",
                          default_hold_in_words()));
  }
}

/// Returns the tumour's edge on the stretched skin.
Contour edge_on(const Case& settings, const TissueModel& model, std::span<const Vec3> stretched,
                const SurfaceQuery& surface, Contour edge) {
  if (settings.tumor_configuration == TumorConfiguration::Rest) {
    const SurfaceQuery at_rest(skin_of(model.mesh, model.mesh.vertices));
    edge = project_tumor_edge(edge, at_rest, settings.plan.approach, settings.surface_tolerance_mm);
    const TetLocator locator(model.mesh, model.mesh.vertices);
    for (Vec3& p : edge.points) {
      const auto point = locator.locate(p, 1.0);
      INCISE_REQUIRE(point.has_value(), "a point projected on the skin lies outside every tet");
      p = position_of(*point, model.mesh, stretched);
    }
  }
  return project_tumor_edge(edge, surface, settings.plan.approach, settings.surface_tolerance_mm);
}

/// Adds to the refusal of a margin the greatest one that fits.
CaseError with_room(const CaseError& error, const MarginRoom& room) {
  Problem problem = error.problem();
  problem.hint = fmt::format("{}. {}", in_words(room), problem.hint);
  return {"plan", std::move(problem)};
}

}  // namespace

TissueModel tissue_of(const Case& settings, TetMesh mesh) {
  std::vector<Constraint> constraints = settings.constraints ? *settings.constraints : default_constraints(mesh);
  MaterialField field = material_field(mesh, settings.material, settings.variation);
  field.toughness = toughness_of(mesh, settings.toughness);
  return make_tissue_model(std::move(mesh), settings.material, std::move(constraints), settings.gravity_mm_s2, field);
}

StaticResult stretch(const TissueModel& model, Workers& workers, Monitor& monitor) {
  StaticResult result = solve_static(model, StaticSettings{}, workers, monitor);
  // The rotations are only a warm start. From the identity, a state read from a file is the same as a fresh one.
  result.state.rotations.assign(model.mesh.tets.size(), Mat3::Identity());
  return result;
}

MeshProduct mesh_around_planned_cut(const Case& settings, const GrayVolume& occupancy,
                                    const std::optional<Contour>& tumor_edge, const std::optional<Contour>& line,
                                    Workers& workers, Monitor& monitor, const MadeSkin& made_skin,
                                    const MaterialSources& sources) {
  // The cut is planned on the stretched tissue, but the mesh is of the unstretched body: a coarse mesh is stretched
  // first to find the planned cut at rest.
  SizingSettings sizing = default_lengths(longest_side_mm(occupancy));
  const double survey_mm = settings.meshing.survey_mm.value_or(sizing.coarse_mm);
  sizing.fine_mm = settings.meshing.fine_mm.value_or(sizing.fine_mm);
  sizing.coarse_mm = settings.meshing.coarse_mm.value_or(sizing.coarse_mm);
  if (sizing.fine_mm > sizing.coarse_mm) {
    throw CaseError("case", "meshing.fine_mm", fmt::format("{:.3g} mm", sizing.fine_mm),
                    fmt::format("at most coarse_mm, {:.3g} mm for a body of this size", sizing.coarse_mm));
  }
  MeshingResult survey = mesh_labels(occupancy, SizingField::uniform(survey_mm), MeshingSettings{}, monitor);
  lay_on_mesh(settings, sources, survey.mesh);
  const TissueModel coarse = tissue_of(settings, std::move(survey.mesh));
  const StaticResult stretched = stretch(coarse, workers, monitor);
  require_equilibrium(settings, stretched, "coarse survey mesh");
  const ToolPath plan = plan_on(settings, coarse, stretched.state.positions, tumor_edge, line, made_skin);

  MeshProduct product;
  product.planned_cut_rest =
      carried_to_rest(entry_contour(plan), coarse.mesh, stretched.state.positions, settings.surface_tolerance_mm);
  MeshingSettings meshing;
  if (settings.meshing.tets > 0) meshing.target_tets = settings.meshing.tets;
  product.meshing = mesh_labels(
      occupancy, SizingField::around_cut({product.planned_cut_rest, settings.plan.approach, settings.plan.depth_mm}, sizing), meshing,
      monitor);
  return product;
}

ToolPath plan_on(const Case& settings, const TissueModel& model, std::span<const Vec3> stretched,
                 const std::optional<Contour>& tumor_edge, const std::optional<Contour>& line,
                 const MadeSkin& made_skin) {
  const SurfaceQuery surface(skin_of(model.mesh, stretched));
  if (settings.plan.kind == PlanKind::Line) {
    INCISE_REQUIRE(line.has_value(), "expected the curve of the open cut");
    ToolPath path = plan_line(
        surface, project_line(*line, surface, settings.plan.approach, settings.surface_tolerance_mm), settings.plan);
    if (tumor_edge) path.tumor_edge = edge_on(settings, model, stretched, surface, *tumor_edge);
    return path;
  }
  INCISE_REQUIRE(tumor_edge.has_value(), "expected a tumour edge");
  const Contour edge = edge_on(settings, model, stretched, surface, *tumor_edge);
  try {
    return plan_ring(surface, edge, settings.plan);
  } catch (const CaseError& error) {
    if (error.field() != "lateral_margin_mm") throw;
    const PlacedSkin skin(boundary_surface(model.mesh), stretched, made_skin);
    throw with_room(error, margin_room(skin, edge, settings.plan, radius_mm(settings.tool)));
  }
}

}  // namespace incise
