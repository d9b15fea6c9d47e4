#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Checks that a 4 x 4 matrix is a similarity: last row 0 0 0 1, positive determinant, no shear and equal axes (to
/// 1e-3, relative). @throws as Visitor::refuse.
void require_similarity(const Visitor& v, const Field& field, const Mat4& T);

/// Returns the similarity under a key of a JSON object: 4 x 4 by rows, finite, shift in mm; see require_similarity.
/// @param file  names the document in messages  @throws DataError naming key, row or number.
[[nodiscard]] Mat4 transform_in(const nlohmann::ordered_json& document, const std::string& key,
                                const std::filesystem::path& file);

/// The same for a rigid transform: a rotation (to 1e-4) and a shift.
/// @throws DataError as transform_in, or if the matrix scales.
[[nodiscard]] Mat4 rigid_transform_in(const nlohmann::ordered_json& document, const std::string& key,
                                      const std::filesystem::path& file);

}  // namespace incise
