#include <incise/core/error.hpp>
#include <incise/cutting/cut_invariants.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace incise {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A 10 x 6 x 6 mm block with cells of 1 mm, in which a needle has gone 3 mm and still holds tissue.
struct Cut {
  TissueModel model;
  CutState state;
  std::size_t violations_on_the_way = 0;
};

ToolPose at(double x) {
  return {Vec3(x, 3.1, 2.0), -Vec3::UnitZ()};
}

const Cut& cut() {
  static const Cut made = [] {
    Cut c{make_tissue_model(make_block({10, 6, 6}, {10, 6, 6}), Material{},
                            {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(11, 7, 0.1))}}}),
          {}};
    c.state = begin_cut(c.model, rest_state(c.model), at(3.2));
    Workers workers(1);
    CutWorkspace workspace(c.model, c.state.tissue.positions);
    CutSettings settings{.dullness = 4.0};
    for (int i = 1; i <= 12; ++i) {
      static_cast<void>(advance(c.model, settings, Needle{}, c.state, workspace, at(3.2 + 0.25 * i),
                                settings.reference_step_s, workers));
      c.violations_on_the_way += cut_invariants(c.model, c.state).size();
    }
    return c;
  }();
  return made;
}

/// What is found after one thing was broken on purpose; the first sentence, or nothing.
std::string found_after(const std::function<void(CutState&)>& breaking) {
  CutState broken = cut().state;
  breaking(broken);
  const std::vector<std::string> found = cut_invariants(cut().model, broken);
  return found.empty() ? "" : found.front();
}

::testing::AssertionResult says(const std::string& found, const std::string& expected) {
  if (found.find(expected) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "expected a sentence with \"" << expected << "\", found \"" << found << "\"";
}

TEST(CutInvariants, HoldAtEveryStepOfACut) {
  EXPECT_EQ(cut().violations_on_the_way, 0U);
  EXPECT_GT(cut().state.record.removals.size(), 20U) << "the cut has to remove something for this to mean anything";
  EXPECT_FALSE(cut().state.bonds.empty());
}

TEST(CutInvariants, SeeATetThatVanishedWithoutARecord) {
  EXPECT_TRUE(
      says(found_after([](CutState& s) { s.tissue.is_live[0] = 0; }), "tet 0 was removed but is not in the record"));
}

TEST(CutInvariants, SeeARemovedTetThatLives) {
  EXPECT_TRUE(says(found_after([](CutState& s) { s.tissue.is_live[s.record.removals[0].tet.index()] = 1; }),
                   "is live but is in the record"));
}

TEST(CutInvariants, SeeATetThatWasRemovedTwice) {
  EXPECT_TRUE(says(found_after([](CutState& s) { s.record.removals.push_back(s.record.removals.front()); }),
                   "was removed twice"));
}

TEST(CutInvariants, SeeATetThatTheMeshDoesNotHave) {
  EXPECT_TRUE(
      says(found_after([](CutState& s) { s.record.removals.front().tet = TetId(1000000); }), "names tet 1000000"));
}

TEST(CutInvariants, SeeARecordOutOfOrder) {
  EXPECT_TRUE(says(found_after([](CutState& s) { std::swap(s.record.removals.front(), s.record.removals.back()); }),
                   "does not follow"));
}

TEST(CutInvariants, SeeAWrongRestVolume) {
  EXPECT_TRUE(says(found_after([](CutState& s) { s.record.removals.front().rest_volume_mm3 *= 1.0 + 1e-12; }),
                   "has a rest volume of"));
}

TEST(CutInvariants, SeeARemovalAheadOfItsTime) {
  EXPECT_TRUE(
      says(found_after([](CutState& s) { s.record.removals.back().time_s = s.time_s + 0.01; }), "the cut is at step"));
}

TEST(CutInvariants, SeeLostVolume) {
  const std::vector<std::string> found = [] {
    CutState broken = cut().state;
    broken.record.removals.pop_back();
    return cut_invariants(cut().model, broken);
  }();
  ASSERT_GE(found.size(), 2U);
  EXPECT_TRUE(says(found[1], "live and removed rest volume are"));
}

TEST(CutInvariants, SeeLostMass) {
  TissueModel broken = cut().model;
  broken.vertex_mass_kg.front() *= 1.001;
  const std::vector<std::string> found = cut_invariants(broken, cut().state);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(says(found.front(), "live and removed mass are"));
}

TEST(CutInvariants, SeeAPositionThatIsNotFinite) {
  EXPECT_TRUE(says(found_after([](CutState& s) { s.tissue.positions[7].y() = kNaN; }), "vertex 7 of live tet"));
}

TEST(CutInvariants, SeeADoseThatIsNone) {
  EXPECT_TRUE(says(found_after([](CutState& s) { s.dose[5] = kNaN; }), "dose: tet 5 has"));
}

TEST(CutInvariants, SeeTearingBeyondTheDose) {
  EXPECT_TRUE(says(found_after([](CutState& s) { s.tear_dose[5] = s.dose[5] + 1e-9; }), "dose: tet 5 has"));
}

TEST(CutInvariants, SeeABondToWhatIsGone) {
  EXPECT_TRUE(says(found_after([](CutState& s) { s.bonds.front().tet = s.record.removals.front().tet; }),
                   "is held but was removed"));
}

TEST(CutInvariants, SeeBondsOutOfOrder) {
  EXPECT_TRUE(says(found_after([](CutState& s) { std::swap(s.bonds.front(), s.bonds.back()); }), "bonds: tet"));
}

TEST(CutInvariants, SeeABondWithoutAnOffset) {
  EXPECT_TRUE(says(found_after([](CutState& s) { s.bonds.front().offset_mm.x() = kNaN; }), "the offset of tet"));
}

TEST(CutInvariants, RefuseAStateOfAnotherMesh) {
  CutState other = cut().state;
  other.dose.pop_back();
  EXPECT_THROW(static_cast<void>(cut_invariants(cut().model, other)), InvalidArgument);
}

}  // namespace
}  // namespace incise
