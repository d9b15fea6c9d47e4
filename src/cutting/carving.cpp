#include "contact.hpp"
#include "fragments.hpp"

#include <incise/core/error.hpp>
#include <incise/cutting/carving.hpp>
#include <incise/mechanics/step_stiffness.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

constexpr int kVerticesPerAggregate = 140;
constexpr double kForceFloorMn = 5.0;          // scale of the stopping test when hardly anything is held
constexpr double kLeastShare = 0.02;           // of a touched tet's volume that the tool holds: a corner is still held
constexpr double kFragmentShare = 0.01;        // of the body's volume at rest: smaller loose parts are cut away with the kerf
constexpr int kMomentsPerStep = 4;             // intervals in which the distance to the tool is followed within a step

}  // namespace

struct CutWorkspace::Data {
  std::vector<std::array<std::int32_t, 4>> neighbours;
  std::vector<std::uint8_t> is_anchored;   // vertices that a constraint holds
  StepStiffness stiffness;
  TwoLevelPcg solver;
  Points right_side;
  Points increment;
  Points before;
  double body_volume_mm3 = 0.0;            // at rest, uncut
  int next_step = -1;                      // the one that may build on what is kept here
  std::vector<std::uint8_t> is_orphan;     // vertices without a live tet: nothing holds them, so they stay where they are
  std::size_t carved_then = 0;             // tets carved when that was found

  Data(const TissueModel& model, std::span<const Vec3> positions, Precision precision)
      : neighbours(face_neighbours(model.mesh)),
        is_anchored(model.mesh.vertices.size(), 0),
        stiffness(model),
        solver(model.pattern, positions, kVerticesPerAggregate, precision),
        right_side(model.mesh.vertices.size()),
        increment(model.mesh.vertices.size()),
        body_volume_mm3(std::accumulate(model.volumes_mm3.begin(), model.volumes_mm3.end(), 0.0)) {
    for (std::size_t v = 0; v < is_anchored.size(); ++v) {
      const auto& fixed = model.is_fixed[v];
      is_anchored[v] = fixed[0] || fixed[1] || fixed[2] ? 1 : 0;
    }
  }
};

CutWorkspace::CutWorkspace(const TissueModel& model, std::span<const Vec3> positions, Precision precision)
    : data_(std::make_unique<Data>(model, positions, precision)) {}
CutWorkspace::~CutWorkspace() = default;
CutWorkspace::CutWorkspace(CutWorkspace&&) noexcept = default;

CutState begin_cut(const TissueModel& model, TissueState stretched, const ToolPose& tool) {
  CutState state;
  state.contact_s.assign(model.mesh.tets.size(), 0.0);
  state.tissue = std::move(stretched);
  state.tool = tool;
  return state;
}

namespace {

Vec3 shaft_end(const ToolPose& tool, const Needle& needle) { return tool.tip_mm - needle.length_mm * tool.axis; }

Vec3 centroid(const std::array<Vec3, 4>& corners) { return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]); }

/// Norm over all vertices of what each is given in all, mN.
double norm_of_sums(std::vector<std::pair<VertexId, Vec3>> pulls) {
  std::stable_sort(pulls.begin(), pulls.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  double squared = 0.0;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    sum += pulls[i].second;
    if (i + 1 < pulls.size() && pulls[i + 1].first == pulls[i].first) continue;
    squared += sum.squaredNorm();
    sum.setZero();
  }
  return std::sqrt(squared);
}

/// Adds the pull of the tool on bonded tets, as if it were at `next` already, and its exact (constant) tangent.
/// The share of a tet that is held is that of the last pose, so the pull is linear in the step.
/// @returns the stiffness of each bond, mN/mm, in their order; `scale` receives the norm of the pulls over all vertices, mN.
std::vector<double> add_bonds(const TissueModel& model, const CutSettings& settings, const Needle& needle, const CutState& state,
               const ToolPose& next, std::span<Vec3> forces, BlockMatrix& matrix, double& scale) {
  std::vector<double> stiffnesses;
  std::vector<std::pair<VertexId, Vec3>> pulls;  // on vertices, one entry per tet that shares the vertex
  const double limit = needle.radius_mm() + settings.reach_mm;
  // Drag acts across the needle's axis; tissue may slide along it.
  const Mat3 across = Mat3::Identity() - next.axis * next.axis.transpose();
  for (const Bond& bond : state.bonds) {
    const auto corners = corners_of(model.mesh, state.tissue.positions, bond.tet.index());
    const double share = share_within(corners, state.tool.tip_mm, shaft_end(state.tool, needle), limit);
    const double stiffness = settings.bond_stiffness_kpa_mm2 * model.volumes_mm3[bond.tet.index()] * std::max(share, kLeastShare);
    const Vec3 pull = -stiffness * (across * (centroid(corners) - next.tip_mm - bond.offset_mm));
    stiffnesses.push_back(stiffness);
    const Mat3 block = stiffness / 16.0 * across;
    for (std::size_t a = 0; a < 4; ++a) {
      const VertexId v = model.mesh.tets[bond.tet.index()][a];
      forces[v.index()] += 0.25 * pull;
      pulls.emplace_back(v, 0.25 * pull);
      for (std::size_t b = 0; b < 4; ++b) {
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
            matrix.block(model.tet_slots[bond.tet.index()][4 * a + b])) += block;
      }
    }
  }
  scale = norm_of_sums(std::move(pulls));
  return stiffnesses;
}

