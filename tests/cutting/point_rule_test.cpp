#include "point_rule.hpp"

#include "cutting/ring_in_a_block.hpp"
#include "cutting/same_incision.hpp"
#include "fragments.hpp"
#include "parted_tissue.hpp"
#include "point_kerf.hpp"

#include <incise/core/random.hpp>
#include <incise/cutting/cut_invariants.hpp>
#include <incise/cutting/incision_progress.hpp>
#include <incise/mechanics/statics.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace incise {
namespace {

using testing::expect_same;

const std::vector<Constraint> kHeldBelow{FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(50, 50, 0.1))}}};
const std::vector<Constraint> kHeldWhole{FixedConstraint{SphereRegion{Vec3::Zero(), 1e3}}};

TEST(PointLattice, StandsForTheVolumeOfEachTetWithNodesThatLieInIt) {
  for (const int cells : {2, 24}) {  // tets of many nodes, and of fewer than four
    const TissueModel model = make_tissue_model(make_block({6, 6, 6}, {cells, cells, cells}), Material{}, kHeldBelow);
    PointLattice lattice(model, {});
    for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) lattice.add(TetId(t));
    std::set<PointLattice::Node> nodes;
    std::size_t of_nodes = 0;
    for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) {
      const auto [first, last] = lattice.points_of(TetId(t));
      double volume = 0.0;
      for (std::size_t i = first; i < last; ++i) {
        volume += lattice.volume_mm3(i);
        for (const double share : lattice.shares(i)) ASSERT_GE(share, 0.0);
        if (!lattice.node_of(i)) continue;
        nodes.insert(*lattice.node_of(i));
        ++of_nodes;
        EXPECT_NEAR(
            (lattice.position(i, model.mesh.vertices) - PointLattice::rest_position(*lattice.node_of(i))).norm(), 0.0,
            1e-9);
      }
      ASSERT_NEAR(volume, model.volumes_mm3[t], 1e-12);
    }
    EXPECT_EQ(of_nodes, nodes.size()) << "each node in one tet";
    EXPECT_EQ(nodes.size(), 27000U) << "of a body of 216 mm³";
  }
}

/// A straight pass along y at x = 6 through a block, deep enough that the tip's end does not matter half-way down.
class StraightPass : public ::testing::Test {
 protected:
  StraightPass() { settings_.rule = CutRule::Lattice; }

  ToolPose at(double y) const { return {Vec3(6.0, y, 1.0), -Vec3::UnitZ(), Vec3::UnitY()}; }

  void pass(const TissueModel& model, double from, double to, int threads = 2) {
    Workers workers(threads);
    CutWorkspace workspace(model, model.mesh.vertices);
    state_ = begin_cut(model, rest_state(model), at(from));
    const double step_mm = settings_.advance_per_step_mm;
    for (double y = from + step_mm; y < to; y += step_mm) {
      reports_.push_back(
          advance(model, settings_, Needle{}, state_, workspace, at(y), step_mm / settings_.speed_mm_s, workers));
      EXPECT_THAT(cut_invariants(model, state_), ::testing::IsEmpty());
    }
  }

  /// Of the kerf in tissue that cannot move: at a distance y beside the way, the dose is
  /// (ℓ / (v d τ0)) (1 − y²/R²)^(5/2).
  [[nodiscard]] double half_width_mm() const {
    const double on_the_way = settings_.dose_length_mm / (settings_.speed_mm_s * settings_.dwell_s());
    return settings_.kernel_radius_mm * std::sqrt(1.0 - std::pow(on_the_way, -0.4));
  }
  /// Within 1 mm of a place along the pass.
  [[nodiscard]] static Box3 part_of(const TriMesh& surface, double y) {
    Box3 box;
    for (const Vec3& v : surface.vertices) {
      if (std::abs(v.y() - y) < 1.0) box.extend(v);
    }
    return box;
  }

  CutSettings settings_;
  CutState state_;
  std::vector<CutStepReport> reports_;
};

