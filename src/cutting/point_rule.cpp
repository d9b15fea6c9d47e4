#include "point_rule.hpp"

#include "contact.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace incise {
namespace {

constexpr double kSliceMm = 0.5;  // between the middles of two hats along the axis
constexpr std::size_t kTetsPerChunk = 16;

/// How strongly the tool acts at a distance from its core: (1 − s²/R²)², 0 from R on.
double kernel(double distance_mm, double radius_mm) {
  const double q = 1.0 - distance_mm * distance_mm / (radius_mm * radius_mm);
  return q > 0.0 ? q * q : 0.0;
}

/// Of the reference tissue. The kernel's integral along a line through the axis is 16 R / 15: a point there that does
/// not move gets the dose dose_length / (v d τ0).
double dose_rate_per_s(const CutSettings& settings, double distance_mm) {
  const double radius = settings.kernel_radius_mm;
  return settings.dwell_rate_per_s() * 15.0 * settings.dose_length_mm / (16.0 * radius) * kernel(distance_mm, radius);
}

/// The two hats over a place along the axis, and the weight of the second.
struct Hats {
  int first;
  double second_weight;
};
Hats hats_at(const Vec3& p, const Tool& tool, const ToolPose& pose) {
  if (std::holds_alternative<Ball>(tool)) return {0, 0.0};
  const double up = std::max(0.0, (pose.tip_mm - p).dot(pose.axis)) / kSliceMm;
  const double first = std::floor(up);
  return {static_cast<int>(first), up - first};
}

/// What one tet gives to one slice.
struct Part {
  int slice;
  std::array<double, 4> weight{};  // of its corners
  double sum = 0.0;                // of all
  Vec3 target = Vec3::Zero();      // sum of where its points are pulled to
};

Part& part_of(std::vector<Part>& parts, int slice) {
  const auto found = std::ranges::find(parts, slice, &Part::slice);
  if (found != parts.end()) return *found;
  return parts.emplace_back(Part{slice, {}, 0.0, Vec3::Zero()});
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
  const double radius = settings.kernel_radius_mm;
  std::vector<std::vector<Part>> parts(candidates.size());
  workers.for_each(candidates.size(), kTetsPerChunk, [&](std::size_t c) {
    const auto [begin, end] = lattice.points_of(candidates[c]);
    const double toughness = relative_toughness(model, candidates[c].index());
    for (std::size_t i = begin; i < end; ++i) {
      if (lattice.tet_of(i) != candidates[c] || state.points.is_held[i] == 0 || state.points.dose[i] >= 1.0) continue;
      const Vec3 p = lattice.position(i, state.tissue.positions);
      const double distance = distance_to_core(p, core);
      // The hold is that of the middle of the step, as far as the dose is concerned.
      const double left = 1.0 - state.points.dose[i] - 0.5 * step_s * dose_rate_per_s(settings, distance) / toughness;
      if (left <= 0.0) continue;
      const double weight = lattice.volume_mm3(i) * left * kernel(distance, radius);
      if (weight == 0.0) continue;
      const Hats hats = hats_at(p, tool, state.tool);
      for (int hat = 0; hat < 2; ++hat) {
        const double share = weight * (hat == 0 ? 1.0 - hats.second_weight : hats.second_weight);
        if (share == 0.0) continue;
        Part& part = part_of(parts[c], hats.first + hat);
        for (std::size_t k = 0; k < 4; ++k) part.weight[k] += share * lattice.shares(i)[k];
        part.sum += share;
        part.target += share * (next.tip_mm + turn * state.points.offset_mm[i]);
      }
    }
  });
  std::map<int, std::map<std::int32_t, double>> weights;
  std::map<int, std::pair<double, Vec3>> sums;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    for (const Part& part : parts[c]) {
      auto& of_slice = weights[part.slice];
      for (std::size_t k = 0; k < 4; ++k) of_slice[model.mesh.tets[candidates[c].index()][k].value] += part.weight[k];
      auto [at, is_new] = sums.try_emplace(part.slice, 0.0, Vec3::Zero());
      at->second.first += part.sum;
      at->second.second += part.target;
    }
  }
  // A slice in full contact, of all points about the tool, has the stiffness `hold_kpa` times its length.
  const double per_volume = 3.0 * settings.hold_kpa / (M_PI * radius * radius);
  const Mat3 held = held_directions(tool, next);
  PointHold hold;
  for (const auto& [slice, of_vertex] : weights) {
    const auto& [sum, target] = sums.at(slice);
    Vec3 middle = Vec3::Zero();
    for (const auto& [vertex, weight] : of_vertex) {
      hold.means.vertex.push_back(vertex);
      hold.means.weight.push_back(weight / sum);
      middle += weight / sum * state.tissue.positions[static_cast<std::size_t>(vertex)];
    }
    hold.means.start.push_back(hold.means.vertex.size());
    // A slice that slips is pulled with the greatest pull, and no harder while its tissue gives way in the step.
    const double elastic = per_volume * sum;
    const double pull = elastic * (held * (target / sum - middle)).norm();
    const double share = settings.slip_mn_mm ? std::min(1.0, *settings.slip_mn_mm * kSliceMm / pull) : 1.0;
    hold.means.stiffness.emplace_back(share * elastic * held);
    hold.elastic_mn_mm.push_back(elastic);
    hold.target_mm.emplace_back(target / sum);
    hold.middle_mm.push_back(middle);
    hold.number.push_back(slice);
  }
  return hold;
}

