#include "storage/json_digest.hpp"

#include <incise/core/sha256.hpp>

namespace incise {

std::string digest_of(nlohmann::ordered_json document) {
  document.erase(kDigestKey);
  return sha256_of_text(document.dump());
}

}  // namespace incise
