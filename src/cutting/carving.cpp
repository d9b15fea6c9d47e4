#include "bond_stiffness.hpp"
#include "contact.hpp"
#include "fragments.hpp"
#include "parting.hpp"
#include "point_rule.hpp"

#include <incise/core/error.hpp>
#include <incise/cutting/carving.hpp>
#include <incise/mechanics/step_stiffness.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace incise {
namespace {

constexpr int kRenewalSteps =
    20;  // greatest age of everything that a workspace carries over, such as the preconditioner's coarse matrix
constexpr int kVerticesPerAggregate = 140;
constexpr double kForceFloorMn = 5.0;    // scale of the stopping test when hardly anything is held
constexpr double kLeastShare = 0.02;     // of a touched tet's volume that the tool holds: a corner is still held
constexpr double kFragmentShare = 0.01;  // of the body's volume at rest: smaller loose parts are cut away with the kerf
constexpr int kIntervalsPerStep = 4;     // at whose ends the distance to the tool is sampled in a step
constexpr double kLeastDecrease =
    1e-4;                         // of the energy on the way to rest, as a share of the predicted decrease (Armijo)
constexpr int kMaxHalvings = 12;  // of such a step
constexpr double kSplittingMm = 2.7;      // greatest travel of the tool between two splits
constexpr double kFullDose = 1.0 - 1e-9;  // 1, less the rounding of a sum over steps

}  // namespace

struct CutWorkspace::Data {
  std::unique_ptr<const TissueModel> split;  // on the split mesh; null: the mesh is whole
  std::shared_ptr<const FaceAdjacency> whole_neighbours;
  FaceAdjacency split_neighbours;         // empty: the mesh is whole
  std::vector<double> rest_volumes_mm3;   // per tet: its part of the whole tet's
  std::vector<std::uint8_t> is_anchored;  // vertices that a constraint holds
  StepStiffness stiffness;
  TwoLevelPcg solver;
  Points right_side;
  Points increment;
  Points before;
  Points left;                          // positions after the last step
  double body_volume_mm3 = 0.0;         // at rest, uncut
  int next_step = -1;                   // the step that may reuse what is kept here
  std::vector<std::uint8_t> is_orphan;  // vertices without a live tet: nothing holds them, so they keep their positions
  std::size_t carved_then = 0;          // number of removed tets when is_orphan was found
  std::optional<PointLattice> lattice;  // of a cut by points
  std::vector<std::uint8_t> every_tet;  // 1 each
  NearTets near;

  Data(const TissueModel& model, const MeshSplits& splits, std::span<const Vec3> positions, Precision precision,
       std::shared_ptr<const FaceAdjacency> of_whole)
      : whole_neighbours(std::move(of_whole)),
        split_neighbours(splits == MeshSplits{} ? FaceAdjacency{}
                                                : split_adjacency(model.mesh, splits, *whole_neighbours)),
        rest_volumes_mm3(model.mesh.tets.size()),
        is_anchored(model.mesh.vertices.size(), 0),
        stiffness(model),
        solver(model.pattern, positions, kVerticesPerAggregate, precision),
        right_side(model.mesh.vertices.size()),
        increment(model.mesh.vertices.size()) {
    for (std::size_t t = 0; t < rest_volumes_mm3.size(); ++t)
      rest_volumes_mm3[t] = rest_volume_mm3(model, splits, TetId(t));
    body_volume_mm3 = std::accumulate(rest_volumes_mm3.begin(), rest_volumes_mm3.end(), 0.0);
    for (std::size_t v = 0; v < is_anchored.size(); ++v) {
      const auto& fixed = model.is_fixed[v];
      is_anchored[v] = fixed[0] || fixed[1] || fixed[2] ? 1 : 0;
    }
  }
  [[nodiscard]] const FaceAdjacency& neighbours() const {
    return split_neighbours.start.empty() ? *whole_neighbours : split_neighbours;
  }
};

CutWorkspace::CutWorkspace(const TissueModel& model, std::span<const Vec3> positions, Precision precision)
    : data_(std::make_unique<Data>(model, MeshSplits{}, positions, precision,
                                   std::make_shared<const FaceAdjacency>(face_adjacency(model.mesh)))),
      positions_(positions.begin(), positions.end()),
      precision_(precision) {}
CutWorkspace::~CutWorkspace() = default;
CutWorkspace::CutWorkspace(CutWorkspace&&) noexcept = default;