TEST_F(StraightPass, ThroughTissueThatCannotMoveLeavesTheKerfOfItsKernel) {
  const TissueModel model = make_tissue_model(make_block({12, 12, 6}, {12, 12, 6}), Material{}, kHeldWhole);
  settings_.dullness = 5.0;
  settings_.advance_per_step_mm = 0.13;
  pass(model, 1.0, 11.0);
  const PointKerf kerf(model, state_.points, model.mesh.vertices);
  double volume = 0.0;
  for (const auto& [a, b, c, d] : kerf.tets()) volume += std::abs(signed_volume(a, b, c, d));
  const TriMesh surface = kerf.surface();
  EXPECT_NEAR(enclosed_volume_mm3(surface), volume, 0.03 * volume);
  const Box3 box = part_of(surface, 6.0);
  EXPECT_NEAR(box.sizes().x(), 2.0 * half_width_mm(), 0.03);
  EXPECT_NEAR(box.center().x(), 6.0, 0.005);
  EXPECT_EQ(state_.record.removals.size(), 0U)
      << "no tet of 1 mm is empty: the kerf is " << 2.0 * half_width_mm() << " mm wide";
}

TEST_F(StraightPass, ThroughFineTetsEmptiesAndRemovesThoseInTheMiddleOfTheSameKerf) {
  const TissueModel model = make_tissue_model(make_block({8, 8, 4}, {20, 20, 10}), Material{}, kHeldWhole);
  settings_.dullness = 5.0;
  settings_.advance_per_step_mm = 0.13;
  pass(model, 1.0, 7.0);
  const Box3 box = part_of(PointKerf(model, state_.points, model.mesh.vertices).surface(), 4.0);
  EXPECT_NEAR(box.sizes().x(), 2.0 * half_width_mm(), 0.03);
  ASSERT_GT(state_.record.removals.size(), 20U);
  for (const Removal& removal : state_.record.removals)
    EXPECT_LT(std::abs(removal.centroid_mm.x() - 6.0), half_width_mm() + 0.01) << "in the kerf";
}

TEST_F(StraightPass, AWorkspaceMayBeTakenBackToAnEarlierState) {
  const TissueModel model = make_tissue_model(make_block({12, 12, 6}, {6, 6, 3}), Material{}, kHeldBelow);
  Workers workers(1);
  CutWorkspace workspace(model, model.mesh.vertices), fresh(model, model.mesh.vertices);
  CutState early = begin_cut(model, rest_state(model), at(1.0));
  CutState late = early;
  for (int i = 1; i <= 12; ++i)
    static_cast<void>(advance(model, settings_, Needle{}, late, workspace, at(1.0 + 0.5 * i), 0.02, workers));
  CutState alone = early;
  static_cast<void>(advance(model, settings_, Needle{}, early, workspace, at(1.26), 0.02, workers));
  static_cast<void>(advance(model, settings_, Needle{}, alone, fresh, at(1.26), 0.02, workers));
  EXPECT_THAT(cut_invariants(model, early), ::testing::IsEmpty());
  EXPECT_EQ(early.points.dose, alone.points.dose);
  // To another cut that has done as many steps.
  CutState other = begin_cut(model, rest_state(model), at(6.0));
  CutState other_alone = other;
  CutWorkspace another(model, model.mesh.vertices);
  for (const double y : {6.26, 6.52}) {
    static_cast<void>(advance(model, settings_, Needle{}, other, workspace, at(y), 0.02, workers));
    static_cast<void>(advance(model, settings_, Needle{}, other_alone, another, at(y), 0.02, workers));
  }
  EXPECT_THAT(cut_invariants(model, other), ::testing::IsEmpty());
  EXPECT_EQ(other.points.dose, other_alone.points.dose);
}

