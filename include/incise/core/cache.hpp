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

/// The first line of every entry.
inline constexpr std::string_view kCacheMagic = "incise.cache/1\n";

/// Storage for the entries of a cache: bytes under a name.
class EntryStore {
 public:
  virtual ~EntryStore() = default;
  /// Returns all bytes stored under the name; nullopt if there are none. @throws DataError if they are damaged.
  virtual std::optional<std::string> load(const std::string& name) = 0;
  /// Stores all of the bytes or none. @throws DataError if they cannot be stored.
  virtual void save(const std::string& name, const std::string& bytes) = 0;
  virtual void remove(const std::string& name) = 0;
  [[nodiscard]] virtual bool holds(const std::string& name) = 0;
  /// Returns the path by which messages name the entry.
  [[nodiscard]] virtual std::filesystem::path place_of(const std::string& name) const { return name; }
};

/// Identifies a result by everything that determines it: a hash of the stage, of this build (source_digest() and the
/// instruction set, because two instruction sets round differently), and of everything added: described settings and
/// the contents of inputs. Names and places of files do not enter the key.
class CacheKey {
 public:
  /// @param stage  the name of the result, such as "mesh".
  explicit CacheKey(std::string_view stage);
  /// Adds a described value that determines the result.
  template <class T>
  CacheKey& add(const T& described) {
    return add_text(bytes_of(described));
  }
  CacheKey& add_text(std::string_view text);
  [[nodiscard]] const std::string& stage() const { return stage_; }
  /// Returns the SHA-256 of the key, 64 hex digits.
  [[nodiscard]] const std::string& digest() const;

 private:
  std::string stage_;
  std::string parts_;
  mutable std::string digest_;
};

/// Returns a slot that is unique to the key, for results of which several are kept side by side.
[[nodiscard]] std::string slot_of(const CacheKey& key);

/// Keeps results under their keys, so none is computed twice. A loaded result equals the computed one in every field
/// that its type describes. Results stay in memory, or where the EntryStore puts them.
class Cache {
 public:
  Cache();
  explicit Cache(std::unique_ptr<EntryStore> store) : store_(std::move(store)) {}

  /// Returns the result of the key; nullopt if it is absent. A damaged entry is reported as a warning and counts as
  /// absent.
  /// @param slot  the entry's name; an entry of another key under the same name counts as absent.
  /// @param fits  whether a value that was read may be used: incise may not have written an entry, even if its digest
  /// is right.
  template <class T, class Fits>
  [[nodiscard]] std::optional<T> find(const std::string& slot, const CacheKey& key, Monitor& monitor,
                                      const Fits& fits) {
    const std::optional<std::string> bytes = payload(slot, key, monitor);
    if (!bytes) return std::nullopt;
    try {
      T value = from_bytes<T>(*bytes, store_->place_of(slot));
      if (fits(value)) return value;
      throw DataError(store_->place_of(slot), "", "values that do not fit each other", "the values that were stored");
    } catch (const std::exception& damaged) {
      report_damage(damaged, monitor);
      return std::nullopt;
    }
  }
  template <class T>
  [[nodiscard]] std::optional<T> find(const std::string& slot, const CacheKey& key, Monitor& monitor) {
    return find<T>(slot, key, monitor, [](const T&) { return true; });
  }
  /// Stores a result, in place of any earlier entry of the slot. @throws DataError if it cannot be stored.
  template <class T>
  void keep(const std::string& slot, const CacheKey& key, const T& value) {
    keep_payload(slot, key, bytes_of(value));
  }
  /// Returns the stored result, or makes and stores it.
  template <class T, class Fits, class Make>
  [[nodiscard]] T get_or_make(const std::string& slot, const CacheKey& key, Monitor& monitor, const Fits& fits,
                              const Make& make) {
    if (std::optional<T> kept = find<T>(slot, key, monitor, fits)) return std::move(*kept);
    T made = make();
    keep(slot, key, made);
    return made;
  }
  /// Whether the slot holds an entry of any key.
  [[nodiscard]] bool holds(const std::string& slot) { return store_->holds(slot); }
  void remove(const std::string& slot) { store_->remove(slot); }
  /// Returns the path by which messages name the slot.
  [[nodiscard]] std::filesystem::path place_of(const std::string& slot) const { return store_->place_of(slot); }

 private:
  std::optional<std::string> payload(const std::string& slot, const CacheKey& key, Monitor& monitor);
  void keep_payload(const std::string& slot, const CacheKey& key, const std::string& bytes);
  static void report_damage(const std::exception& damaged, Monitor& monitor);
  std::unique_ptr<EntryStore> store_;
};

}  // namespace incise