const TissueModel& CutWorkspace::model_for(const TissueModel& whole, const MeshSplits& splits) {
  if (splits != splits_) {
    std::unique_ptr<const TissueModel> split;
    if (splits != MeshSplits{}) split = std::make_unique<const TissueModel>(split_model(whole, splits));
    const TissueModel& model = split ? *split : whole;
    const std::shared_ptr<const FaceAdjacency> neighbours = data_->whole_neighbours;
    data_.reset();  // it is large
    data_ = std::make_unique<Data>(model, splits, split_positions(positions_, splits), precision_, neighbours);
    data_->split = std::move(split);
    splits_ = splits;
  }
  return data_->split ? *data_->split : whole;
}

CutState begin_cut(const TissueModel& model, TissueState stretched, const ToolPose& tool) {
  CutState state;
  state.dose.assign(model.mesh.tets.size(), 0.0);
  state.tear_dose.assign(model.mesh.tets.size(), 0.0);
  state.tissue = std::move(stretched);
  state.tool = tool;
  return state;
}

bool is_renewal_step(const CutState& state) {
  return state.step % kRenewalSteps == 0;
}

namespace {

/// The contact criterion: a tet is touched while its distance from the tool's core is at most this, mm.
double touching_distance_mm(const Tool& tool, const CutSettings& settings) {
  return radius_mm(tool) + settings.reach_mm;
}

Vec3 centroid(const std::array<Vec3, 4>& corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

/// Corners on their straight ways from one place to another, at a fraction t of the way.
std::array<Vec3, 4> on_the_way(const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to, double t) {
  std::array<Vec3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = from[i] + t * (to[i] - from[i]);
  return corners;
}

/// Root mean square of the edge lengths.
double mean_edge_mm(const std::array<Vec3, 4>& corners) {
  double squares = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) squares += (corners[a] - corners[b]).squaredNorm();
  }
  return std::sqrt(squares / 6.0);
}

/// Sums the pulls on each vertex and returns the norm over all vertices, mN.
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

/// Adds the pull of the tool on bonded tets and its exact (constant) tangent. The tool pulls from its pose at the last
/// contact search, so bonds and holding places belong to one moment. From `next` it would pull tissue that it has
/// released on the way there, and the drag would grow with the step (docs/models/cutting.md). The held share of a tet
/// is also that at the last pose, so the pull is linear in the step.
/// @param scale  receives the norm of the pulls over all vertices, mN.
/// @returns the stiffness of each bond, mN/mm, in the order of state.bonds.
std::vector<double> add_bonds(const TissueModel& model, const CutSettings& settings, const Tool& tool,
                              const CutState& state, std::span<Vec3> forces, BlockMatrix& matrix, double& scale) {
  std::vector<double> stiffnesses;
  std::vector<std::pair<VertexId, Vec3>> pulls;  // on vertices, one entry per tet that shares the vertex
  const double limit = touching_distance_mm(tool, settings);
  const ToolCore core(tool, state.tool);
  const Mat3 held = held_directions(tool, state.tool);
  // The resistance of the tissue beneath it, over the duration of a hold, limits the hold.
  const double stiffer = shear_ratio(model.material, settings.tissue_s(1.0 / settings.dwell_rate_per_s()));
  for (const Bond& bond : state.bonds) {
    const auto corners = corners_of(state.tissue.positions, model.mesh.tets[bond.tet.index()]);
    const double share = share_within(corners, core, limit);
    const double edge_mm = mean_edge_mm(corners_of(model.mesh.vertices, model.mesh.tets[bond.tet.index()]));
    const double stiffness = resolved_bond_stiffness(settings.bond_stiffness_kpa_mm2,
                                                     stiffer * model.lame[bond.tet.index()].mu_kpa, edge_mm) *
                             model.volumes_mm3[bond.tet.index()] * std::max(share, kLeastShare);
    const Vec3 pull = -stiffness * (held * (centroid(corners) - state.tool.tip_mm - bond.offset_mm));
    stiffnesses.push_back(stiffness);
    const Mat3 block = stiffness / 16.0 * held;
    for (std::size_t a = 0; a < 4; ++a) {
      const VertexId v = model.mesh.tets[bond.tet.index()][a];
      forces[v.index()] += 0.25 * pull;
      pulls.emplace_back(v, 0.25 * pull);
      for (std::size_t b = 0; b < 4; ++b) matrix.at(model.tet_slots[bond.tet.index()][4 * a + b]) += block;
    }
  }
  scale = norm_of_sums(std::move(pulls));
  return stiffnesses;
}

