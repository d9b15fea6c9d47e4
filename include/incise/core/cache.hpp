#pragma once

#include <incise/core/described_bytes.hpp>
#include <incise/core/error.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/sha256.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace incise {

/// The line that an entry begins with.
inline constexpr std::string_view kCacheMagic = "incise.cache/1\n";

/// Where a cache keeps its entries: bytes under a name.
class EntryStore {
 public:
  virtual ~EntryStore() = default;
  /// The bytes kept under that name, whole; nothing where there are none. @throws DataError for bytes that are damaged.
  virtual std::optional<std::string> load(const std::string& name) = 0;
  /// All or nothing. @throws DataError where they cannot be kept.
  virtual void save(const std::string& name, const std::string& bytes) = 0;
  virtual void remove(const std::string& name) = 0;
  [[nodiscard]] virtual bool holds(const std::string& name) = 0;
  /// What messages call the entry.
  [[nodiscard]] virtual std::filesystem::path place_of(const std::string& name) const { return name; }
};

/// What determines a result: hash of the stage, of this build (version, commit, instruction set: kernels of two of them
/// round differently), and of all that was added: settings as they are described, and the contents of inputs. Names and
/// places of files are no part of it.
class CacheKey {
 public:
  /// @param stage  names the result.
  explicit CacheKey(std::string_view stage);
  template <class T>
  CacheKey& add(const T& described) {
    return add_text(bytes_of(described));
  }
  CacheKey& add_text(std::string_view text);
  [[nodiscard]] const std::string& stage() const { return stage_; }
  /// 64 hex digits.
  [[nodiscard]] const std::string& digest() const;

 private:
  std::string stage_;
  std::string parts_;
  mutable std::string digest_;
};

/// A slot of its own for each key, for results of which many are kept side by side.
[[nodiscard]] std::string slot_of(const CacheKey& key);

/// Results by what determines them: one that is kept is not made again. What is loaded equals what was computed, in
/// every field that its type describes. Kept in memory, or wherever an EntryStore keeps it.
class Cache {
 public:
  Cache();
  explicit Cache(std::unique_ptr<EntryStore> store) : store_(std::move(store)) {}

  /// The result of that key. A damaged entry is reported as a warning and treated as absent. @param slot  the entry's
  /// name; an entry of another key under the same name gives way. @param fits  whether a value that was read may be
  /// used: an entry whose digest is right may still have been written by someone else.
  template <class T, class Fits>
  [[nodiscard]] std::optional<T> find(const std::string& slot, const CacheKey& key, Monitor& monitor,
                                      const Fits& fits) {
    const std::optional<std::string> bytes = payload(slot, key, monitor);
    if (!bytes) return std::nullopt;
    try {
      T value = from_bytes<T>(*bytes, store_->place_of(slot));
      if (fits(value)) return value;
      throw DataError(store_->place_of(slot), "", "values that do not fit each other", "those that were kept");
    } catch (const std::exception& damaged) {
      report_damage(damaged, monitor);
      return std::nullopt;
    }
  }
  template <class T>
  [[nodiscard]] std::optional<T> find(const std::string& slot, const CacheKey& key, Monitor& monitor) {
    return find<T>(slot, key, monitor, [](const T&) { return true; });
  }
  template <class T>
  void keep(const std::string& slot, const CacheKey& key, const T& value) {
    keep_payload(slot, key, bytes_of(value));
  }
  /// Finds the result or makes and keeps it.
  template <class T, class Fits, class Make>
  [[nodiscard]] T get_or_make(const std::string& slot, const CacheKey& key, Monitor& monitor, const Fits& fits,
                              const Make& make) {
    if (std::optional<T> kept = find<T>(slot, key, monitor, fits)) return std::move(*kept);
    T made = make();
    keep(slot, key, made);
    return made;
  }
  /// Whether the slot holds anything, of whatever key.
  [[nodiscard]] bool holds(const std::string& slot) { return store_->holds(slot); }
  void remove(const std::string& slot) { store_->remove(slot); }
  /// What messages call the slot.
  [[nodiscard]] std::filesystem::path place_of(const std::string& slot) const { return store_->place_of(slot); }

 private:
  std::optional<std::string> payload(const std::string& slot, const CacheKey& key, Monitor& monitor);
  void keep_payload(const std::string& slot, const CacheKey& key, const std::string& bytes);
  static void report_damage(const std::exception& damaged, Monitor& monitor);
  std::unique_ptr<EntryStore> store_;
};

}  // namespace incise
