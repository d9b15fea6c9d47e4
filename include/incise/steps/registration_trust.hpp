#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/verdict.hpp>
#include <incise/storage/registration_json.hpp>

#include <filesystem>

namespace incise::steps {

/// Returns the objections to a path that a registration laid down: a caution `typed_transform` if the file does not
/// carry the digest of `incise register`, and one `registration` for each doubt that `register` itself wrote into it.
[[nodiscard]] Verdict verdict_of(const RegistrationRecord& registration, const std::filesystem::path& file);

/// Checks that the clouds of a registration are unchanged, because it holds only for them. A cloud that no longer
/// exists gets a warning. @throws DataError for a cloud that has changed since.
void require_clouds_unchanged(const RegistrationRecord& registration, const std::filesystem::path& file,
                              Monitor& monitor);

}  // namespace incise::steps