/// Adds the pull of the tool on the points near it, and its exact (constant) tangent.
/// @returns the norm of the pulls over all vertices, mN.
double add_hold(const TissueModel& model, const PointHold& hold, std::span<Vec3> forces, BlockMatrix& matrix) {
  std::vector<std::pair<VertexId, Vec3>> pulls;
  for (const HeldTet& held : hold.tets) {
    for (std::size_t a = 0; a < 4; ++a) {
      const VertexId v = model.mesh.tets[held.tet.index()][a];
      forces[v.index()] += held.pull_mn[a];
      pulls.emplace_back(v, held.pull_mn[a]);
      for (std::size_t b = 0; b < 4; ++b)
        matrix.at(model.tet_slots[held.tet.index()][4 * a + b]) += held.stiffness_mn_mm[4 * a + b] * hold.directions;
    }
  }
  return norm_of_sums(std::move(pulls));
}

/// Lets tissue slip that is too far behind its holding place: shifts the holding place back.
void slip(const TissueModel& model, const Tool& tool, double slip_mm, CutState& state, CutStepReport& report) {
  const Mat3 held = held_directions(tool, state.tool);
  for (Bond& bond : state.bonds) {
    const Vec3 middle = centroid(corners_of(state.tissue.positions, model.mesh.tets[bond.tet.index()]));
    const Vec3 behind = held * (middle - state.tool.tip_mm - bond.offset_mm);
    const double distance = behind.norm();
    if (distance <= slip_mm) continue;
    bond.offset_mm += (1.0 - slip_mm / distance) * behind;
    ++report.slipped;
  }
}

/// Adds the force (mN) and the torque about the tip (mN mm) of the held tissue, at its new positions, on the tool to
/// `report`.
/// @returns for each bond the tool's work on its tet in this step per rest volume, kPa: from this pull and the way of
///          the holding place to `next`; 0 if the tet did work on the tool.
std::vector<double> load_tool(const TissueModel& model, const CutState& state, const Tool& tool, const ToolPose& next,
                              std::span<const double> stiffnesses, CutStepReport& report) {
  const Mat3 held = held_directions(tool, state.tool);
  const Eigen::Quaterniond turn = turn_of_held(tool, state.tool, next);
  std::vector<double> works_kpa;
  for (std::size_t b = 0; b < state.bonds.size(); ++b) {
    const Bond& bond = state.bonds[b];
    const Vec3 middle = centroid(corners_of(state.tissue.positions, model.mesh.tets[bond.tet.index()]));
    const Vec3 force = stiffnesses[b] * (held * (middle - state.tool.tip_mm - bond.offset_mm));
    report.tool_force_mn += force;
    report.tool_torque_mn_mm += (middle - state.tool.tip_mm).cross(force);
    const Vec3 way = next.tip_mm - state.tool.tip_mm + turn * bond.offset_mm - bond.offset_mm;
    works_kpa.push_back(std::max(0.0, -force.dot(way)) / model.volumes_mm3[bond.tet.index()]);
  }
  return works_kpa;
}

/// Updates scratch.is_orphan: at the vertices of tets removed since the last call; in the first call, at all vertices.
void find_orphans(const TissueModel& model, const CutState& state, CutWorkspace::Data& scratch) {
  const auto has_live_tet = [&](std::size_t v) {
    return std::ranges::any_of(model.corners_at(v), [&](std::int32_t place) {
      return state.tissue.is_live[static_cast<std::size_t>(place / 4)] != 0;
    });
  };
  if (scratch.is_orphan.empty()) {
    scratch.is_orphan.resize(model.mesh.vertices.size());
    for (std::size_t v = 0; v < scratch.is_orphan.size(); ++v) scratch.is_orphan[v] = has_live_tet(v) ? 0 : 1;
  } else {
    for (std::size_t i = scratch.carved_then; i < state.record.removals.size(); ++i) {
      for (const VertexId v : model.mesh.tets[state.record.removals[i].tet.index()])
        scratch.is_orphan[v.index()] = has_live_tet(v.index()) ? 0 : 1;
    }
  }
  scratch.carved_then = state.record.removals.size();
}

/// The energy that the tissue minimises once the tool is out, µJ.
double potential_energy_uj(const TissueModel& model, const TissueState& tissue) {
  double work_uj = 0.0;
  for (std::size_t v = 0; v < model.dead_load_mn.size(); ++v) work_uj += model.dead_load_mn[v].dot(tissue.positions[v]);
  return elastic_energy_uj(model, tissue) + support_energy_uj(model, tissue) - work_uj;
}

