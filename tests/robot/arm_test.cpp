#include "support/data_dir.hpp"

#include <incise/core/random.hpp>
#include <incise/core/units.hpp>
#include <incise/robot/arm.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <set>

namespace incise {
namespace {

constexpr double kPlaceMm = 1e-6;  // 1e-9 m
constexpr double kAngleRad = 1e-9;

/// The arm in Orocos KDL, metres, from Universal Robots' printed table.
KDL::Chain kdl_chain() {
  const double pi = units::kPi;
  const double table[6][3] = {{0, pi / 2, 0.1807},  {-0.6127, 0, 0},       {-0.57155, 0, 0},
                              {0, pi / 2, 0.17415}, {0, -pi / 2, 0.11985}, {0, 0, 0.11655}};
  KDL::Chain chain;
  for (const auto& row : table)
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame::DH(row[0], row[1], row[2], 0.0)));
  return chain;
}

KDL::JntArray kdl_joints(const Joints& q) {
  KDL::JntArray result(6);
  for (unsigned i = 0; i < 6; ++i) result(i) = q[i];
  return result;
}

Mat4 kdl_forward(const Joints& q) {
  static const KDL::Chain chain = kdl_chain();
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::Frame frame;
  EXPECT_GE(solver.JntToCart(kdl_joints(q), frame), 0);
  Mat4 result = Mat4::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result(i, j) = frame.M(i, j);
    result(i, 3) = units::mm_from_m(frame.p(i));
  }
  return result;
}

double gap_mm(const Mat4& a, const Mat4& b) {
  return (a - b).topRightCorner<3, 1>().norm();
}

/// Angle between two rotations, exact for small ones.
double angle_between(const Mat4& a, const Mat4& b) {
  const Mat3 turn = a.topLeftCorner<3, 3>().transpose() * b.topLeftCorner<3, 3>();
  const Vec3 twice(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  return std::atan2(0.5 * twice.norm(), 0.5 * (turn.trace() - 1.0));
}

void expect_same_pose(const Mat4& a, const Mat4& b, const std::string& where) {
  EXPECT_LT(gap_mm(a, b), kPlaceMm) << where;
  EXPECT_LT(angle_between(a, b), kAngleRad) << where;
}

Joints random_joints(Random& random) {
  Joints q;
  for (int i = 0; i < 6; ++i) q[i] = random.uniform(-units::kPi, units::kPi);
  return q;
}

TEST(ForwardKinematics, AgreesWithKdl) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Joints q = random_joints(random);
    expect_same_pose(forward_kinematics(ur10e(), q), kdl_forward(q), std::to_string(n));
  }
}

TEST(ForwardKinematics, OfTheStretchedArmIsTheSumOfItsLengths) {
  const Mat4 T = forward_kinematics(ur10e(), Joints::Zero());
  EXPECT_LT((Vec3(T.topRightCorner<3, 1>()) - Vec3(-612.7 - 571.55, -174.15 - 116.55, 180.7 - 119.85)).norm(), 1e-9);
}

TEST(Jacobian, AgreesWithKdl) {
  const KDL::Chain chain = kdl_chain();
  KDL::ChainJntToJacSolver solver(chain);
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    const Joints q = random_joints(random);
    KDL::Jacobian theirs(6);
    ASSERT_GE(solver.JntToJac(kdl_joints(q), theirs), 0);
    Mat6 expected = theirs.data;
    expected.topRows<3>() *= units::kMmPerM;
    EXPECT_LT((jacobian(ur10e(), q) - expected).norm(), 1e-9);
  }
}

TEST(Jacobian, IsTheSlopeOfThePlaceOfAPointOnTheTool) {
  const Vec3 point(12.0, -30.0, 150.0);
  Random random(3);
  const Joints q = random_joints(random);
  const auto place = [&](const Joints& at) {
    return Vec3((forward_kinematics(ur10e(), at) * point.homogeneous()).head<3>());
  };
  const double h = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vec3 slope = (place(q + h * Joints::Unit(i)) - place(q - h * Joints::Unit(i))) / (2.0 * h);
    EXPECT_LT((Vec3(jacobian(ur10e(), q, point).block<3, 1>(0, i)) - slope).norm(), 1e-5) << i;
  }
}

