#pragma once

#include "storage/json_place.hpp"

#include <incise/core/monitor.hpp>
#include <incise/io/json_text.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>

namespace incise {

/// One finished result of a long computation as a file of its own: `FOLDER/<first 16 digits of the key>.json`. The key
/// is the hash of everything that determines the result, so that it is found again whatever else is asked for, and one
/// made from other inputs is not.
class KeptRecord {
 public:
  /// @param folder  is made when the record is saved.  @param schema  of the file.  @param key  hex digits.
  KeptRecord(std::filesystem::path folder, std::string schema, std::string key);

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Writes schema, key, the keys of `result` and the digest of all these, all or nothing.
  void save(const nlohmann::ordered_json& result) const;

  /// What `read` makes of the file, a JsonPlace; nothing if there is no file. A damaged or changed file is reported,
  /// followed by `anew` ("The run is simulated anew"), and treated as missing.
  template <class Read>
  [[nodiscard]] auto load(Monitor& monitor, const char* anew, const Read& read) const
      -> std::optional<std::invoke_result_t<Read, const JsonPlace&>> {
    if (!std::filesystem::exists(file_)) return std::nullopt;
    try {
      const nlohmann::ordered_json json = read_json(file_);
      const JsonPlace place{file_, json, "", ""};
      require_own(place);
      auto result = read(place);
      require_unchanged(place);
      return result;
    } catch (const DataError& damaged) {
      monitor.message(Severity::Warning, fmt::format("{}. {}", damaged.what(), anew));
      return std::nullopt;
    }
  }

 private:
  void require_own(const JsonPlace& place) const;
  void require_unchanged(const JsonPlace& place) const;
  std::filesystem::path folder_, file_;
  std::string schema_, key_;
};

}  // namespace incise