/// Halves a step towards rest until it lowers the energy, and takes it. Without this, crushed tets would push each
/// other back and forth for ever.
/// @param pull_mn  unbalanced force at the beginning of the step.
/// @returns the share of the step that was taken; 0: none lowers the energy.
double take_lowering_share(const TissueModel& model, std::span<const Vec3> pull_mn, std::span<const Vec3> increment,
                           TissueState& tissue) {
  const std::vector<Vec3> start = tissue.positions;
  const double before_uj = potential_energy_uj(model, tissue);
  double promised_uj = 0.0;
  for (std::size_t v = 0; v < increment.size(); ++v) promised_uj += pull_mn[v].dot(increment[v]);
  double share = 1.0;
  for (int halving = 0; halving <= kMaxHalvings; ++halving, share *= 0.5) {
    for (std::size_t v = 0; v < increment.size(); ++v) tissue.positions[v] = start[v] + share * increment[v];
    if (potential_energy_uj(model, tissue) <= before_uj - kLeastDecrease * share * promised_uj) return share;
  }
  tissue.positions = start;
  return 0.0;
}

/// Time in the mass term (mass over time squared) that steadies loose bits. It is constant: with the step's own time
/// the term would be a resistance that grows with the tool's speed, and without bound in short steps.
constexpr double kSteadyingS = 0.02;

/// Moves the tissue by one linearised quasi-static step. `step_s` matters only for viscous tissue. Without `next` (the
/// tool is out), viscous tissue counts as relaxed.
/// @returns the stiffness of each bond, mN/mm, in the order of state.bonds; empty with `hold`, or without `next`.
std::vector<double> move_tissue(const TissueModel& model, const CutSettings& settings, const Tool& tool,
                                CutState& state, CutWorkspace::Data& scratch, const std::optional<ToolPose>& next,
                                const PointHold* hold, double step_s, Workers& workers, CutStepReport& report) {
  const bool is_fresh = is_renewal_step(state) || state.step != scratch.next_step;
  scratch.next_step = state.step + 1;
  std::copy(model.dead_load_mn.begin(), model.dead_load_mn.end(), scratch.right_side.begin());
  // On the way to rest the tangent must include the rotation of tets. With frozen rotations, a flap under tension
  // overshoots by more than its error and swings for ever.
  const Tangent tangent = next ? Tangent::FrozenRotations : Tangent::Projected;
  const std::optional<double> viscous_s = next ? std::optional(settings.tissue_s(step_s)) : std::nullopt;
  scratch.stiffness.begin(model, state.tissue, kSteadyingS, is_fresh, tangent, scratch.right_side, workers, viscous_s);
  double bond_scale = 0.0;
  std::vector<double> stiffnesses;
  if (hold != nullptr) {
    for (const HeldTet& held : hold->tets) scratch.stiffness.lend(model, held.tet);
    bond_scale = add_hold(model, *hold, scratch.right_side, scratch.stiffness.matrix());
  } else if (next) {
    for (const Bond& bond : state.bonds) scratch.stiffness.lend(model, bond.tet);
    stiffnesses = add_bonds(model, settings, tool, state, scratch.right_side, scratch.stiffness.matrix(), bond_scale);
  }
  find_orphans(model, state, scratch);
  scratch.stiffness.hold(model, scratch.right_side, scratch.is_orphan, workers);
  scratch.solver.update(scratch.stiffness.matrix(), is_fresh, workers, scratch.stiffness.changed_rows());
  PcgSettings pcg;
  pcg.relative_tolerance = settings.residual_tolerance;
  pcg.reference_mn = std::max(bond_scale, kForceFloorMn);
  pcg.starts_from_last = true;
  report.solve = scratch.solver.solve(scratch.stiffness.matrix(), scratch.right_side, scratch.increment, pcg, workers);

  const double longest_mm = next ? settings.max_step_mm : std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < scratch.increment.size(); ++v) {
    Vec3& step = scratch.increment[v];
    const double length = step.norm();
    if (!std::isfinite(length)) report.is_finite = false;
    if (length > longest_mm) {
      step *= longest_mm / length;
      ++report.held_back_vertices;
    }
    report.max_step_mm = std::max(report.max_step_mm, std::min(length, longest_mm));
  }
  if (!report.is_finite) return stiffnesses;
  if (next) {
    for (std::size_t v = 0; v < scratch.increment.size(); ++v) state.tissue.positions[v] += scratch.increment[v];
  } else {
    const double share = take_lowering_share(model, scratch.right_side, scratch.increment, state.tissue);
    if (share > 0.0) report.max_step_mm *= share;  // if no share lowers the energy, the tissue is stuck, not at rest
  }
  scratch.near.moved(report.max_step_mm);
  scratch.left = state.tissue.positions;
  return stiffnesses;
}

