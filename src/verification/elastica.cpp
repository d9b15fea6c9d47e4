// A slender beam that a tip force bends by about sixty degrees: large rotations, small strains.
#include "verification/beam_in_the_plane.hpp"
#include "verification/bodies.hpp"
#include "verification/check.hpp"
#include "verification/convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kStripLength = 100.0;     // mm
constexpr double kStripHeight = 4.0;       // mm
constexpr double kLoad = 3.0;         // F L² / E I
constexpr double kDropTolerance = 0.005;  // of the length
constexpr double kFinestDropError = 0.01;  // of the drop: greatest allowed error of the finest mesh
const std::vector<int> kStripCells{4, 8, 16};
constexpr int kCellsAlongPerCell = 16;

PlaneBeam beam_per_width() {
  const double e = Material{}.youngs_modulus_kpa;
  PlaneBeam beam;
  beam.length_mm = kStripLength;
  beam.bending_stiffness = e * kStripHeight * kStripHeight * kStripHeight / 12.0;
  beam.axial_stiffness = e * kStripHeight;
  beam.shear_stiffness = 5.0 / 6.0 * 0.5 * e * kStripHeight;
  beam.force_mn = kLoad * beam.bending_stiffness / (kStripLength * kStripLength);
  return beam;
}

struct Bent {
  Vec3 tip;         // displacement, mm
  LineSeries line;  // centre line, in lengths
};

/// Returns the body laid along the beam's bent line, sections across it. Newton starts from this state, because from
/// rest a slender body would need many small steps. The result depends only on the balance of forces.
TissueState bent_as_the_beam(const TissueModel& model, int n) {
  const int cells = kCellsAlongPerCell * n;
  const std::vector<Vec2> line = bent_line(beam_per_width(), cells);
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) {
    const auto i = static_cast<std::size_t>(std::lround(p[0] / kStripLength * cells));
    const Vec2 along = (line[std::min(i + 1, line.size() - 1)] - line[i == 0 ? 0 : i - 1]).normalized();
    const double height = p[2] - 0.5 * kStripHeight;
    if (i > 0) p = Vec3(line[i][0] - height * along[1], p[1], 0.5 * kStripHeight + line[i][1] + height * along[0]);
  }
  return state;
}

/// At ν = 0 nothing changes across the width: one layer of cells represents the whole beam. Cells are 12.5/8 times as
/// long as high.
Bent bend(const CheckContext& context, int n) {
  const Material material{.poissons_ratio = 0.0};
  const double width = kStripHeight / n;
  const TissueModel model = make_tissue_model(
      make_block(Vec3(kStripLength, width, kStripHeight), {kCellsAlongPerCell * n, 1, n}), material,
      {FixedConstraint{plane_across(0, 0.0)}, symmetry_across(1), symmetry_across(1, width),
       TractionConstraint{plane_across(0, kStripLength), Vec3(0, 0, -beam_per_width().force_mn / kStripHeight)}});
  const TissueState start = bent_as_the_beam(model, n);
  const TissueState state = solved(context, model, &start, 1e-8).state;
  Bent bent{mean_displacement(model, state, plane_across(0, kStripLength)),
            {fmt::format("tets, {} over the height", n), {}, {}, false}};
  for (int i = 0; i <= 16; ++i) {
    const Region section = plane_across(0, kStripLength * i / 16.0);
    const Vec3 moved = mean_displacement(model, state, section) / kStripLength;
    bent.line.add(i / 16.0 + moved[0], moved[2]);
  }
  return bent;
}

}  // namespace

VerificationCheck elastica_tip(const CheckContext& context) {
  const std::vector<Vec2> line = bent_line(beam_per_width());
  VerificationCheck check = described(
      "Slender beam bent far by a tip force, F L²/EI = 3, ν = 0: drop of the tip, extrapolated at second order",
      "elastica (Bisshopp and Drucker 1945) with shear and stretch (Reissner 1972), integrated along the arc",
      "of the length", -line.back()[1] / kStripLength, kDropTolerance);
  LineSeries reference{"elastica", {}, {}, true};
  for (std::size_t i = 0; i < line.size(); i += 8) {
    reference.add(line[i][0] / kStripLength, line[i][1] / kStripLength);
  }
  check.plot = {"Beam bent far", "x / length", "z / length", false, false, {reference}};
  std::vector<double> drops;
  std::vector<double> errors;
  for (const int n : kStripCells) {
    const Bent bent = bend(context, n);
    drops.push_back(-bent.tip[2] / kStripLength);
    errors.push_back(drops.back() - check.expected);
    check.note += fmt::format("{} cells: {:.2f} % off, ", n, 100.0 * errors.back() / check.expected);
    if (n != kStripCells[1]) check.plot.series.push_back(bent.line);
  }
  require_small_error(errors.back() / check.expected, kFinestDropError);
  check.found = extrapolated(drops[0], drops[1], drops[2]);
  check.note += fmt::format("order {:.2f}", observed_rate(errors[1], errors[2]));
  return check;
}

}  // namespace incise