/// What the held tissue, where it came to lie, does to the tool, mN.
Vec3 force_on_tool(const TissueModel& model, const CutState& state, const ToolPose& tool, std::span<const double> stiffnesses) {
  const Mat3 across = Mat3::Identity() - tool.axis * tool.axis.transpose();
  Vec3 force = Vec3::Zero();
  for (std::size_t b = 0; b < state.bonds.size(); ++b) {
    const Bond& bond = state.bonds[b];
    const Vec3 middle = centroid(corners_of(model.mesh, state.tissue.positions, bond.tet.index()));
    force += stiffnesses[b] * (across * (middle - tool.tip_mm - bond.offset_mm));
  }
  return force;
}

void find_orphans(const TissueModel& model, const TissueState& tissue, std::vector<std::uint8_t>& is_orphan) {
  is_orphan.assign(model.mesh.vertices.size(), 1);
  for (std::size_t tet = 0; tet < model.mesh.tets.size(); ++tet) {
    if (tissue.is_live[tet] == 0) continue;
    for (const VertexId v : model.mesh.tets[tet]) is_orphan[v.index()] = 0;
  }
}

/// Moves the tissue by one linearised quasi-static step. The mass term is far below the stiffness and only steadies loose bits.
void move_tissue(const TissueModel& model, const CutSettings& settings, const Needle& needle, CutState& state,
                 CutWorkspace::Data& scratch, const std::optional<ToolPose>& next, double step_s, Workers& workers,
                 CutStepReport& report) {
  const bool is_fresh = state.step % kFreshSteps == 0 || state.step != scratch.next_step;
  scratch.next_step = state.step + 1;
  std::copy(model.dead_load_mn.begin(), model.dead_load_mn.end(), scratch.right_side.begin());
  scratch.stiffness.begin(model, state.tissue, step_s, is_fresh, scratch.right_side, workers);
  double bond_scale = 0.0;
  std::vector<double> stiffnesses;
  if (next) {
    for (const Bond& bond : state.bonds) scratch.stiffness.lend(model, bond.tet);
    stiffnesses = add_bonds(model, settings, needle, state, *next, scratch.right_side, scratch.stiffness.matrix(), bond_scale);
  }
  if (is_fresh || state.record.removals.size() != scratch.carved_then) {
    find_orphans(model, state.tissue, scratch.is_orphan);
    scratch.carved_then = state.record.removals.size();
  }
  scratch.stiffness.hold(model, scratch.right_side, scratch.is_orphan, workers);
  scratch.solver.update(scratch.stiffness.matrix(), is_fresh, workers, scratch.stiffness.changed_rows());
  PcgSettings pcg;
  pcg.relative_tolerance = settings.residual_tolerance;
  pcg.reference_mn = std::max(bond_scale, kForceFloorMn);
  report.solve = scratch.solver.solve(scratch.stiffness.matrix(), scratch.right_side, scratch.increment, pcg, workers);

  for (std::size_t v = 0; v < scratch.increment.size(); ++v) {
    Vec3& step = scratch.increment[v];
    const double length = step.norm();
    if (!std::isfinite(length)) report.is_finite = false;
    if (length > settings.max_step_mm) {
      step *= settings.max_step_mm / length;
      ++report.held_back_vertices;
    }
    report.max_step_mm = std::max(report.max_step_mm, std::min(length, settings.max_step_mm));
  }
  if (!report.is_finite) return;
  for (std::size_t v = 0; v < scratch.increment.size(); ++v) state.tissue.positions[v] += scratch.increment[v];
  if (next) report.tool_force_mn = force_on_tool(model, state, *next, stiffnesses);
}