/// A tet's contact with the tool in a step.
struct Contact {
  ContactInterval interval;
  Vec3 offset_mm = Vec3::Zero();  ///< from the tool's tip to the tet's centroid when contact began
};

/// Finds the contact of each candidate with the tool in a step.
/// @param cores  of the tool at evenly spaced moments of the step.
std::vector<Contact> find_contacts(const TissueModel& model, const Tool& tool, const CutState& state,
                                   std::span<const Vec3> before, const ToolPose& next, std::span<const ToolCore> cores,
                                   double limit_mm, std::span<const TetId> candidates, Workers& workers) {
  std::vector<Contact> contacts(candidates.size());
  workers.for_each(candidates.size(), 64, [&](std::size_t c) {
    const std::size_t tet = candidates[c].index();
    const auto from = corners_of(before, model.mesh.tets[tet]);
    const auto to = corners_of(state.tissue.positions, model.mesh.tets[tet]);
    const auto at = [&](double t) { return on_the_way(from, to, t); };
    std::array<double, kIntervalsPerStep + 1> distances{};
    for (std::size_t m = 0; m < distances.size(); ++m) {
      distances[m] = distance_to_core(at(static_cast<double>(m) / kIntervalsPerStep), cores[m]);
    }
    const auto distance = [&](double t) {
      return distance_to_core(at(t), ToolCore(tool, between(state.tool, next, t)));
    };
    Contact& contact = contacts[c];
    contact.interval = contact_interval(distances, distance, limit_mm);
    contact.offset_mm = centroid(at(contact.interval.first)) - between(state.tool, next, contact.interval.first).tip_mm;
  });
  return contacts;
}

/// The tool's core at evenly spaced moments of a step.
std::vector<ToolCore> cores_on_the_way(const Tool& tool, const ToolPose& from, const ToolPose& to) {
  std::vector<ToolCore> cores;
  for (int m = 0; m <= kIntervalsPerStep; ++m)
    cores.emplace_back(tool, between(from, to, static_cast<double>(m) / kIntervalsPerStep));
  return cores;
}

/// Follows the contact of the tissue with the tool through the step: adds to the dose of touched tets, makes bonds
/// where contact begins and drops them where it ends.
/// @param works_kpa  per bond: the tool's work in this step per rest volume.
/// @returns the tets whose dose is now full, ascending.
std::vector<TetId> follow_contact(const TissueModel& model, const CutSettings& settings, const Tool& tool,
                                  CutState& state, CutWorkspace::Data& scratch, const ToolPose& next, double step_s,
                                  std::span<const double> works_kpa, Workers& workers, CutStepReport& report) {
  const Points& before = scratch.before;
  const double limit = touching_distance_mm(tool, settings);
  const std::vector<ToolCore> cores = cores_on_the_way(tool, state.tool, next);
  const std::vector<TetId> candidates =
      scratch.near.candidates(model, state.tissue.is_live, before, state.tissue.positions, cores, limit, workers);
  const std::vector<Contact> contacts =
      find_contacts(model, tool, state, before, next, cores, limit, candidates, workers);

  const double dwell_rate = settings.dwell_rate_per_s();
  std::vector<TetId> due;
  std::vector<Bond> bonds;
  auto held = state.bonds.begin();
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Contact& contact = contacts[c];
    const std::size_t tet = candidates[c].index();
    held = std::lower_bound(held, state.bonds.end(), candidates[c],
                            [](const Bond& bond, TetId id) { return bond.tet < id; });
    const bool was_held = held != state.bonds.end() && held->tet == candidates[c];
    if (contact.interval.fraction > 0.0) {
      const double toughness = relative_toughness(model, tet);
      double torn = 0.0;
      if (settings.tear_energy_kpa && was_held) {
        torn = contact.interval.fraction * works_kpa[static_cast<std::size_t>(held - state.bonds.begin())] /
               (toughness * *settings.tear_energy_kpa);
      }
      state.tear_dose[tet] += torn;
      state.dose[tet] += contact.interval.fraction * step_s * dwell_rate / toughness + torn;
      ++report.tets_in_contact;
      if (state.dose[tet] >= kFullDose) due.push_back(candidates[c]);
    }
    if (contact.interval.at_end) bonds.push_back(was_held ? *held : Bond{candidates[c], contact.offset_mm});
  }
  state.bonds = std::move(bonds);
  return due;
}