TEST_F(StraightPass, WhatHangsTogetherSharesItsFaceAndNothingElseIsJoined) {
  settings_.dullness = 4.0;
  for (const double edge_mm : {0.6, 1.0, 1.5}) {
    SCOPED_TRACE(edge_mm);
    const auto cells = [edge_mm](double mm) { return static_cast<int>(std::lround(mm / edge_mm)); };
    TetMesh mesh = make_block({12, 10, 6}, {cells(12), cells(10), cells(6)});
    Random random(7);
    for (Vec3& p : mesh.vertices) {  // no face lies along the way
      const bool is_inner = p.x() > 0.1 && p.x() < 11.9 && p.y() > 0.1 && p.y() < 9.9 && p.z() > 0.1 && p.z() < 5.9;
      for (int a = 0; a < 3 && is_inner; ++a) p[a] += random.uniform(-0.2, 0.2) * edge_mm;
    }
    const TissueModel model = make_tissue_model(std::move(mesh), Material{}, kHeldWhole);
    pass(model, -1.0, 7.0);  // from outside to its middle
    Workers workers(2);
    CutWorkspace workspace(model, model.mesh.vertices);
    static_cast<void>(advance(model, settings_, Needle{}, state_, workspace, std::nullopt, 0.02, workers));
    ASSERT_FALSE(state_.splits.vertices.empty());

    const TetMesh split = split_mesh(model.mesh, state_.splits);
    const PointLattice lattice = lattice_of(model, state_.points);
    std::map<PointLattice::Node, std::size_t> left;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      if (lattice.node_of(i) && lattice.volume_mm3(i) > 0.0 && state_.points.dose[i] < 1.0)
        left[*lattice.node_of(i)] = i;
    }
    const auto shared = [](const Tet& a, const Tet& b) {
      return std::ranges::count_if(a, [&b](VertexId v) { return std::ranges::find(b, v) != b.end(); });
    };
    std::size_t pairs = 0, broken = 0;
    for (const auto& [node, i] : left) {
      for (int axis = 0; axis < 3; ++axis) {
        PointLattice::Node next = node;
        ++next[static_cast<std::size_t>(axis)];
        if (!left.contains(next)) continue;
        const std::size_t k = left.at(next);
        const Tet& a = model.mesh.tets[lattice.tet_of(i).index()];
        const Tet& b = model.mesh.tets[lattice.tet_of(k).index()];
        if (lattice.tet_of(i) == lattice.tet_of(k) || shared(a, b) != 3) continue;
        ++pairs;
        broken += shared(split.tets[state_.points.tet_of[i].index()], split.tets[state_.points.tet_of[k].index()]) < 3
                      ? 1
                      : 0;
      }
    }
    EXPECT_GT(pairs, 1000U);
    EXPECT_EQ(broken, 0U);

    const FaceAdjacency adjacency = face_adjacency(split, state_.splits.copies);
    std::vector<std::vector<std::size_t>> around(split.vertices.size());
    for (std::size_t t = 0; t < split.tets.size(); ++t) {
      for (const VertexId v : split.tets[t]) {
        if (state_.tissue.is_live[t] != 0) around[v.index()].push_back(t);
      }
    }
    std::size_t hinges = 0;
    for (const std::vector<std::size_t>& tets : around) {
      std::set<std::size_t> unseen(tets.begin(), tets.end());
      std::vector<std::size_t> group;
      const auto see = [&](std::size_t t) {
        if (unseen.erase(t) > 0) group.push_back(t);
      };
      if (!tets.empty()) see(tets.front());
      for (std::size_t next = 0; next < group.size(); ++next) {
        for (const std::int32_t n : adjacency.of(group[next])) see(static_cast<std::size_t>(n));
      }
      hinges += unseen.empty() ? 0 : 1;
    }
    EXPECT_EQ(hinges, 0U) << "vertices that alone join tissue";
  }
}

