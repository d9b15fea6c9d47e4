#pragma once

#include <incise/core/verdict.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace incise {

/// `{status, reasons: [{id, severity, value, limit, unit, at: {arclength_mm, position_mm, text}, message}]}`, worst reason first; what is not
/// known is null.
[[nodiscard]] nlohmann::ordered_json to_json(const Verdict& verdict);

/// Reads it back. @param json  what stands under the key `verdict` of a document. @param file  names it in messages.
/// @throws DataError naming the place of what is missing, of another kind, or not a name of this version; and where the
/// status is not that
///         of the worst reason.
[[nodiscard]] Verdict verdict_from_json(const nlohmann::ordered_json& json, const std::filesystem::path& file);

}  // namespace incise