void remove(const TissueModel& model, CutState& state, TetId tet, RemovalCause cause) {
  state.tissue.is_live[tet.index()] = 0;
  state.record.removals.push_back({tet, state.step, state.time_s, cause,
                                   centroid(corners_of(state.tissue.positions, model.mesh.tets[tet.index()])),
                                   rest_volume_mm3(model, state.splits, tet)});
}

/// Removes the loose fragments that contain or border on a tet of `changed`, and the bonds of all removed tets.
/// @returns the number of tets removed.
std::size_t remove_loose(const TissueModel& model, CutState& state, const CutWorkspace::Data& scratch,
                         const std::vector<TetId>& changed) {
  const std::vector<TetId> loose =
      loose_fragments(model.mesh, scratch.rest_volumes_mm3, scratch.neighbours(), state.tissue.is_live,
                      scratch.is_anchored, changed, kFragmentShare * scratch.body_volume_mm3);
  for (const TetId tet : loose) remove(model, state, tet, RemovalCause::LooseFragment);
  std::erase_if(state.bonds, [&](const Bond& bond) { return state.tissue.is_live[bond.tet.index()] == 0; });
  return loose.size();
}

/// Removes tets (live, ascending), then the loose fragments that result.
/// @returns the number of tets in these fragments.
std::size_t carve(const TissueModel& model, CutState& state, const CutWorkspace::Data& scratch,
                  const std::vector<TetId>& due) {
  if (due.empty()) return 0;
  for (const TetId tet : due) {
    const bool is_torn = state.tear_dose[tet.index()] > 0.5 * state.dose[tet.index()];
    remove(model, state, tet, is_torn ? RemovalCause::Tear : RemovalCause::Dwell);
  }
  return remove_loose(model, state, scratch, due);
}

/// Wanted tets that lie within a distance of the tool at one of the moments of its cores, ascending.
std::vector<TetId> tets_near(const TissueModel& model, NearTets& finder, std::span<const std::uint8_t> is_wanted,
                             std::span<const Vec3> before, std::span<const Vec3> after, std::span<const ToolCore> cores,
                             double distance_mm, Workers& workers) {
  const std::vector<TetId> candidates = finder.candidates(model, is_wanted, before, after, cores, distance_mm, workers);
  std::vector<std::uint8_t> is_near(candidates.size(), 0);
  workers.for_each(candidates.size(), 64, [&](std::size_t c) {
    const auto from = corners_of(before, model.mesh.tets[candidates[c].index()]);
    const auto to = corners_of(after, model.mesh.tets[candidates[c].index()]);
    for (std::size_t m = 0; m < cores.size() && is_near[c] == 0; ++m) {
      const double t = cores.size() > 1 ? static_cast<double>(m) / static_cast<double>(cores.size() - 1) : 0.0;
      if (distance_to_core(on_the_way(from, to, t), cores[m]) <= distance_mm) is_near[c] = 1;
    }
  });
  std::vector<TetId> near;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (is_near[c] != 0) near.push_back(candidates[c]);
  }
  return near;
}

/// Returns the points of the state; rebuilds them if those of the workspace are others.
PointLattice& lattice_for(const TissueModel& model, const CutState& state, CutWorkspace::Data& scratch) {
  if (!scratch.lattice || !scratch.lattice->is_of(state.points)) {
    scratch.lattice.emplace(model, state.points, state.splits);
    scratch.every_tet.assign(model.mesh.tets.size(), 1);
  }
  return *scratch.lattice;
}

/// Whether tets are split after a step: every n steps, where n is the greatest divisor of kRenewalSteps in which the
/// tool travels at most kSplittingMm, or 1. Not after every step, because a split rebuilds the workspace.
bool is_splitting_step(const CutSettings& settings, int step) {
  int steps = kRenewalSteps;
  while (steps > 1 && (kRenewalSteps % steps != 0 || steps * settings.advance_per_step_mm > kSplittingMm)) --steps;
  return step % steps == 0;
}

