#include "arm_oracle.hpp"

#include <incise/core/units.hpp>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace incise::testing {
namespace {

enum Part { Base, Shoulder, UpperArm, Elbow, Forearm, Wrist1, Wrist2, Wrist3, Shaft, Needle, PartCount };

/// Universal Robots' printed table, metres.
KDL::Chain printed_chain() {
  const double quarter = units::kPi / 2;
  const double table[6][3] = {{0, quarter, 0.1807},  {-0.6127, 0, 0},        {-0.57155, 0, 0},
                              {0, quarter, 0.17415}, {0, -quarter, 0.11985}, {0, 0, 0.11655}};
  KDL::Chain chain;
  for (const auto& row : table)
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame::DH(row[0], row[1], row[2], 0.0)));
  return chain;
}

struct Frame {
  Vec3 origin, z;
  Mat4 T;
};

std::array<Frame, 7> frames_of(const Joints& q) {
  static const KDL::Chain chain = printed_chain();
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::JntArray joints(6);
  for (unsigned i = 0; i < 6; ++i) joints(i) = q[i];
  std::array<Frame, 7> frames;
  for (int k = 0; k <= 6; ++k) {
    KDL::Frame frame;
    if (k > 0) solver.JntToCart(joints, frame, k);
    Mat4 T = Mat4::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) T(i, j) = frame.M(i, j);
      T(i, 3) = 1000.0 * frame.p(i);
    }
    frames[static_cast<std::size_t>(k)] = {T.topRightCorner<3, 1>(), T.block<3, 1>(0, 2), T};
  }
  return frames;
}

struct Rod {
  Vec3 from, to;
  double radius;
};

std::array<Rod, PartCount> rods_of(const RobotProgram& program, const JointSample& sample, const CheckSettings& s) {
  const auto f = frames_of(sample.q_rad);
  const Vec3 side = f[1].z, out = 176.2 * side, in = 39.3 * side;
  const Mat4 tool = f[6].T * program.setup.T_flange_tool;
  const Vec3 tip = tool.topRightCorner<3, 1>(), axis = tool.block<3, 1>(0, 2), top = tip - s.needle_length_mm * axis;
  return {{{Vec3(0, 0, std::min(0.0, program.setup.table_z_mm)), f[1].origin, 95.0},
           {f[1].origin, f[1].origin + out, 90.0},
           {f[1].origin + out, f[2].origin + out, 80.0},
           {f[2].origin + out, f[2].origin + in, 65.0},
           {f[2].origin + in, f[3].origin + in, 65.0},
           {f[3].origin + in, f[4].origin, 55.0},
           {f[4].origin, f[5].origin, 55.0},
           {f[5].origin, f[6].origin - 25.0 * f[6].z, 50.0},
           {top, f[6].origin, s.shaft_radius_mm},
           {tip, top, s.needle_radius_mm}}};
}

using Object = fcl::CollisionObjectd;

Object object_of(const Rod& rod) {
  const Vec3 along = rod.to - rod.from;
  fcl::Transform3d T = fcl::Transform3d::Identity();
  if (along.norm() > 1e-9) T.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), along).toRotationMatrix();
  T.translation() = 0.5 * (rod.from + rod.to);
  return {std::make_shared<fcl::Capsuled>(rod.radius, along.norm()), T};
}

Object object_of(const TriMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  for (const Triangle& t : mesh.triangles)
    model->addTriangle(mesh.vertices[t[0].index()], mesh.vertices[t[1].index()], mesh.vertices[t[2].index()]);
  model->endModel();
  return {model, fcl::Transform3d::Identity()};
}

bool do_touch(const Object& a, const Object& b) {
  fcl::CollisionResultd result;
  return fcl::collide(&a, &b, fcl::CollisionRequestd(), result) > 0;
}

double distance(const Object& a, const Object& b) {
  fcl::DistanceResultd result;
  fcl::DistanceRequestd request;
  request.distance_tolerance = 1e-6;
  return fcl::distance(&a, &b, request, result);
}

using Pairs = std::vector<std::pair<Part, Part>>;

Pairs base_pairs() {
  Pairs pairs{{Base, Elbow}};
  for (const Part part : {Forearm, Wrist1, Wrist2, Wrist3, Shaft, Needle}) {
    pairs.emplace_back(Base, part);
    pairs.emplace_back(Shoulder, part);
  }
  return pairs;
}

Pairs self_pairs() {
  Pairs pairs{{UpperArm, Wrist1}, {Forearm, Wrist3}};
  for (const Part part : {Wrist2, Wrist3}) {
    pairs.emplace_back(UpperArm, part);
    pairs.emplace_back(Elbow, part);
  }
  for (const Part link : {UpperArm, Elbow, Forearm, Wrist1, Wrist2}) {
    pairs.emplace_back(link, Shaft);
    pairs.emplace_back(link, Needle);
  }
  return pairs;
}

void see(OracleAnswer& answer, const Object& a, const Object& b, bool is_measured) {
  if (!answer.is_in_contact && do_touch(a, b)) answer.is_in_contact = true;
  if (is_measured && !answer.is_in_contact) answer.least_mm = std::min(answer.least_mm, distance(a, b));
}

}  // namespace

std::map<std::string, OracleAnswer> ask_oracle(const RobotProgram& program, const TriMesh& surface,
                                               const CheckSettings& settings) {
  constexpr std::size_t kStride = 10;
  const Object tissue = object_of(surface);
  const Pairs of_base = base_pairs(), of_self = self_pairs();
  std::map<std::string, OracleAnswer> answers;
  const auto& samples = program.motion.samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool is_measured = i % kStride == 0;
    auto rods = rods_of(program, samples[i], settings);
    std::vector<Object> objects;
    for (const Rod& rod : rods) objects.push_back(object_of(rod));
    for (const auto& [a, b] : of_base) see(answers["base"], objects[a], objects[b], is_measured);
    for (const auto& [a, b] : of_self) see(answers["self_collision"], objects[a], objects[b], is_measured);
    for (const Part link : {UpperArm, Elbow, Forearm, Wrist1, Wrist2, Wrist3})
      see(answers["surface_collision"], objects[link], tissue, is_measured);
    see(answers["shaft"], objects[Shaft], tissue, is_measured);
    // In the tissue the needle counts from the clearance above its entry on.
    const std::size_t pose = samples[i].pose, next = std::min(pose + 1, program.poses.size() - 1);
    const double depth = std::max(program.poses[pose].depth_mm, program.poses[next].depth_mm);
    Rod& needle = rods[Needle];
    const double hidden = std::clamp(depth + program.settings.clearance_mm, 0.0, settings.needle_length_mm);
    needle.from += hidden * (needle.to - needle.from).normalized();
    see(answers["needle"], object_of(needle), tissue, is_measured);
  }
  return answers;
}

}  // namespace incise::testing
