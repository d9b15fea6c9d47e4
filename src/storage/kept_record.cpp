#include "storage/kept_record.hpp"

#include "storage/json_digest.hpp"

namespace incise {

KeptRecord::KeptRecord(std::filesystem::path folder, std::string schema, std::string key)
    : folder_(std::move(folder)),
      file_(folder_ / (key.substr(0, 16) + ".json")),
      schema_(std::move(schema)),
      key_(std::move(key)) {}

void KeptRecord::save(const nlohmann::ordered_json& result) const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw DataError(folder_, "", error.message(), "a folder that can be written");
  nlohmann::ordered_json json;
  json["schema"] = schema_;
  json["key"] = key_;
  json.update(result);
  json[kDigestKey] = digest_of(json);
  write_json(file_, json);
}

void KeptRecord::require_own(const JsonPlace& place) const {
  if (!place.object.is_object()) throw DataError(file_, "", "no object", fmt::format("a record {}", schema_));
  if (place.text("schema") != schema_) place.refuse("schema", place.text("schema"), schema_);
  if (place.text("key") != key_) place.refuse("key", "that of another record", "that of this one");
}

void KeptRecord::require_unchanged(const JsonPlace& place) const {
  const std::string expected = digest_of(place.object);
  const nlohmann::ordered_json& found = place.at(kDigestKey, "that of what is in this file");
  if (found != expected) place.refuse(kDigestKey, found.dump(), expected + ", that of what is in this file");
}

}  // namespace incise
