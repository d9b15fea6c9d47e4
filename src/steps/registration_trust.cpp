#include <incise/core/error.hpp>
#include <incise/io/input_file.hpp>
#include <incise/steps/registration_trust.hpp>

#include <fmt/format.h>

namespace incise::steps {

Verdict verdict_of(const RegistrationRecord& registration, const std::filesystem::path& file) {
  Verdict verdict;
  if (!registration.is_sealed) {
    verdict.add("typed_transform", {},
                fmt::format("{} has no digest from `incise register`: how its transform was found, and how well it "
                            "fits, is unknown",
                            file.string()));
  }
  for (const std::string& doubt : registration.doubts) verdict.add("registration", {}, doubt);
  return verdict;
}

void require_clouds_unchanged(const RegistrationRecord& registration, const std::filesystem::path& file,
                              Monitor& monitor) {
  for (const RegistrationInput& cloud : registration.inputs) {
    std::error_code absent;
    if (!std::filesystem::exists(cloud.path, absent)) {
      monitor.message(Severity::Warning,
                      fmt::format("not checked: whether {}, from which {} was made, has changed; the file is missing",
                                  cloud.path, file.string()));
    } else if (sha256_of_input(cloud.path) != cloud.sha256) {
      throw DataError(file, cloud.key, fmt::format("the digest of another {}", cloud.path),
                      "the digest of the present cloud", "The cloud has changed: register again");
    }
  }
}

}  // namespace incise::steps
