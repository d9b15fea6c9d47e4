#include "point_rule.hpp"

#include "cutting/ring_in_a_block.hpp"
#include "cutting/same_incision.hpp"
#include "fragments.hpp"
#include "parted_tissue.hpp"
#include "point_kerf.hpp"

#include <incise/core/random.hpp>
#include <incise/cutting/cut_invariants.hpp>
#include <incise/cutting/divided_mesh.hpp>
#include <incise/cutting/incision_progress.hpp>
#include <incise/mechanics/statics.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <functional>
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

/// Half the width of the kerf in tissue that cannot move: at a distance y beside the way, the dose is
/// (ℓ / (v d τ0)) (1 − y²/R²)^(5/2).
double half_kerf_mm(const CutSettings& settings) {
  const double on_the_way = settings.dose_length_mm / (settings.speed_mm_s * settings.dwell_s());
  return settings.kernel_radius_mm * std::sqrt(1.0 - std::pow(on_the_way, -0.4));
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

  [[nodiscard]] double half_width_mm() const { return half_kerf_mm(settings_); }
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
  settings_.dullness = 9.0;
  settings_.advance_per_step_mm = 0.13;
  pass(model, 1.0, 11.0);
  const PointLattice lattice = lattice_of(model, state_.points);
  const PointKerf kerf(model, lattice, state_.points, model.mesh.vertices);
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
  settings_.dullness = 9.0;
  settings_.advance_per_step_mm = 0.13;
  pass(model, 1.0, 7.0);
  const PointLattice lattice = lattice_of(model, state_.points);
  const Box3 box = part_of(PointKerf(model, lattice, state_.points, model.mesh.vertices).surface(), 4.0);
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

/// What a workspace remembers of one cut is not taken for what another has at the same step and nearly the same place.
TEST_F(StraightPass, AWorkspaceTakesAnotherCutAtTheSameStepForAnother) {
  const TissueModel model = make_tissue_model(make_block({12, 12, 6}, {6, 6, 3}), Material{}, kHeldBelow);
  Workers workers(1);
  const auto cut = [&](double from, CutWorkspace& workspace) {
    CutState state = begin_cut(model, rest_state(model), at(from));
    for (int i = 1; i <= 5; ++i)
      static_cast<void>(advance(model, settings_, Needle{}, state, workspace, at(from + 0.5 * i), 0.02, workers));
    return state;
  };
  CutWorkspace ones(model, model.mesh.vertices), others(model, model.mesh.vertices), fresh(model, model.mesh.vertices);
  static_cast<void>(cut(1.0, ones));
  CutState other = cut(3.5, others), alone = other;
  static_cast<void>(advance(model, settings_, Needle{}, other, ones, at(6.5), 0.02, workers));
  static_cast<void>(advance(model, settings_, Needle{}, alone, fresh, at(6.5), 0.02, workers));
  EXPECT_EQ(other.points.dose, alone.points.dose);
  EXPECT_EQ(other.tissue.positions, alone.tissue.positions);
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

    const FaceAdjacency adjacency = split_adjacency(split, state_.splits, face_adjacency(model.mesh));
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

TEST_F(StraightPass, DragsTissueOfAnyStiffnessAlike) {
  const auto block = [](double modulus_kpa) {
    Material material{.youngs_modulus_kpa = modulus_kpa};
    material.density_kg_m3 = 1.0;  // weight would tell them apart
    return make_tissue_model(make_block({12, 16, 6}, {12, 16, 6}), material, kHeldBelow);
  };
  settings_.residual_tolerance = 1e-4;
  pass(block(12.0), 1.0, 6.0);
  const Points soft = state_.tissue.positions;
  const Vec3 force = reports_.back().tool_force_mn;
  pass(block(70.0), 1.0, 6.0);
  ASSERT_EQ(state_.tissue.positions.size(), soft.size());
  for (std::size_t v = 0; v < soft.size(); ++v) ASSERT_LT((state_.tissue.positions[v] - soft[v]).norm(), 0.02);
  EXPECT_NEAR(reports_.back().tool_force_mn.norm(), 70.0 / 12.0 * force.norm(), 0.03 * 70.0 / 12.0 * force.norm());
}

TEST_F(StraightPass, DragsTissueAlongUnlessItSlips) {
  const TissueModel model =
      make_tissue_model(make_block({12, 16, 6}, {12, 16, 6}), {.youngs_modulus_kpa = 12.0}, kHeldBelow);
  const auto farthest_behind_mm = [&] {
    const TissueModel split = split_model(model, state_.splits);
    const PointLattice lattice(split, state_.points, state_.splits);
    double farthest = 0.0;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      if (state_.points.is_held[i] == 0 || state_.points.dose[i] >= 1.0) continue;
      Vec3 behind = lattice.position(i, state_.tissue.positions) - state_.tool.tip_mm - state_.points.offset_mm[i];
      behind.z() = 0.0;  // along the needle nothing is held
      farthest = std::max(farthest, behind.norm());
    }
    return farthest;
  };
  pass(model, 1.0, 6.0);
  const Vec3 force = reports_.back().tool_force_mn;
  EXPECT_GT(farthest_behind_mm(), 0.5);
  EXPECT_LT(force.y(), 0.0) << "the tissue pulls the tool back";
  EXPECT_EQ(reports_.back().slipped, 0U);
  settings_.slip_mm = 0.1;
  pass(model, 1.0, 6.0);
  EXPECT_LT(farthest_behind_mm(), 0.1 + settings_.advance_per_step_mm) << "points are held from a step's end on";
  EXPECT_GT(reports_.back().slipped, 0U);
  EXPECT_LT(reports_.back().tool_force_mn.norm(), 0.8 * force.norm());
}

TEST_F(StraightPass, TissueTwiceAsToughTakesTwiceTheDose) {
  TissueModel model = make_tissue_model(make_block({12, 12, 6}, {6, 6, 3}), Material{}, kHeldWhole);
  settings_.dullness = 17.0;  // nothing parts
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
  EXPECT_EQ(validate(settings_, 1.0).size(), 1U);
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

  static constexpr double kNu = 0.3, kModulusKpa = 12.0;

  /// The lateral stiffness of a hold of stiffness(r), kPa/mm², in a disc with a held rim, per thickness, kPa: from the
  /// displacements U cos θ and V sin θ, which is their form there, with U and V linear between many radii. What is held
  /// within `rigid_mm` does not move against the tool.
  static double reference_kpa(const std::function<double(double)>& stiffness, double rigid_mm = 0.0);
  /// Of the simulation over that, less 1; tets in the middle have edges of 12.8 mm / cells.
  static double excess_stiffness(int cells, double hold_per_mm2);
};

double RodInADisc::reference_kpa(const std::function<double(double)>& stiffness, double rigid_mm) {
  constexpr int kRadii = 4000;
  const double mu = kModulusKpa / (2.0 * (1.0 + kNu)), lambda = 2.0 * mu * kNu / (1.0 - 2.0 * kNu);
  const double step = (kRimMm - rigid_mm) / kRadii;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * (kRadii + 1));
  double of_tool = 0.0;  // energy of the hold where nothing moves, twice
  for (int i = 0; i < kRadii; ++i) {
    const double r = rigid_mm + (i + 0.5) * step, weight = M_PI * r * step, k = stiffness(r);
    // Rows of strain, of U and V at both ends: rr, θθ and 2 rθ; cos² and sin² have the mean 1/2.
    Eigen::Matrix<double, 3, 4> strain;
    strain << -1 / step, 0, 1 / step, 0, 0.5 / r, 0.5 / r, 0.5 / r, 0.5 / r,  //
        -0.5 / r, -1 / step - 0.5 / r, -0.5 / r, 1 / step - 0.5 / r;
    Mat3 law;
    law << lambda + 2 * mu, lambda, 0, lambda, lambda + 2 * mu, 0, 0, 0, mu;
    Eigen::Matrix4d part = strain.transpose() * law * strain;
    const Eigen::RowVector4d u(0.5, 0, 0.5, 0), v(0, 0.5, 0, 0.5);
    part += k * (u.transpose() * u + v.transpose() * v);
    const Eigen::Vector4d pull = k * (u - v).transpose();
    of_tool += 2.0 * k * weight;
    for (int a = 0; a < 4; ++a) {
      right[2 * i + a] += weight * pull[a];
      for (int b = 0; b < 4; ++b) entries.emplace_back(2 * i + a, 2 * i + b, weight * part(a, b));
    }
  }
  const auto hold = [&](int row, double value) {
    entries.emplace_back(row, row, 1e12);
    right[row] += 1e12 * value;
  };
  for (const int row : {2 * kRadii, 2 * kRadii + 1}) hold(row, 0.0);
  if (rigid_mm > 0.0) {
    hold(0, 1.0);
    hold(1, -1.0);
  }
  Eigen::SparseMatrix<double> matrix(2 * (kRadii + 1), 2 * (kRadii + 1));
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd x = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  if (rigid_mm > 0.0) return 1e12 * (1.0 - x[0]) - 1e12 * (-1.0 - x[1]);
  return of_tool - right.dot(x);
}