TEST_F(StraightPass, PullsNoHarderThanItsSlipWhateverTheStep) {
  const TissueModel model =
      make_tissue_model(make_block({12, 16, 6}, {12, 16, 6}), {.youngs_modulus_kpa = 12.0}, kHeldBelow);
  settings_.slip_mn_mm = 15.0;
  settings_.residual_tolerance = 1e-3;
  std::vector<double> steady;
  for (const double step_mm : {0.13, 0.26, 0.52}) {
    settings_.advance_per_step_mm = step_mm;
    reports_.clear();
    pass(model, 1.0, 12.0);
    double sum = 0.0;
    const std::size_t half = reports_.size() / 2;
    for (std::size_t i = half; i < reports_.size(); ++i) sum += reports_[i].tool_force_mn.norm();
    steady.push_back(sum / static_cast<double>(reports_.size() - half));
    EXPECT_GT(reports_.back().slipped, 0U);
    // Six millimetres of tissue above the tip, of which hats reach half a millimetre beyond.
    EXPECT_LE(reports_.back().tool_force_mn.norm(), 15.0 * 5.5 * 1.001);
  }
  EXPECT_NEAR(steady[0], steady[1], 0.03 * steady[1]);
  EXPECT_NEAR(steady[2], steady[1], 0.06 * steady[1]);
}

TEST_F(StraightPass, WithoutSlipPullsHarder) {
  const TissueModel model =
      make_tissue_model(make_block({12, 16, 6}, {12, 16, 6}), {.youngs_modulus_kpa = 12.0}, kHeldBelow);
  settings_.slip_mn_mm.reset();
  pass(model, 1.0, 6.0);
  EXPECT_GT(reports_.back().tool_force_mn.norm(), 15.0 * 5.5 * 1.5);
  EXPECT_LT(reports_.back().tool_force_mn.y(), 0.0) << "the tissue pulls the tool back";
  EXPECT_EQ(reports_.back().slipped, 0U);
}

TEST_F(StraightPass, TissueTwiceAsToughTakesTwiceTheDose) {
  TissueModel model = make_tissue_model(make_block({12, 12, 6}, {6, 6, 3}), Material{}, kHeldWhole);
  pass(model, 1.0, 11.0);
  const std::vector<double> soft = state_.points.dose;
  model.toughness.assign(model.mesh.tets.size(), 2.0);
  pass(model, 1.0, 11.0);
  ASSERT_EQ(state_.points.dose.size(), soft.size());
  for (std::size_t i = 0; i < soft.size(); ++i) ASSERT_NEAR(state_.points.dose[i], 0.5 * soft[i], 1e-12);
}

TEST_F(StraightPass, InvariantsFindPointsThatCannotBe) {
  const TissueModel model = make_tissue_model(make_block({12, 12, 6}, {6, 6, 3}), Material{}, kHeldBelow);
  pass(model, 1.0, 4.0);
  const CutState sound = state_;
  state_.points.dose[3] = -0.1;
  EXPECT_EQ(cut_invariants(model, state_).size(), 1U);
  state_ = sound;
  state_.tissue.fill[state_.points.tets.front().index()] = 1.5;
  EXPECT_EQ(cut_invariants(model, state_).size(), 1U);
  state_ = sound;
  state_.points.dose.pop_back();
  EXPECT_EQ(cut_invariants(model, state_).size(), 1U);
  state_ = sound;
  for (const TetId elsewhere :
       {TetId(), TetId(100000000), TetId((sound.points.tet_of[0].index() + 1) % model.mesh.tets.size())}) {
    state_.points.tet_of[0] = elsewhere;
    EXPECT_EQ(cut_invariants(model, state_).size(), 1U) << elsewhere.value;
  }
}

TEST_F(StraightPass, SettingsOfTheOtherRuleAreRefused) {
  settings_.tear_energy_kpa = 10.0;
  settings_.slip_mm = 1.0;
  EXPECT_EQ(validate(settings_, 1.0).size(), 2U);
  settings_.rule = CutRule::Tets;
  EXPECT_TRUE(validate(settings_, 1.0).empty());
}

/// A disc of tissue in plane strain, held at its rim, with the tool through its middle.
class RodInADisc : public ::testing::Test {
 protected:
  static constexpr double kRimMm = 16.0, kThicknessMm = 2.0;