TEST(InverseKinematics, EachBranchPutThroughKdlReturnsThePose) {
  Random random(4);
  int poses_with_all_branches = 0;
  for (int n = 0; n < 2000; ++n) {
    const Joints q = random_joints(random);
    const Mat4 T = forward_kinematics(ur10e(), q);
    const InverseResult result = inverse_kinematics(ur10e(), T);
    ASSERT_EQ(result.outcome, InverseOutcome::Solved) << n;
    poses_with_all_branches += result.solutions.size() == 8;
    double nearest = 1e9;
    std::set<int> branches;
    for (const auto& solution : result.solutions) {
      expect_same_pose(kdl_forward(solution.q_rad), T, to_string(solution.branch));
      nearest = std::min(nearest, (nearest_turns(solution.q_rad, q) - q).norm());
      branches.insert(solution.branch.index());
    }
    EXPECT_LT(nearest, 1e-7) << "the joints themselves are missing at " << n;
    EXPECT_EQ(branches.size(), result.solutions.size());
  }
  EXPECT_GT(poses_with_all_branches, 400);
}

TEST(InverseKinematics, HoldsItsAccuracyNextToSingularities) {
  Random random(5);
  for (const double offset : {1e-3, 1e-5, 1e-7, 1e-9}) {
    for (const int joint : {2, 4}) {  // stretched arm, parallel wrist axes
      Joints q = random_joints(random);
      q[joint] = offset;
      const Mat4 T = forward_kinematics(ur10e(), q);
      const auto result = inverse_kinematics(ur10e(), T);
      ASSERT_FALSE(result.solutions.empty());
      for (const auto& solution : result.solutions)
        expect_same_pose(kdl_forward(solution.q_rad), T, fmt::format("joint {} at {}", joint + 1, offset));
    }
  }
}

TEST(InverseKinematics, NamesAWristSingularPoseAndTakesJoint6AsGiven) {
  Joints q;
  q << 0.3, -1.2, 1.0, -0.7, 0.0, 0.4;
  const Mat4 T = forward_kinematics(ur10e(), q);
  const auto result = inverse_kinematics(ur10e(), T, 0.25);
  EXPECT_EQ(result.outcome, InverseOutcome::WristSingular);
  ASSERT_FALSE(result.solutions.empty());
  for (const auto& solution : result.solutions) expect_same_pose(kdl_forward(solution.q_rad), T, "");
  EXPECT_NEAR(result.solutions.front().q_rad[5], 0.25, 1e-12);
  EXPECT_LT(smallest_singular_value(ur10e(), q), 1e-7);
}

TEST(InverseKinematics, NamesPosesOutOfReach) {
  Mat4 T = Mat4::Identity();
  T(0, 3) = 2000.0;
  EXPECT_EQ(inverse_kinematics(ur10e(), T).outcome, InverseOutcome::TooFar);
  T(0, 3) = 0.0;
  T(2, 3) = 800.0;
  EXPECT_EQ(inverse_kinematics(ur10e(), T).outcome, InverseOutcome::InsideShoulder);
}

TEST(InverseKinematics, LosesOneWayRoundNearerThanTheArmFolds) {
  // The folded arm keeps 612.7 - 571.55 mm between shoulder and first wrist joint. Nearer, that wrist place has neither
  // of the elbow's two ways; with the wrist flipped the joint lies elsewhere.
  Joints folded;
  folded << 0.0, 0.5, units::kPi, 0.2, 0.5 * units::kPi, 0.0;
  Mat4 T = forward_kinematics(ur10e(), folded);
  const Vec3 shoulder(0.0, 0.0, 180.7), wrist = joint_frames(ur10e(), folded)[3].topRightCorner<3, 1>();
  EXPECT_NEAR((wrist - shoulder).norm(), 612.7 - 571.55, 1e-9);
  T.topRightCorner<3, 1>() += 0.7 * (shoulder - wrist);
  const auto result = inverse_kinematics(ur10e(), T);
  EXPECT_EQ(result.outcome, InverseOutcome::Solved);
  EXPECT_EQ(result.solutions.size(), 6u);
  for (const auto& solution : result.solutions) expect_same_pose(kdl_forward(solution.q_rad), T, "");
}