double RodInADisc::excess_stiffness(int cells, double hold_per_mm2) {
  constexpr double kShiftMm = 0.02;
  const TissueModel model = make_tissue_model(disc(cells), {.youngs_modulus_kpa = kModulusKpa, .poissons_ratio = kNu},
                                              {FixedConstraint{SphereRegion{Vec3::Zero(), 1e3}, {false, false, true}},
                                               FixedConstraint{PointArrayRegion{"rim", 1.0}, {true, true, true}}});
  CutSettings settings;
  settings.rule = CutRule::Lattice;
  settings.dullness = 1e9;
  settings.hold_per_mm2 = hold_per_mm2;
  settings.residual_tolerance = 1e-6;
  const auto at = [](double y) { return ToolPose{Vec3(0, y, -3.0), -Vec3::UnitZ(), Vec3::UnitY()}; };
  Workers workers(2);
  CutWorkspace workspace(model, model.mesh.vertices, Precision::Double);
  CutState state = begin_cut(model, rest_state(model), at(0.0));
  static_cast<void>(advance(model, settings, Needle{}, state, workspace, at(0.0), 0.02, workers));  // takes hold
  CutStepReport report;
  for (int i = 0; i < 60; ++i)
    report = advance(model, settings, Needle{}, state, workspace, at(kShiftMm), 0.02, workers);

  const double mu = kModulusKpa / (2.0 * (1.0 + kNu)), radius = settings.kernel_radius_mm;
  const double expected_kpa = reference_kpa([&](double r) {
    const double q = std::max(0.0, 1.0 - r * r / (radius * radius));
    return hold_per_mm2 * mu * q * q;
  });
  return -report.tool_force_mn.y() / (kThicknessMm * kShiftMm * expected_kpa) - 1.0;
}

