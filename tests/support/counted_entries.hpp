#pragma once

#include <incise/core/cache.hpp>

#include <map>
#include <memory>
#include <string>

namespace incise::testing {

/// Entries of a cache in memory, where a test can count and damage them.
struct Entries {
  std::map<std::string, std::string> bytes;
  int saved = 0;
};

class CountedEntries : public EntryStore {
 public:
  explicit CountedEntries(Entries& entries) : entries_(entries) {}
  std::optional<std::string> load(const std::string& name) override {
    const auto found = entries_.bytes.find(name);
    return found == entries_.bytes.end() ? std::nullopt : std::optional(found->second);
  }
  void save(const std::string& name, const std::string& bytes) override {
    entries_.bytes[name] = bytes;
    ++entries_.saved;
  }
  void remove(const std::string& name) override { entries_.bytes.erase(name); }
  bool holds(const std::string& name) override { return entries_.bytes.contains(name); }

 private:
  Entries& entries_;
};

}  // namespace incise::testing
