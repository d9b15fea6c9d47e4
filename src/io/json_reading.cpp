#include "io/json_reading.hpp"

#include <incise/core/error.hpp>
#include <incise/io/nearest_name.hpp>

#include <fmt/format.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace incise::io_detail {

std::string JsonValue::shown() const {
  std::string text = value_->dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

void JsonValue::fail(std::string found, std::string expected, std::string hint) const {
  throw DataError(*file_, pointer_.empty() ? "/" : pointer_, std::move(found), std::move(expected), std::move(hint));
}

void JsonValue::require_only(const std::vector<std::string>& valid_keys) const {
  if (!value_->is_object()) expected("an object");
  for (const auto& [key, ignored] : value_->items()) {
    if (std::find(valid_keys.begin(), valid_keys.end(), key) != valid_keys.end()) continue;
    fail(fmt::format("unknown key '{}'", key), fmt::format("one of: {}", fmt::join(valid_keys, ", ")),
         fmt::format("Did you mean '{}'?", nearest_name(key, valid_keys)));
  }
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const {
  if (!value_->is_object()) expected("an object");
  const auto item = value_->find(key);
  if (item == value_->end()) return std::nullopt;
  return JsonValue(*item, *file_, pointer_ + "/" + key);
}

JsonValue JsonValue::at(const std::string& key) const {
  const auto item = find(key);
  if (!item) fail(fmt::format("no key '{}'", key), fmt::format("the key '{}'", key));
  return *item;
}

std::vector<JsonValue> JsonValue::items(std::size_t least) const {
  if (!value_->is_array()) expected("an array");
  if (value_->size() < least) fail(fmt::format("{} items", value_->size()), fmt::format("at least {}", least));
  std::vector<JsonValue> result;
  result.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    result.emplace_back((*value_)[i], *file_, fmt::format("{}/{}", pointer_, i));
  }
  return result;
}

double JsonValue::number() const {
  if (!value_->is_number()) expected("a number");
  const double value = value_->get<double>();
  if (!std::isfinite(value)) expected("a finite number");
  return value;
}

bool JsonValue::boolean() const {
  if (!value_->is_boolean()) expected("true or false");
  return value_->get<bool>();
}

std::string JsonValue::text() const {
  if (!value_->is_string()) expected("a text");
  return value_->get<std::string>();
}

Vec3 JsonValue::point() const {
  if (!value_->is_array() || value_->size() != 3) expected("three numbers [x, y, z]");
  const auto numbers = items();
  return {numbers[0].number(), numbers[1].number(), numbers[2].number()};
}

Mat4 JsonValue::transform() const {
  if (!value_->is_array() || value_->size() != 4) expected("4 rows of 4 numbers");
  const auto rows = items();
  Mat4 matrix;
  for (int i = 0; i < 4; ++i) {
    const JsonValue& row = rows[static_cast<std::size_t>(i)];
    if (!row.value_->is_array() || row.value_->size() != 4) row.expected("4 numbers");
    const auto numbers = row.items();
    for (int j = 0; j < 4; ++j) matrix(i, j) = numbers[static_cast<std::size_t>(j)].number();
  }
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) rows[3].expected("[0, 0, 0, 1]");
  const double determinant = matrix.topLeftCorner<3, 3>().determinant();
  if (!(determinant > 0.0)) {
    fail(fmt::format("a rotation part with determinant {:.6g}", determinant),
         "a positive determinant (no mirror image)");
  }
  // A tissue that was found in space is turned, moved and perhaps scaled; shear and unequal axes would bend the path.
  constexpr double kSimilar = 1e-3;  // relative: numbers may have been shortened
  const Mat3 turn = matrix.topLeftCorner<3, 3>() / std::cbrt(determinant);
  const double skew = (turn.transpose() * turn - Mat3::Identity()).cwiseAbs().maxCoeff();
  if (!(skew <= kSimilar)) {
    fail(fmt::format("axes of unequal length or not at right angles (by {:.3g})", skew), "a similarity: a rotation, one scale and a shift");
  }
  return matrix;
}

}  // namespace incise::io_detail