  /// The mesh of a square, drawn to the disc; in the middle the tets have 0.4 of their mean size.
  static TetMesh disc(int cells) {
    TetMesh mesh = make_block({2.0, 2.0, kThicknessMm}, {cells, cells, cells / 8});
    DataArray rim{1, {}};
    for (Vec3& p : mesh.vertices) {
      const double x = p.x() - 1.0, y = p.y() - 1.0;
      rim.values.push_back(std::max(std::abs(x), std::abs(y)) > 1.0 - 1e-9 ? 1.0 : 0.0);
      p.x() = x * std::sqrt(1.0 - 0.5 * y * y);
      p.y() = y * std::sqrt(1.0 - 0.5 * x * x);
      p.head<2>() *= kRimMm * (0.4 + 0.6 * p.head<2>().squaredNorm());
    }
    mesh.point_data["rim"] = std::move(rim);
    return mesh;
  }

  /// Its lateral stiffness over the closed one, less 1; tets in the middle have edges of 12.8 mm / cells.
  static double excess_stiffness(int cells);
};

// The displacement of a point force in a disc of radius b with a held rim, averaged with the kernel's weights over both
// places: (1 / (8 π μ (1 − ν))) ((3 − 4ν) (ln b − <ln r>) − 1 / (3 − 4ν)), from the plane Kelvin solution and the rigid
// cylinder in a held ring (Baguelin, Frank and Said 1977). Of two places of weight (1 − s²/R²)², ln r is on average
// that of the farther one from the axis: <ln r> = ln R − 73/120. The hold is a spring in series.
double RodInADisc::excess_stiffness(int cells) {
  constexpr double kNu = 0.3, kShiftMm = 0.02;
  const TissueModel model = make_tissue_model(disc(cells), {.youngs_modulus_kpa = 12.0, .poissons_ratio = kNu},
                                              {FixedConstraint{SphereRegion{Vec3::Zero(), 1e3}, {false, false, true}},
                                               FixedConstraint{PointArrayRegion{"rim", 1.0}, {true, true, true}}});
  CutSettings settings;
  settings.rule = CutRule::Lattice;
  settings.dullness = 1e9;
  settings.slip_mn_mm.reset();
  settings.residual_tolerance = 1e-6;
  const auto at = [](double y) { return ToolPose{Vec3(0, y, -3.0), -Vec3::UnitZ(), Vec3::UnitY()}; };
  Workers workers(2);
  CutWorkspace workspace(model, model.mesh.vertices, Precision::Double);
  CutState state = begin_cut(model, rest_state(model), at(0.0));
  static_cast<void>(advance(model, settings, Needle{}, state, workspace, at(0.0), 0.02, workers));  // takes hold
  CutStepReport report;
  for (int i = 0; i < 60; ++i)
    report = advance(model, settings, Needle{}, state, workspace, at(kShiftMm), 0.02, workers);

  const double mu = 12.0 / (2.0 * (1.0 + kNu)), spread = 3.0 - 4.0 * kNu;
  const double ln_ratio = std::log(kRimMm / settings.kernel_radius_mm) + 73.0 / 120.0;
  const double compliance = (spread * ln_ratio - 1.0 / spread) / (8.0 * M_PI * mu * (1.0 - kNu));
  const double expected_mn = kThicknessMm * kShiftMm / (compliance + 1.0 / settings.hold_kpa);
  return -report.tool_force_mn.y() / expected_mn - 1.0;
}

TEST_F(RodInADisc, HasTheLateralStiffnessOfItsClosedSolution) {
  for (const int cells : {32, 40, 48}) EXPECT_NEAR(excess_stiffness(cells), 0.0, 0.03) << cells;
}

TEST_F(RodInADisc, ComesNearItWithTheSquareOfTheEdge) {
  const double coarse = excess_stiffness(16), fine = excess_stiffness(32);
  EXPECT_LT(coarse, 0.1) << "0.8 mm";
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.3);
}

