#include "point_lattice.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/cutting/cut_invariants.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <set>

namespace incise {
namespace {

/// Relative rounding error of a sum of millions of positive numbers, taken in different orders.
constexpr double kRounding = 1e-10;

/// Collects the first violation of each kind, as a sentence.
class Violations {
 public:
  template <class... Args>
  void add(bool is_violated, fmt::format_string<Args...> text, Args&&... args) {
    const fmt::string_view kind = text;
    if (!is_violated || !known_.emplace(kind.data(), kind.size()).second) return;
    texts_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }
  [[nodiscard]] std::vector<std::string> take() { return std::move(texts_); }

 private:
  std::set<std::string> known_;  // kinds, by their format
  std::vector<std::string> texts_;
};

void require_fitting(const TissueModel& model, const CutState& state) {
  const auto require = [](std::size_t found, std::size_t expected, const char* what) {
    INCISE_REQUIRE(found == expected, fmt::format("{}: expected {}, found {}", what, expected, found));
  };
  require(state.tissue.positions.size(), model.mesh.vertices.size(), "positions");
  require(state.tissue.is_live.size(), model.mesh.tets.size(), "flags of live tets");
  require(state.dose.size(), model.mesh.tets.size(), "doses");
  require(state.tear_dose.size(), model.mesh.tets.size(), "doses of tearing");
}

/// Whether `next` may follow `before` in a record.
bool is_ordered(const Removal& before, const Removal& next) {
  if (before.step != next.step) return before.step < next.step;
  const bool was_loose = before.cause == RemovalCause::LooseFragment;
  const bool is_loose = next.cause == RemovalCause::LooseFragment;
  return was_loose == is_loose ? before.tet < next.tet : is_loose;
}

/// @returns one flag per tet: 1 if the tet is in the record.
std::vector<std::uint8_t> check_record(const TissueModel& model, const CutState& state, Violations& violations) {
  std::vector<std::uint8_t> times_removed(model.mesh.tets.size(), 0);
  const std::vector<Removal>& removals = state.record.removals;
  for (std::size_t i = 0; i < removals.size(); ++i) {
    const Removal& r = removals[i];
    const bool is_unknown = !r.tet.is_valid() || r.tet.index() >= model.mesh.tets.size();
    violations.add(is_unknown, "record: entry {} names tet {}, expected one of {}", i, r.tet.value,
                   model.mesh.tets.size());
    if (is_unknown) continue;
    violations.add(times_removed[r.tet.index()] != 0, "record: tet {} was removed twice, again in entry {}",
                   r.tet.value, i);
    times_removed[r.tet.index()] = 1;
    violations.add(i > 0 && !is_ordered(removals[i - 1], r),
                   "record: entry {} (step {}, tet {}) does not follow the one before it (step {}, tet {})", i, r.step,
                   r.tet.value, removals[i > 0 ? i - 1 : 0].step, removals[i > 0 ? i - 1 : 0].tet.value);
    const bool is_ahead = !(r.step >= 0 && r.step <= state.step && r.time_s >= 0.0 && r.time_s <= state.time_s);
    violations.add(is_ahead, "record: entry {} is from step {}, {} s; the cut is at step {}, {} s", i, r.step, r.time_s,
                   state.step, state.time_s);
    const double held_mm3 = rest_volume_mm3(model, state.splits, r.tet);
    violations.add(!(std::abs(r.rest_volume_mm3 - held_mm3) <= 1e-12 * held_mm3),
                   "record: tet {} has a rest volume of {} mm³, the record says {} mm³", r.tet.value, held_mm3,
                   r.rest_volume_mm3);
  }
  return times_removed;
}

void check_balance(const TissueModel& model, const CutState& state, std::span<const std::uint8_t> times_removed,
                   Violations& violations) {
  double live_mm3 = 0.0, uncut_mm3 = 0.0;
  for (std::size_t tet = 0; tet < times_removed.size(); ++tet) {
    const bool is_live = state.tissue.is_live[tet] != 0;
    violations.add(!is_live && times_removed[tet] == 0, "record: tet {} was removed but is not in the record", tet);
    violations.add(is_live && times_removed[tet] != 0, "record: tet {} is live but is in the record", tet);
    const double held_mm3 = rest_volume_mm3(model, state.splits, TetId(tet));
    if (is_live) live_mm3 += held_mm3;
    uncut_mm3 += tet + state.splits.copies.size() < times_removed.size() ? model.volumes_mm3[tet] : 0.0;
  }
  const double found_mm3 = live_mm3 + state.record.removed_volume_mm3();
  violations.add(!(std::abs(found_mm3 - uncut_mm3) <= kRounding * uncut_mm3),
                 "balance: live and removed rest volume are {} mm³, the uncut body's is {} mm³", found_mm3, uncut_mm3);
  // The model stores mass per vertex, so this also checks that lumping lost no mass.
  const double uncut_kg = std::accumulate(model.vertex_mass_kg.begin(), model.vertex_mass_kg.end(), 0.0);
  const double found_kg = found_mm3 * units::kg_mm3_from_kg_m3(model.material.density_kg_m3);
  violations.add(!(std::abs(found_kg - uncut_kg) <= kRounding * uncut_kg),
                 "balance: live and removed mass are {} kg, the uncut body's is {} kg", found_kg, uncut_kg);
}

void check_positions(const TissueModel& model, const CutState& state, Violations& violations) {
  for (std::size_t tet = 0; tet < model.mesh.tets.size(); ++tet) {
    const double dose = state.dose[tet];
    const double torn = state.tear_dose[tet];
    violations.add(!(std::isfinite(dose) && torn >= 0.0 && torn <= dose),
                   "dose: tet {} has {}, of which {} from tearing", tet, dose, torn);
    if (state.tissue.is_live[tet] == 0) continue;
    for (const VertexId v : model.mesh.tets[tet]) {
      violations.add(!state.tissue.positions[v.index()].allFinite(),
                     "positions: vertex {} of live tet {} is not finite", v.value, tet);
    }
  }
}

void check_points(const TissueModel& whole, const CutState& state, Violations& violations) {
  const CutPoints& p = state.points;
  const std::string problem = find_problem(whole, state);
  violations.add(!problem.empty(), "{}", problem);
  if (!problem.empty()) return;
  for (std::size_t i = 0; i < p.dose.size(); ++i) {
    const bool is_sound = std::isfinite(p.dose[i]) && p.dose[i] >= 0.0 && (p.dose[i] >= 1.0) == (p.parted_step[i] >= 0);
    violations.add(!is_sound, "points: point {} has a dose of {} and parted in step {}", i, p.dose[i],
                   p.parted_step[i]);
  }
  for (std::size_t t = 0; t < state.tissue.fill.size(); ++t) {
    const double fill = state.tissue.fill[t];
    violations.add(!(fill > 0.0 && fill <= 1.0), "points: tet {} has {} of its stiffness left", t, fill);
  }
}

void check_bonds(const TissueModel& model, const CutState& state, Violations& violations) {
  for (std::size_t i = 0; i < state.bonds.size(); ++i) {
    const Bond& bond = state.bonds[i];
    const bool is_unknown = !bond.tet.is_valid() || bond.tet.index() >= model.mesh.tets.size();
    violations.add(is_unknown, "bonds: entry {} names tet {}, expected one of {}", i, bond.tet.value,
                   model.mesh.tets.size());
    if (is_unknown) continue;
    violations.add(state.tissue.is_live[bond.tet.index()] == 0, "bonds: tet {} is held but was removed",
                   bond.tet.value);
    violations.add(i > 0 && !(state.bonds[i - 1].tet < bond.tet), "bonds: tet {} does not follow tet {}",
                   bond.tet.value, state.bonds[i > 0 ? i - 1 : 0].tet.value);
    violations.add(!bond.offset_mm.allFinite(), "bonds: the offset of tet {} is not finite", bond.tet.value);
  }
}

}  // namespace

std::string find_problem(const TissueModel& whole, const CutState& state) {
  try {
    require_splits_of(whole.mesh, state.splits);
    lattice_of(whole, state.points).require_own_tets(state.points, state.splits, whole.mesh.tets.size());
    for (const std::int32_t step : state.points.parted_step)
      INCISE_REQUIRE(step >= -1 && step <= state.step,
                     fmt::format("points: expected the step in which a point parted, up to {}, or -1, found {}",
                                 state.step, step));
    for (const double dose : state.points.dose)
      INCISE_REQUIRE(dose >= 0.0 && std::isfinite(dose),
                     fmt::format("points: expected a dose of 0 or more, found {}", dose));
    for (const Removal& removal : state.record.removals)
      INCISE_REQUIRE(removal.step >= 0 && removal.step <= state.step,
                     fmt::format("record: expected steps from 0 to {}, found {}", state.step, removal.step));
  } catch (const InvalidArgument& error) {
    return error.text();
  }
  return {};
}

std::vector<std::string> cut_invariants(const TissueModel& whole, const CutState& state) {
  std::optional<TissueModel> split;
  if (state.splits != MeshSplits{}) split = split_model(whole, state.splits);
  const TissueModel& model = split ? *split : whole;
  require_fitting(model, state);
  Violations violations;
  const std::vector<std::uint8_t> times_removed = check_record(model, state, violations);
  check_balance(model, state, times_removed, violations);
  check_positions(model, state, violations);
  check_bonds(model, state, violations);
  check_points(whole, state, violations);
  return violations.take();
}

}  // namespace incise