// A rigid cylinder of radius a in a disc of radius b with a held rim, in plane strain: 8 π μ (1 − ν) /
// ((3 − 4ν) ln(b/a) − ((b² − a²) / (b² + a²)) / (3 − 4ν)) (Baguelin, Frank and Said 1977).
TEST_F(RodInADisc, ItsReferenceHasTheClosedSolutionOfARigidRod) {
  const double mu = kModulusKpa / (2.0 * (1.0 + kNu)), spread = 3.0 - 4.0 * kNu;
  for (const double a : {0.5, 1.25, 4.0}) {
    const double b = kRimMm, squares = (b * b - a * a) / (b * b + a * a);
    const double closed = 8.0 * M_PI * mu * (1.0 - kNu) / (spread * std::log(b / a) - squares / spread);
    EXPECT_NEAR(reference_kpa([](double) { return 0.0; }, a), closed, 2e-3 * closed) << a;
  }
}

TEST_F(RodInADisc, HasTheLateralStiffnessOfTheReference) {
  for (const int cells : {24, 32, 48})
    EXPECT_NEAR(excess_stiffness(cells, CutSettings().hold_per_mm2), 0.0, 0.03) << cells;
}

TEST_F(RodInADisc, ComesNearItWithTheSquareOfTheEdge) {
  const double hold_per_mm2 = CutSettings().hold_per_mm2;  // thinner layers, of 100 /mm², need finer meshes for this
  const double coarse = excess_stiffness(16, hold_per_mm2), fine = excess_stiffness(32, hold_per_mm2);
  EXPECT_GT(fine, 0.0);
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
    settings_.hold_per_mm2 = 0.0;
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
  const FaceAdjacency neighbours = split_adjacency(split, state_.splits, face_adjacency(model_.mesh));
  const FaceAdjacency by_faces = face_adjacency(split);
  const std::size_t whole = model_.mesh.tets.size();
  const auto whole_of = [&](std::size_t t) { return t < whole ? TetId(t) : state_.splits.copies[t - whole].whole; };
  for (std::size_t t = 0; t < split.tets.size(); ++t) {
    std::set<std::int32_t> expected(by_faces.of(t).begin(), by_faces.of(t).end());
    std::erase_if(expected, [&](std::int32_t n) { return whole_of(static_cast<std::size_t>(n)) == whole_of(t); });
    EXPECT_EQ(std::set<std::int32_t>(neighbours.of(t).begin(), neighbours.of(t).end()), expected) << t;
    EXPECT_EQ(neighbours.of(t).size(), expected.size()) << t;
  }
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
  const PointLattice lattice = lattice_of(model_, state_.points);
  const PartedTissue tissue(model_, lattice, before_, state_);
  const PointKerf kerf(model_, lattice, state_.points, before_);
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
TEST_P(CutInTwo, IsDrawnAsTwoBodiesWithTheKerfBetweenThem) {
  cut_through();
  const DividedMesh divided = divide_at_kerf(model_, state_);
  TetMesh mesh;
  mesh.vertices = divided.positions(split_mesh(model_.mesh, state_.splits).vertices);
  mesh.tets = divided.tets;
  const Points before = divided.positions(split_positions(before_, state_.splits));
  const Points after = divided.positions(state_.tissue.positions);
  const std::vector<std::uint8_t> is_left = divided.is_left(state_.step);
  double volume = 0.0, gone = 0.0, skin = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<Vec3, 4> at;
    for (std::size_t c = 0; c < 4; ++c) at[c] = vertex(mesh.vertices, mesh.tets[t][c]);
    const double piece = signed_volume(at[0], at[1], at[2], at[3]);
    ASSERT_GE(piece, 0.0);
    (is_left[t] != 0 ? volume : gone) += piece;
    for (int f = 0; f < 4; ++f) {
      const auto [a, b, c] = face_of(mesh.tets[t], f);
      const Vec3 from = vertex(mesh.vertices, a);
      const double area = 0.5 * (vertex(mesh.vertices, b) - from).cross(vertex(mesh.vertices, c) - from).norm();
      if ((divided.skin_faces[t] >> f & 1U) != 0) skin += area;
    }
  }
  EXPECT_NEAR(volume + gone, 12.0 * 6.0 * 4.0, 1e-9);
  EXPECT_NEAR(skin, 288.0, 1e-9);
  // The needle has gone through 6 x 4 mm; the width is that of tissue which nothing holds.
  double kerf = 0.0;
  const PointLattice lattice = lattice_of(model_, state_.points);
  for (const auto& [a, b, c, d] : PointKerf(model_, lattice, state_.points, model_.mesh.vertices).tets())
    kerf += std::abs(signed_volume(a, b, c, d));
  // Halves of edges of 2 mm hardly show a kerf of 2 mm.
  EXPECT_NEAR(gone, kerf, (std::get<0>(GetParam()) == 6 ? 0.15 : 0.06) * kerf);
  std::size_t walls = 0;
  const double a_third_of_a_cell = 12.0 / std::get<0>(GetParam()) / 3.0;
  for (const BoundaryFace& face : boundary_faces(mesh, is_left)) {
    int f = 0;
    while (face_of(mesh.tets[face.tet.index()], f) != face.corners) ++f;
    if ((divided.skin_faces[face.tet.index()] >> f & 1U) != 0) continue;
    ++walls;
    for (const VertexId v : face.corners)
      ASSERT_NEAR(vertex(before, v).x(), 6.3, half_kerf_mm(settings_) + a_third_of_a_cell) << "open within the tissue";
  }
  EXPECT_GT(walls, 50U);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (is_left[t] == 0) continue;
    double away = 0.0;  // of the whole piece: on its own side
    for (const VertexId v : mesh.tets[t])
      away = std::max(away, std::abs(vertex(after, v).x() - vertex(mesh.vertices, v).x() -
                                     (vertex(before, v).x() < 6.3 ? 0.0 : kPullMm)));
    ASSERT_LT(away, 2e-3);
  }
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
