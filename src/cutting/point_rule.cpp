#include "point_rule.hpp"

#include <algorithm>

namespace incise {
namespace {

constexpr std::size_t kTetsPerChunk = 16;

/// The kernel at a distance s from the core: (1 − s²/R²)², 0 from R on.
double kernel(double distance_mm, double radius_mm) {
  const double q = 1.0 - distance_mm * distance_mm / (radius_mm * radius_mm);
  return q > 0.0 ? q * q : 0.0;
}

/// Dose per second of a point of the reference tissue. The kernel's integral along a line through the axis is
/// 16 R / 15, so at the reference energy a fixed point on that line gets the dose dose_length / (v d τ0).
double dose_rate_per_s(const CutSettings& settings, double distance_mm) {
  const double radius = settings.kernel_radius_mm;
  return settings.dwell_rate_per_s() * 15.0 * settings.dose_length_mm / (16.0 * radius) * kernel(distance_mm, radius);
}

}  // namespace

void meet_points(std::span<const TetId> candidates, PointLattice& lattice, CutPoints& points) {
  for (const TetId tet : candidates) {
    const auto [first, last] = lattice.points_of(tet);
    if (first != last) continue;
    lattice.add(tet);
    points.tets.push_back(tet);
    points.tet_of.resize(lattice.size(), tet);
    points.dose.resize(lattice.size(), 0.0);
    points.is_held.resize(lattice.size(), 0);
    points.offset_mm.resize(lattice.size(), Vec3::Zero());
    points.parted_step.resize(lattice.size(), -1);
    points.parted_mm.resize(lattice.size(), Vec3::Zero());
  }
}

PointHold hold_points(const TissueModel& model, const CutSettings& settings, const Tool& tool, const CutState& state,
                      const ToolPose& next, double step_s, const PointLattice& lattice,
                      std::span<const TetId> candidates, Workers& workers) {
  const Eigen::Quaterniond turn = turn_of_held(tool, state.tool, next);
  const ToolCore core(tool, state.tool);
  PointHold hold;
  hold.directions = held_directions(tool, next);
  hold.tets.resize(candidates.size());
  // The resistance of the tissue beneath it, over the duration of a hold, limits the hold.
  const double stiffer = shear_ratio(model.material, settings.tissue_s(1.0 / settings.dwell_rate_per_s()));
  workers.for_each(candidates.size(), kTetsPerChunk, [&](std::size_t c) {
    HeldTet& held = hold.tets[c];
    held.tet = candidates[c];
    const std::size_t tet = held.tet.index();
    const auto [begin, end] = lattice.points_of(held.tet);
    const double toughness = relative_toughness(model, tet);
    const double stiffness_kpa_mm2 = settings.hold_per_mm2 * stiffer * model.lame[tet].mu_kpa;
    for (std::size_t i = begin; i < end; ++i) {
      if (lattice.tet_of(i) != held.tet || state.points.is_held[i] == 0 || state.points.dose[i] >= 1.0) continue;
      const Vec3 p = lattice.position(i, state.tissue.positions);
      const double distance = distance_to_core(p, core);
      // The hold weakens with the dose: that in the middle of the step counts.
      const double left = 1.0 - state.points.dose[i] - 0.5 * step_s * dose_rate_per_s(settings, distance) / toughness;
      if (left <= 0.0) continue;
      const double stiffness_mn_mm =
          stiffness_kpa_mm2 * lattice.volume_mm3(i) * left * kernel(distance, settings.kernel_radius_mm);
      const Vec3 pull = stiffness_mn_mm * (hold.directions * (next.tip_mm + turn * state.points.offset_mm[i] - p));
      const std::array<double, 4>& shares = lattice.shares(i);
      for (std::size_t a = 0; a < 4; ++a) {
        held.pull_mn[a] += shares[a] * pull;
        for (std::size_t b = 0; b < 4; ++b) held.stiffness_mn_mm[4 * a + b] += stiffness_mn_mm * shares[a] * shares[b];
      }
    }
  });
  std::erase_if(hold.tets, [](const HeldTet& held) {
    return std::ranges::all_of(held.stiffness_mn_mm, [](double stiffness) { return stiffness == 0.0; });
  });
  return hold;
}

void load_tool(const TissueModel& model, const CutSettings& settings, const Tool& tool, const ToolPose& next,
               const PointHold& hold, const PointLattice& lattice, std::span<const Vec3> before, CutState& state,
               CutStepReport& report) {
  const Points& positions = state.tissue.positions;
  for (const HeldTet& held : hold.tets) {
    const Tet& corners = model.mesh.tets[held.tet.index()];
    for (std::size_t a = 0; a < 4; ++a) {
      Vec3 given_way = Vec3::Zero();
      for (std::size_t b = 0; b < 4; ++b)
        given_way += held.stiffness_mn_mm[4 * a + b] * (vertex(positions, corners[b]) - vertex(before, corners[b]));
      const Vec3 force = hold.directions * given_way - held.pull_mn[a];
      report.tool_force_mn += force;
      report.tool_torque_mn_mm += (vertex(positions, corners[a]) - next.tip_mm).cross(force);
    }
  }
  if (!settings.slip_mm) return;
  const Mat3 held_to = held_directions(tool, next);
  for (std::size_t i = 0; i < state.points.is_held.size(); ++i) {
    const bool is_pulled = state.points.is_held[i] != 0 && state.points.dose[i] < 1.0 &&
                           state.tissue.is_live[state.points.tet_of[i].index()] != 0;
    if (!is_pulled) continue;
    const Vec3 behind = held_to * (lattice.position(i, positions) - next.tip_mm - state.points.offset_mm[i]);
    const double distance = behind.norm();
    if (distance <= *settings.slip_mm) continue;
    state.points.offset_mm[i] += (1.0 - *settings.slip_mm / distance) * behind;
    ++report.slipped;
  }
}

std::vector<TetId> dose_points(const TissueModel& model, const CutSettings& settings, CutState& state,
                               const PointLattice& lattice, std::span<const Vec3> before, const ToolPose& next,
                               std::span<const ToolCore> cores, double step_s, std::span<const TetId> candidates,
                               Workers& workers, CutStepReport& report) {
  const std::size_t moments = cores.size();
  std::vector<ToolPose> poses;
  for (std::size_t m = 0; m < moments; ++m)
    poses.push_back(between(state.tool, next, static_cast<double>(m) / static_cast<double>(moments - 1)));
  CutPoints& points = state.points;
  if (state.tissue.fill.empty()) state.tissue.fill.assign(model.mesh.tets.size(), 1.0);
  std::vector<std::uint8_t> is_near(candidates.size(), 0), is_empty(candidates.size(), 0);
  workers.for_each(candidates.size(), kTetsPerChunk, [&](std::size_t c) {
    const std::size_t tet = candidates[c].index();
    const auto [begin, end] = lattice.points_of(candidates[c]);
    const double toughness = relative_toughness(model, candidates[c].index());
    double filled = 0.0, all = 0.0, dosed = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (lattice.tet_of(i) != candidates[c]) continue;
      const Vec3 from = lattice.position(i, before), to = lattice.position(i, state.tissue.positions);
      double sum = 0.0;
      bool is_within = false;
      bool was_held = points.is_held[i] != 0;
      for (std::size_t m = 0; m < moments; ++m) {
        const double t = static_cast<double>(m) / static_cast<double>(moments - 1);
        const Vec3 p = from + t * (to - from);
        const double distance = distance_to_core(p, cores[m]);
        is_within = distance < settings.kernel_radius_mm;
        if (is_within && !was_held) {
          was_held = true;
          points.offset_mm[i] = p - poses[m].tip_mm;
        }
        sum += (m == 0 || m + 1 == moments ? 0.5 : 1.0) * dose_rate_per_s(settings, distance);
      }
      points.is_held[i] = is_within ? 1 : 0;
      if (sum > 0.0) {
        is_near[c] = 1;
        points.dose[i] += step_s / toughness * sum / static_cast<double>(moments - 1);
      }
      if (points.dose[i] >= 1.0 && points.parted_step[i] < 0) {
        points.parted_step[i] = state.step;
        points.parted_mm[i] = to;
      }
      const double volume = lattice.volume_mm3(i);
      all += volume;
      dosed += volume * std::min(1.0, points.dose[i]);
      if (points.dose[i] < 1.0) filled += volume;
    }
    if (state.tissue.is_live[tet] == 0) return;
    state.dose[tet] = dosed / all;
    is_empty[c] = filled == 0.0 ? 1 : 0;
    state.tissue.fill[tet] = std::clamp(filled / model.volumes_mm3[tet], kLeastFill, 1.0);
  });
  std::vector<TetId> empty;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (is_near[c] != 0 && state.tissue.is_live[candidates[c].index()] != 0) ++report.tets_in_contact;
    if (is_empty[c] != 0) empty.push_back(candidates[c]);
  }
  return empty;
}

}  // namespace incise