double add_pull(const PointHold& hold, std::span<Vec3> forces) {
  std::map<std::int32_t, Vec3> sums;
  for (std::size_t t = 0; t < hold.means.terms(); ++t) {
    const Vec3 pull = hold.means.stiffness[t] * (hold.target_mm[t] - hold.middle_mm[t]);
    for (std::size_t i = hold.means.start[t]; i < hold.means.start[t + 1]; ++i) {
      const Vec3 part = hold.means.weight[i] * pull;
      forces[static_cast<std::size_t>(hold.means.vertex[i])] += part;
      sums.try_emplace(hold.means.vertex[i], Vec3::Zero()).first->second += part;
    }
  }
  double squared = 0.0;
  for (const auto& [vertex, sum] : sums) squared += sum.squaredNorm();
  return std::sqrt(squared);
}

void load_tool(const CutSettings& settings, const Tool& tool, const ToolPose& next, const PointHold& hold,
               const PointLattice& lattice, CutState& state, CutStepReport& report) {
  const Mat3 held_to = held_directions(tool, next);
  std::map<int, Vec3> shifts;  // of slices that slip
  for (std::size_t t = 0; t < hold.means.terms(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = hold.means.start[t]; i < hold.means.start[t + 1]; ++i)
      middle += hold.means.weight[i] * state.tissue.positions[static_cast<std::size_t>(hold.means.vertex[i])];
    const Vec3 behind = middle - hold.target_mm[t];
    const Vec3 force = hold.means.stiffness[t] * behind;
    const Vec3 held = held_to * behind;
    const double pull = hold.elastic_mn_mm[t] * held.norm();
    if (settings.slip_mn_mm && pull > *settings.slip_mn_mm * kSliceMm) {
      shifts[hold.number[t]] = (1.0 - *settings.slip_mn_mm * kSliceMm / pull) * held;
      ++report.slipped;
    }
    report.tool_force_mn += force;
    report.tool_torque_mn_mm += (middle - next.tip_mm).cross(force);
  }
  if (shifts.empty()) return;
  const auto shift_of = [&](int slice) {
    const auto found = shifts.find(slice);
    return found == shifts.end() ? Vec3(Vec3::Zero()) : found->second;
  };
  for (std::size_t i = 0; i < state.points.is_held.size(); ++i) {
    if (state.points.is_held[i] == 0) continue;
    const Hats hats = hats_at(lattice.position(i, state.tissue.positions), tool, next);
    state.points.offset_mm[i] +=
        (1.0 - hats.second_weight) * shift_of(hats.first) + hats.second_weight * shift_of(hats.first + 1);
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
