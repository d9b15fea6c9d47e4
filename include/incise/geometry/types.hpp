#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace incise {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Mat4 = Eigen::Matrix4d;

/// Axis-aligned box, mm.
using Box3 = Eigen::AlignedBox3d;

/// N x 3 points, mm.
using Points = std::vector<Vec3>;

}  // namespace incise