/// Splits the tets that have come apart, and removes the loose fragments that result.
/// @returns the number of tets removed.
std::size_t split_mesh_of(const TissueModel& whole, CutState& state, CutWorkspace& workspace) {
  const auto& parted = state.points.parted_step;
  if (std::ranges::none_of(parted, [&](int step) { return step > state.split_step; })) return 0;
  const TissueModel& model = workspace.model_for(whole, state.splits);
  const std::vector<TetId> touched = split_parted_tets(model, lattice_for(model, state, workspace.data()), state);
  if (touched.empty()) return 0;
  PointLattice lattice = std::move(*workspace.data().lattice);
  const TissueModel& split = workspace.model_for(whole, state.splits);
  lattice.follow(split, state.points, state.splits);
  CutWorkspace::Data& scratch = workspace.data();
  scratch.lattice = std::move(lattice);
  scratch.every_tet.assign(split.mesh.tets.size(), 1);
  const std::size_t loose = remove_loose(split, state, workspace.data(), touched);
  // The fragments of one step are recorded in ascending order, whichever change cut them off.
  std::vector<Removal>& removals = state.record.removals;
  auto first = removals.end();
  while (first != removals.begin() && std::prev(first)->step == state.step &&
         std::prev(first)->cause == RemovalCause::LooseFragment)
    --first;
  std::sort(first, removals.end(), [](const Removal& a, const Removal& b) { return a.tet < b.tet; });
  return loose;
}

/// A step of a cut by points with the tool in.
CutStepReport advance_points(const TissueModel& model, const CutSettings& settings, const Tool& tool, CutState& state,
                             CutWorkspace::Data& scratch, const ToolPose& next, double step_s, Workers& workers) {
  CutStepReport report;
  lattice_for(model, state, scratch);
  const std::vector<ToolCore> here{ToolCore(tool, state.tool)};
  const std::vector<TetId> held = tets_near(model, scratch.near, state.tissue.is_live, scratch.before, scratch.before,
                                            here, settings.kernel_radius_mm, workers);
  meet_points(held, *scratch.lattice, state.points);
  const PointHold hold = hold_points(model, settings, tool, state, next, step_s, *scratch.lattice, held, workers);
  move_tissue(model, settings, tool, state, scratch, next, &hold, step_s, workers, report);
  if (report.is_finite) end_viscous_step(model, state.tissue, settings.tissue_s(step_s), workers);
  state.time_s += step_s;
  ++state.step;
  if (!report.is_finite) return report;
  const Eigen::Quaterniond turn = turn_of_held(tool, state.tool, next);
  for (std::size_t i = 0; i < state.points.is_held.size(); ++i) {
    if (state.points.is_held[i] != 0) state.points.offset_mm[i] = turn * state.points.offset_mm[i];
  }
  load_tool(model, settings, tool, next, hold, *scratch.lattice, scratch.before, state, report);
  const std::vector<ToolCore> cores = cores_on_the_way(tool, state.tool, next);
  // Removed tets, too: if their doses stopped growing, the kerf's border would lie too far inwards.
  const std::vector<TetId> candidates = tets_near(model, scratch.near, scratch.every_tet, scratch.before,
                                                  state.tissue.positions, cores, settings.kernel_radius_mm, workers);
  meet_points(candidates, *scratch.lattice, state.points);
  const std::vector<TetId> due = dose_points(model, settings, state, *scratch.lattice, scratch.before, next, cores,
                                             step_s, candidates, workers, report);
  state.tool = next;
  report.loose_removed = carve(model, state, scratch, due);
  report.removed = due.size();
  return report;
}

/// Whether a tet has a face on the boundary of the live tets.
bool is_at_surface(const FaceAdjacency& neighbours, std::span<const std::uint8_t> is_live, TetId tet) {
  return std::ranges::count_if(neighbours.of(tet.index()), [&](std::int32_t neighbour) {
           return is_live[static_cast<std::size_t>(neighbour)] != 0;
         }) < 4;
}

/// The paper's rule, before the tissue moves: the tool holds exactly the tets at the surface that it touches in its
/// present pose. Tets that a removal exposes are touched from the next step on, as in SofaCarving.
void touch_surface(const TissueModel& model, const CutSettings& settings, const Tool& tool, CutState& state,
                   CutWorkspace::Data& scratch, Workers& workers) {
  const std::vector<ToolCore> here{ToolCore(tool, state.tool)};
  std::vector<TetId> touched = tets_near(model, scratch.near, state.tissue.is_live, state.tissue.positions,
                                         state.tissue.positions, here, touching_distance_mm(tool, settings), workers);
  std::erase_if(touched, [&](TetId tet) { return !is_at_surface(scratch.neighbours(), state.tissue.is_live, tet); });
  if (settings.contact_count == ContactCount::Reset) {
    for (const Bond& bond : state.bonds) {
      if (!std::ranges::binary_search(touched, bond.tet)) state.dose[bond.tet.index()] = 0.0;
    }
  }
  std::vector<Bond> bonds;
  for (const TetId tet : touched) {
    const auto held = std::ranges::lower_bound(state.bonds, tet, {}, &Bond::tet);
    const bool was_held = held != state.bonds.end() && held->tet == tet;
    const Vec3 middle = centroid(corners_of(state.tissue.positions, model.mesh.tets[tet.index()]));
    bonds.push_back(was_held ? *held : Bond{tet, middle - state.tool.tip_mm});
  }
  state.bonds = std::move(bonds);
}