/// A block pulled at its far end, that a deep tool passes through from side to side: it falls in two.
class CutInTwo : public ::testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  static constexpr double kPullMm = 1.0;

  /// So many cells along, of elastic or of viscous tissue.
  static TissueModel block(int cells, bool is_viscous) {
    Material material{.youngs_modulus_kpa = 70.0, .poissons_ratio = 0.3};
    if (is_viscous) material.prony = {{0.4, 0.1}, {0.3, 2.0}};
    return make_tissue_model(
        make_block({12, 6, 4}, {cells, cells / 2, cells / 3}), material,
        {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(0.1, 9, 9))}},
         DisplacedConstraint{BoxRegion{Box3(Vec3(11.9, -1, -1), Vec3(13, 9, 9))}, Vec3(kPullMm, 0, 0)}});
  }
  CutInTwo() : model_(block(std::get<0>(GetParam()), std::get<1>(GetParam()))) {
    settings_.rule = CutRule::Lattice;
    settings_.dullness = 3.0;
    settings_.residual_tolerance = 1e-3;
    settings_.hold_kpa = 0.0;
  }
  static ToolPose at(double y) { return {Vec3(6.3, y, -2.0), -Vec3::UnitZ(), Vec3::UnitY()}; }

  void cut_through() {
    Workers workers(2);
    Monitor silent;
    const StaticResult stretched = solve_static(model_, StaticSettings{}, workers, silent);
    ASSERT_EQ(stretched.outcome, Outcome::Success);
    before_ = stretched.state.positions;
    state_ = begin_cut(model_, stretched.state, at(-2.0));
    remember_deformation(model_, state_.tissue, 1.0);
    CutWorkspace workspace(model_, before_, Precision::Double);
    const double step_mm = settings_.advance_per_step_mm;
    for (double y = -2.0 + step_mm; y < 8.0; y += step_mm) {
      static_cast<void>(
          advance(model_, settings_, Needle{}, state_, workspace, at(y), step_mm / settings_.speed_mm_s, workers));
      ASSERT_THAT(cut_invariants(model_, state_), ::testing::IsEmpty());
    }
    for (int i = 0; i < 60; ++i) {
      const CutStepReport report = advance(model_, settings_, Needle{}, state_, workspace, std::nullopt, 0.02, workers);
      ASSERT_TRUE(report.is_finite);
    }
    ASSERT_THAT(cut_invariants(model_, state_), ::testing::IsEmpty());
  }

  TissueModel model_;
  CutSettings settings_;
  CutState state_;
  Points before_;
};

