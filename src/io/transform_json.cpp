#include "io/json_reading.hpp"

#include <incise/io/transform_json.hpp>

#include <fmt/format.h>

#include <Eigen/LU>

namespace incise {

using io_detail::JsonValue;

Mat4 transform_in(const nlohmann::ordered_json& document, const std::string& key, const std::filesystem::path& file) {
  return JsonValue(document, file).at(key).transform();
}

Mat4 rigid_transform_in(const nlohmann::ordered_json& document, const std::string& key,
                        const std::filesystem::path& file) {
  constexpr double kRigid = 1e-4;
  const JsonValue place = JsonValue(document, file).at(key);
  const Mat4 T = place.transform();
  const Mat3 R = T.topLeftCorner<3, 3>();
  if ((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() > kRigid) {
    place.fail(fmt::format("a determinant of {:.6g}, or axes that are not perpendicular", R.determinant()),
               "a rotation and a shift in mm, without scale");
  }
  return T;
}

}  // namespace incise