/// Follows the contact of the tissue with the tool through the step: adds contact time, makes bonds where contact begins and drops
/// them where it ends.
void follow_contact(const TissueModel& model, const CutSettings& settings, const Needle& needle, CutState& state,
                    std::span<const Vec3> before, const ToolPose& next, double step_s, Workers& workers,
                    CutStepReport& report) {
  const double limit = needle.radius_mm() + settings.reach_mm;
  const std::vector<TetId> candidates = contact_candidates(model, state.tissue.is_live, before, state.tissue.positions, state.tool,
                                                           next, needle, limit, workers);
  struct Contact {
    ContactInterval interval;
    bool at_end = false;
    Vec3 offset_mm = Vec3::Zero();
  };
  std::vector<Contact> contacts(candidates.size());
  workers.for_each(candidates.size(), 64, [&](std::size_t c) {
    const std::size_t tet = candidates[c].index();
    const auto from = corners_of(model.mesh, before, tet);
    const auto to = corners_of(model.mesh, state.tissue.positions, tet);
    const auto at = [&](double t) {
      std::array<Vec3, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) corners[i] = from[i] + t * (to[i] - from[i]);
      return corners;
    };
    std::array<double, kMomentsPerStep + 1> distances{};
    for (int m = 0; m <= kMomentsPerStep; ++m) {
      const double t = static_cast<double>(m) / kMomentsPerStep;
      const ToolPose tool = between(state.tool, next, t);
      distances[static_cast<std::size_t>(m)] = distance_to_segment(at(t), tool.tip_mm, shaft_end(tool, needle));
    }
    Contact& contact = contacts[c];
    contact.interval = contact_interval(distances, limit);
    contact.at_end = distances.back() <= limit;
    contact.offset_mm =
        centroid(at(contact.interval.first)) - between(state.tool, next, contact.interval.first).tip_mm;
  });

  std::vector<Bond> bonds;
  auto held = state.bonds.begin();
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Contact& contact = contacts[c];
    if (contact.interval.fraction > 0.0) {
      state.contact_s[candidates[c].index()] += contact.interval.fraction * step_s;
      ++report.tets_in_contact;
    }
    held = std::lower_bound(held, state.bonds.end(), candidates[c],
                            [](const Bond& bond, TetId tet) { return bond.tet < tet; });
    if (!contact.at_end) continue;
    const bool was_held = held != state.bonds.end() && held->tet == candidates[c];
    bonds.push_back(was_held ? *held : Bond{candidates[c], contact.offset_mm});
  }
  state.bonds = std::move(bonds);
}

void remove(const TissueModel& model, CutState& state, TetId tet, RemovalCause cause) {
  state.tissue.is_live[tet.index()] = 0;
  state.record.removals.push_back({tet, state.step, state.time_s, cause,
                                   centroid(corners_of(model.mesh, state.tissue.positions, tet.index())),
                                   model.volumes_mm3[tet.index()]});
}

/// Removes the tets whose time is up, then what is left hanging by no face.
void carve(const TissueModel& model, const CutSettings& settings, CutState& state, const CutWorkspace::Data& scratch,
           CutStepReport& report) {
  const double dwell = settings.dwell_s();
  std::vector<TetId> due;
  for (std::size_t tet = 0; tet < state.contact_s.size(); ++tet) {
    if (state.tissue.is_live[tet] != 0 && state.contact_s[tet] >= dwell) due.emplace_back(tet);
  }
  if (due.empty()) return;
  for (const TetId tet : due) remove(model, state, tet, RemovalCause::Dwell);
  const std::vector<TetId> loose =
      loose_fragments(model.mesh, model.volumes_mm3, scratch.neighbours, state.tissue.is_live, scratch.is_anchored, due,
                      kFragmentShare * scratch.body_volume_mm3);
  for (const TetId tet : loose) remove(model, state, tet, RemovalCause::LooseFragment);
  std::erase_if(state.bonds, [&](const Bond& bond) { return state.tissue.is_live[bond.tet.index()] == 0; });
  report.removed = due.size();
  report.loose_removed = loose.size();
}

}  // namespace

CutStepReport advance(const TissueModel& model, const CutSettings& settings, const Needle& needle, CutState& state,
                      CutWorkspace& workspace, const std::optional<ToolPose>& next, double step_s, Workers& workers) {
  INCISE_REQUIRE(step_s > 0.0 && std::isfinite(step_s), "expected a step above 0 s");
  CutWorkspace::Data& scratch = workspace.data();
  CutStepReport report;
  scratch.before = state.tissue.positions;
  if (!next) {
    state.bonds.clear();
  } else if (next->axis != state.tool.axis) {
    // What the tool holds turns with it.
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(state.tool.axis, next->axis);
    for (Bond& bond : state.bonds) bond.offset_mm = turn * bond.offset_mm;
  }
  move_tissue(model, settings, needle, state, scratch, next, step_s, workers, report);
  state.time_s += step_s;
  ++state.step;
  if (!next || !report.is_finite) return report;
  follow_contact(model, settings, needle, state, scratch.before, *next, step_s, workers, report);
  state.tool = *next;
  carve(model, settings, state, scratch, report);
  return report;
}

}  // namespace incise