TEST_P(CutInTwo, EachPartGoesBackToItsShapeAtRest) {
  cut_through();
  const TetMesh split = split_mesh(model_.mesh, state_.splits);
  // No face joins the parts, and each is one.
  const FaceAdjacency neighbours = face_adjacency(split, state_.splits.copies);
  std::vector<std::uint8_t> is_left = state_.tissue.is_live;
  int parts = 0;
  for (std::size_t seed = 0; seed < split.tets.size(); ++seed) {
    if (is_left[seed] == 0) continue;
    ++parts;
    std::vector<std::size_t> part{seed};
    is_left[seed] = 0;
    for (std::size_t next = 0; next < part.size(); ++next) {
      for (const std::int32_t n : neighbours.of(part[next])) {
        if (is_left[static_cast<std::size_t>(n)] == 0) continue;
        is_left[static_cast<std::size_t>(n)] = 0;
        part.push_back(static_cast<std::size_t>(n));
      }
    }
  }
  EXPECT_EQ(parts, 2);
  // Nothing pulls at either any more: the one lies where it was, the other a pull farther.
  for (std::size_t v = 0; v < split.vertices.size(); ++v) {
    const bool is_live = std::ranges::any_of(split.tets, [&](const Tet& tet) {
      const auto t = static_cast<std::size_t>(&tet - split.tets.data());
      return state_.tissue.is_live[t] != 0 && std::ranges::find(tet, VertexId(v)) != tet.end();
    });
    if (!is_live) continue;
    const Vec3 moved = state_.tissue.positions[v] - split.vertices[v];
    EXPECT_LT(std::min(moved.norm(), (moved - Vec3(kPullMm, 0, 0)).norm()), 2e-3)
        << v << " moved by " << moved.transpose();
  }
  // At both borders of the kerf, the tissue is that of its own side, wherever in a tet the border lies.
  const PartedTissue tissue(model_, before_, state_);
  const PointKerf kerf(model_, state_.points, before_);
  const TriMesh surface = kerf.surface();
  std::size_t left = 0, right = 0;
  for (const Vec3& p : surface.vertices) {
    if (p.y() < 1.0 || p.y() > 5.0 || p.z() < 1.0 || p.z() > 3.0) continue;
    const std::optional<Vec3> moved = tissue.displacement(p, 0.5);
    ASSERT_TRUE(moved);
    const Vec3 after = p + *moved;
    // In the stretched block the tool stood at x = 6.3 and stayed there, since it holds nothing.
    (p.x() < 6.3 ? left : right) += 1;
    const double rest_x = p.x() < 6.3 ? after.x() : after.x() - kPullMm;
    EXPECT_NEAR(rest_x, p.x() * 12.0 / 13.0, 0.15);
  }
  EXPECT_GT(left, 50U);
  EXPECT_GT(right, 50U);
}
INSTANTIATE_TEST_SUITE_P(OfCells, CutInTwo,
                         ::testing::Values(std::tuple(6, false), std::tuple(12, false), std::tuple(18, false),
                                           std::tuple(12, true)));

class RingByPoints : public testing::RingInABlock {
 protected:
  RingByPoints() : RingInABlock(16) {
    settings_.tool = Needle{};
    settings_.cut.rule = CutRule::Lattice;
    settings_.cut.advance_per_step_mm = 0.5;
  }
  [[nodiscard]] IncisionResult carry_on(IncisionProgress progress, int threads, Monitor& monitor,
                                        const ProgressKeeper& keep = {}) const {
    Workers workers(threads);
    return continue_incision(model_, rest_state(model_), ring(4.0), settings_, std::move(progress), workers, monitor,
                             keep);
  }
  [[nodiscard]] IncisionProgress begin() const {
    return begin_incision(model_, rest_state(model_), ring(4.0), settings_);
  }
};

TEST_F(RingByPoints, ClosesAndHasTheSameBitsAtAnyThreadCountAndFromACheckpoint) {
  Monitor silent;
  const IncisionResult straight = carry_on(begin(), 1, silent);
  EXPECT_EQ(straight.outcome, Outcome::Success);
  ASSERT_TRUE(straight.centerline.has_value());
  EXPECT_NEAR(mean_radius(*straight.centerline), kRadiusMm, 0.5);
  EXPECT_GT(straight.kerf.drag.value().lag.mean, 0.0);
  ASSERT_TRUE(straight.inner_edge.has_value());
  EXPECT_LT(mean_radius(*straight.kerf.inner_edge_reference), mean_radius(*straight.centerline));
  EXPECT_TRUE(straight.kerf.final_centerline.has_value());
  EXPECT_FALSE(straight.final_state.splits.vertices.empty());
  expect_same(straight, carry_on(begin(), 3, silent), "three threads");
  StopAtHalf half;
  std::optional<IncisionProgress> kept;
  static_cast<void>(carry_on(begin(), 2, half, [&](const IncisionProgress& progress, bool is_interrupted) {
    if (is_interrupted) kept = progress;
  }));
  ASSERT_TRUE(kept.has_value());
  const IncisionResult resumed = carry_on(*kept, 2, silent);
  expect_same(straight, resumed, "from a checkpoint");
  EXPECT_EQ(straight.final_state.points.dose, resumed.final_state.points.dose);
  EXPECT_EQ(straight.final_state.splits, resumed.final_state.splits);
  EXPECT_EQ(straight.inner_edge->points, resumed.inner_edge->points);
}

}  // namespace
}  // namespace incise
