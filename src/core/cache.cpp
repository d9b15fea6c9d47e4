#include <incise/core/cache.hpp>
#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

constexpr std::size_t kDigits = 64;

class MemoryEntries : public EntryStore {
 public:
  std::optional<std::string> load(const std::string& name) override {
    const auto found = entries_.find(name);
    return found == entries_.end() ? std::nullopt : std::optional(found->second);
  }
  void save(const std::string& name, const std::string& bytes) override { entries_[name] = bytes; }
  void remove(const std::string& name) override { entries_.erase(name); }
  bool holds(const std::string& name) override { return entries_.contains(name); }

 private:
  std::map<std::string, std::string> entries_;
};

/// Returns the beginning of an entry: the magic line, the key's digest and the payload's digest. The payload follows.
std::string header_of(const CacheKey& key, std::string_view payload) {
  return fmt::format("{}{}\n{}\n", kCacheMagic, key.digest(), sha256_of_text(payload));
}

}  // namespace

CacheKey::CacheKey(std::string_view stage)
    : stage_(stage),
      parts_(fmt::format("{}\n{} {}\n", stage, source_digest(), to_string(active_isa()))) {}

CacheKey& CacheKey::add_text(std::string_view text) {
  parts_ += fmt::format("{} {}\n", text.size(),
                        sha256_of_text(text));  // with the size, parts cannot run into each other
  digest_.clear();
  return *this;
}

const std::string& CacheKey::digest() const {
  if (digest_.empty()) digest_ = sha256_of_text(parts_);
  return digest_;
}

std::string slot_of(const CacheKey& key) {
  return fmt::format("{}/{}", key.stage(), key.digest().substr(0, 16));
}

Cache::Cache() : store_(std::make_unique<MemoryEntries>()) {}

void Cache::keep_payload(const std::string& slot, const CacheKey& key, const std::string& bytes) {
  store_->save(slot, header_of(key, bytes) + bytes);
}

std::optional<std::string> Cache::payload(const std::string& slot, const CacheKey& key, Monitor& monitor) {
  try {
    std::optional<std::string> entry = store_->load(slot);
    if (!entry) return std::nullopt;
    const std::string_view all = *entry;
    const std::size_t start = kCacheMagic.size() + 2 * (kDigits + 1);
    if (all.size() < start || !all.starts_with(kCacheMagic))
      throw DataError(store_->place_of(slot), "byte 0", "something else", "an entry of the cache");
    if (all.substr(kCacheMagic.size(), kDigits) != key.digest()) return std::nullopt;
    const std::string_view payload = all.substr(start);
    if (all.substr(0, start) != header_of(key, payload))
      throw DataError(store_->place_of(slot), fmt::format("byte {}", start), "bytes that were changed",
                      "the bytes that were stored");
    return std::string(payload);
  } catch (const DataError& damaged) {
    report_damage(damaged, monitor);
    return std::nullopt;
  }
}

void Cache::report_damage(const std::exception& damaged, Monitor& monitor) {
  monitor.message(Severity::Warning, fmt::format("{}. It is computed again", damaged.what()));
}

}  // namespace incise
