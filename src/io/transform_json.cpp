#include <incise/core/described_json.hpp>
#include <incise/io/transform_json.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

namespace incise {
namespace {

double skew_of(const Mat3& m) {
  return (m.transpose() * m - Mat3::Identity()).cwiseAbs().maxCoeff();
}

template <class Check>
Mat4 checked(const nlohmann::ordered_json& document, const std::string& key, const std::filesystem::path& file,
             const Check& check) {
  JsonReader reader(document, file);
  reader.begin({});
  Mat4 T;
  const Field field{key};
  reader(field, T);
  require_similarity(reader, field, T);
  check(reader, field, T);
  return T;
}

}  // namespace

void require_similarity(const Visitor& v, const Field& field, const Mat4& T) {
  if (T.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    v.refuse(field, fmt::format("the last row {} {} {} {}", T(3, 0), T(3, 1), T(3, 2), T(3, 3)), "[0, 0, 0, 1]");
  const double determinant = T.topLeftCorner<3, 3>().determinant();
  if (!(determinant > 0.0)) {
    v.refuse(field, fmt::format("a rotation part with determinant {:.6g}", determinant),
             "a positive determinant (no mirror image)");
  }
  // Registered tissue is turned, moved and perhaps scaled; shear or unequal axes would distort the path.
  constexpr double kSimilar = 1e-3;  // relative: numbers may have been shortened
  const double skew = skew_of(T.topLeftCorner<3, 3>() / std::cbrt(determinant));
  if (!(skew <= kSimilar)) {
    v.refuse(field, fmt::format("axes of unequal length or not at right angles (by {:.3g})", skew),
             "a similarity: a rotation, one scale and a shift");
  }
}

Mat4 transform_in(const nlohmann::ordered_json& document, const std::string& key, const std::filesystem::path& file) {
  return checked(document, key, file, [](const Visitor&, const Field&, const Mat4&) {});
}

Mat4 rigid_transform_in(const nlohmann::ordered_json& document, const std::string& key,
                        const std::filesystem::path& file) {
  constexpr double kRigid = 1e-4;
  return checked(document, key, file, [](const Visitor& v, const Field& field, const Mat4& T) {
    const Mat3 R = T.topLeftCorner<3, 3>();
    if (skew_of(R) <= kRigid) return;
    v.refuse(field, fmt::format("a determinant of {:.6g}, or axes that are not perpendicular", R.determinant()),
             "a rotation and a shift in mm, without scale");
  });
}

}  // namespace incise