/// The paper's rule, once the tissue has moved: counts a step for each held tet.
/// @returns the tets whose count is now full, ascending.
std::vector<TetId> count_step(const TissueModel& model, const CutSettings& settings, CutState& state,
                              CutStepReport& report) {
  const double unit = settings.dwell_rate_per_s() * settings.reference_step_s;  // 1 / dullness at the reference energy
  std::vector<TetId> due;
  for (const Bond& bond : state.bonds) {
    double& dose = state.dose[bond.tet.index()];
    dose += unit / relative_toughness(model, bond.tet.index());
    if (dose >= kFullDose) due.push_back(bond.tet);
  }
  report.tets_in_contact = state.bonds.size();
  return due;
}

}  // namespace

std::size_t remove_tets(const TissueModel& model, CutState& state, CutWorkspace& workspace,
                        std::span<const TetId> tets) {
  std::vector<TetId> due;
  for (const TetId tet : tets) {
    INCISE_REQUIRE(tet.is_valid() && tet.index() < state.tissue.is_live.size(),
                   fmt::format("expected one of {} tets, found {}", state.tissue.is_live.size(), tet.value));
    if (state.tissue.is_live[tet.index()] != 0) due.push_back(tet);
  }
  std::sort(due.begin(), due.end());
  due.erase(std::unique(due.begin(), due.end()), due.end());
  return due.size() + carve(workspace.model_for(model, state.splits), state, workspace.data(), due);
}

CutStepReport advance(const TissueModel& whole, const CutSettings& settings, const Tool& tool, CutState& state,
                      CutWorkspace& workspace, const std::optional<ToolPose>& next, double step_s, Workers& workers) {
  INCISE_REQUIRE(step_s > 0.0 && std::isfinite(step_s), "expected a step above 0 s");
  CutStepReport report;
  if (!next && !state.points.tets.empty()) report.loose_removed = split_mesh_of(whole, state, workspace);
  const TissueModel& model = workspace.model_for(whole, state.splits);
  CutWorkspace::Data& scratch = workspace.data();
  if (state.step != scratch.next_step || state.tissue.positions != scratch.left) {  // an earlier or another state
    scratch.next_step = -1;
    scratch.is_orphan.clear();
    scratch.near.forget();
  }
  scratch.before = state.tissue.positions;
  if (next && settings.rule == CutRule::Lattice) {
    report = advance_points(model, settings, tool, state, scratch, *next, step_s, workers);
    if (report.is_finite && is_splitting_step(settings, state.step))
      report.loose_removed += split_mesh_of(whole, state, workspace);
    return report;
  }
  if (!next) state.bonds.clear();
  const bool counts_steps = settings.rule == CutRule::Paper;
  if (next && counts_steps) touch_surface(model, settings, tool, state, scratch, workers);
  const std::vector<double> stiffnesses =
      move_tissue(model, settings, tool, state, scratch, next, nullptr, step_s, workers, report);
  if (report.is_finite)
    end_viscous_step(model, state.tissue, next ? settings.tissue_s(step_s) : std::numeric_limits<double>::infinity(),
                     workers);
  state.time_s += step_s;
  ++state.step;
  if (!next || !report.is_finite) return report;
  if (settings.slip_mm) slip(model, tool, *settings.slip_mm, state, report);
  const std::vector<double> works_kpa = load_tool(model, state, tool, *next, stiffnesses, report);
  // What the tool holds turns with it.
  const Eigen::Quaterniond turn = turn_of_held(tool, state.tool, *next);
  for (Bond& bond : state.bonds) bond.offset_mm = turn * bond.offset_mm;
  const std::vector<TetId> due =
      counts_steps ? count_step(model, settings, state, report)
                   : follow_contact(model, settings, tool, state, scratch, *next, step_s, works_kpa, workers, report);
  state.tool = *next;
  report.loose_removed = carve(model, state, scratch, due);
  report.removed = due.size();
  return report;
}

}  // namespace incise