TEST(SmallestSingularValue, IsZeroForAStretchedArmAndForAWristOverTheShoulder) {
  Joints stretched;
  stretched << 0.2, -0.8, 0.0, 0.5, 1.0, 0.3;
  EXPECT_LT(smallest_singular_value(ur10e(), stretched), 1e-7);
  Joints ordinary;
  ordinary << 0.0, -1.57, -1.57, -1.57, 1.57, 0.0;
  EXPECT_GT(smallest_singular_value(ur10e(), ordinary), 0.1);
}

TEST(TableClearance, FallsToTheElbowBelowTheTable) {
  Joints up, down;
  up << 0.0, -1.57, -1.57, -1.57, 1.57, 0.0;
  down = up;
  down[1] = 0.5;
  EXPECT_GT(table_clearance_mm(ur10e(), up, 0.0), 100.0);
  EXPECT_LT(table_clearance_mm(ur10e(), down, 0.0), 0.0);
  EXPECT_NEAR(table_clearance_mm(ur10e(), up, 50.0), table_clearance_mm(ur10e(), up, 0.0) - 50.0, 1e-9);
}

class PublishedDescription : public ::testing::Test {
 protected:
  void SetUp() override {
    INCISE_NEEDS_DATA_DIR();
    const std::filesystem::path folder = *testing::data_dir() / "robot" / "ur10e";
    kinematics = YAML::LoadFile(folder / "default_kinematics.yaml")["kinematics"];
    limits = YAML::LoadFile(folder / "joint_limits.yaml")["joint_limits"];
    physical = YAML::LoadFile(folder / "physical_parameters.yaml")["offsets"];
  }
  YAML::Node kinematics, limits, physical;
};

TEST_F(PublishedDescription, HasOurJointLimitsSpeedsAndOffsets) {
  const ArmModel& arm = ur10e();
  for (int i = 0; i < 6; ++i) {
    const YAML::Node joint = limits[arm.joint_names[static_cast<std::size_t>(i)]];
    EXPECT_NEAR(units::deg_from_rad(arm.max_rad[i]), joint["max_position"].as<double>(), 1e-9);
    EXPECT_NEAR(units::deg_from_rad(arm.min_rad[i]), joint["min_position"].as<double>(), 1e-9);
    EXPECT_NEAR(units::deg_from_rad(arm.max_speed_rad_s[i]), joint["max_velocity"].as<double>(), 1e-9);
  }
  EXPECT_NEAR(arm.shoulder_offset_mm, 1000.0 * physical["shoulder_offset"].as<double>(), 1e-9);
  EXPECT_NEAR(arm.elbow_offset_mm, 1000.0 * physical["elbow_offset"].as<double>(), 1e-9);
}

TEST_F(PublishedDescription, ReachesTheSamePoses) {
  // The chain of the ROS description: a fixed origin before each joint about z; its base is turned by half a turn.
  Random random(6);
  for (int n = 0; n < 100; ++n) {
    const Joints q = random_joints(random);
    Mat4 T = Mat4::Identity();
    int i = 0;
    for (const char* link : {"shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"}) {
      const YAML::Node origin = kinematics[link];
      const auto number = [&](const char* key) { return origin[key].as<double>(); };
      Mat4 joint = Mat4::Identity();
      joint.topLeftCorner<3, 3>() =
          (Eigen::AngleAxisd(number("yaw"), Vec3::UnitZ()) * Eigen::AngleAxisd(number("pitch"), Vec3::UnitY()) *
           Eigen::AngleAxisd(number("roll"), Vec3::UnitX()) * Eigen::AngleAxisd(q[i++], Vec3::UnitZ()))
              .toRotationMatrix();
      joint.topRightCorner<3, 1>() = 1000.0 * Vec3(number("x"), number("y"), number("z"));
      T = T * joint;
    }
    const Mat4 ours = forward_kinematics(ur10e(), q);
    // The file rounds a right angle to nine decimals.
    EXPECT_LT(gap_mm(T, ours), 2e-6) << n;
    EXPECT_LT(angle_between(T, ours), 2e-9) << n;
  }
}

}  // namespace
}  // namespace incise
