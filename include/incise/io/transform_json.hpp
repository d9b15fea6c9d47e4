#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Refuses a matrix that is no similarity: another last row than 0 0 0 1, a mirror image, shear or unequal axes (to
/// 1e-3).
/// @throws as Visitor::refuse
void require_similarity(const Visitor& v, const Field& field, const Mat4& T);

/// The 4 x 4 matrix under a key of a JSON object: rows, the last one 0 0 0 1, finite, positive determinant; shifts in mm.
/// @param file  stands for the document in messages.  @throws DataError naming key, row or number.
[[nodiscard]] Mat4 transform_in(const nlohmann::ordered_json& document, const std::string& key,
                                const std::filesystem::path& file);

/// The same without scale or shear: a rotation (to 1e-4) and a shift. @throws DataError
[[nodiscard]] Mat4 rigid_transform_in(const nlohmann::ordered_json& document, const std::string& key,
                                      const std::filesystem::path& file);

}  // namespace incise
