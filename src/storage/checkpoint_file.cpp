#include "progress_fields.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/storage/checkpoint_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <ostream>
#include <string_view>

namespace incise {
namespace {

constexpr std::string_view kMagic = "INCISECP";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kLengthAt = kMagic.size() + sizeof kVersion;  // byte at which the length of the file stands
constexpr std::size_t kHeaderBytes = kLengthAt + sizeof(std::uint64_t);
constexpr std::size_t kHashDigits = 64;
constexpr const char* kHint = "Remove the file to cut from the beginning";

/// Whole numbers as little-endian bytes.
template <class Number>
void put_bytes(std::string& bytes, Number number) {
  std::array<char, sizeof(Number)> own{};
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = static_cast<char>(number >> (8 * i) & 0xFFU);
  bytes.append(own.data(), own.size());
}

template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
  Number number = 0;
  for (std::size_t i = 0; i < sizeof number; ++i) {
    number |= static_cast<Number>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return number;
}

/// Puts fields behind each other; see progress_fields.hpp.
class FieldWriter {
 public:
  explicit FieldWriter(std::string& bytes) : bytes_(bytes) {}

  void operator()(const char*, double value) { put_bytes(bytes_, std::bit_cast<std::uint64_t>(value)); }
  void operator()(const char*, int value) { put_bytes(bytes_, static_cast<std::uint64_t>(value)); }
  void operator()(const char*, std::size_t value) { put_bytes(bytes_, std::uint64_t{value}); }
  void operator()(const char*, std::uint8_t value) { put_bytes(bytes_, value); }
  void operator()(const char*, bool value) { put_bytes(bytes_, std::uint8_t{value}); }
  void operator()(const char*, RemovalCause cause) { put_bytes(bytes_, static_cast<std::uint8_t>(cause)); }
  void operator()(const char* name, TetId tet) { (*this)(name, tet.index()); }
  void operator()(const char* name, const Vec3& v) {
    for (int i = 0; i < 3; ++i) (*this)(name, v[i]);
  }
  void operator()(const char* name, const Mat3& m) {
    for (int i = 0; i < 9; ++i) (*this)(name, m.data()[i]);
  }
  void operator()(const char* name, const std::string& text) {
    (*this)(name, text.size());
    bytes_ += text;
  }
  template <class Item, class Walk>
  void list(const char* name, const std::vector<Item>& items, const Walk& walk) {
    (*this)(name, items.size());
    for (const Item& item : items) walk(item);
  }
  template <class Item, class Walk>
  void per_vertex(const char* name, const std::vector<Item>& items, const Walk& walk) { list(name, items, walk); }
  template <class Item, class Walk>
  void per_tet(const char* name, const std::vector<Item>& items, const Walk& walk) { list(name, items, walk); }
  template <class Item, class Walk>
  void per_viscous_tet(const char* name, const std::vector<Item>& items, const Walk& walk) { list(name, items, walk); }
  template <class Item, class Walk>
  void per_branch(const char* name, const std::vector<Item>& items, const Walk& walk) { list(name, items, walk); }
  template <class Item, class Walk>
  void ascending(const char* name, const std::vector<Item>& items, const Walk& walk) { list(name, items, walk); }

 private:
  std::string& bytes_;
};

/// How long the lists of a checkpoint are that go with its model.
struct ListLengths {
  std::size_t vertices = 0;
  std::size_t tets = 0;
  std::size_t strains = 0;   ///< that viscous tissue remembers; 0: it is not viscous
  std::size_t branches = 0;
};

ListLengths lengths_for(const TissueModel& model) {
  const ViscousMemory memory = rest_state(model).memory;
  return {model.mesh.vertices.size(), model.mesh.tets.size(), memory.strains.size(), memory.branches.size()};
}

/// Takes the fields back, each checked; memory grows with what was read, not with what a count claims.
class FieldReader {
 public:
  /// @param bytes  up to where the fields end; reading begins at `at`.
  FieldReader(const std::filesystem::path& file, std::string_view bytes, std::size_t at, const ListLengths& lengths)
      : file_(file), bytes_(bytes), at_(at), lengths_(lengths) {}

  [[nodiscard]] std::size_t at() const { return at_; }

  void operator()(const char* name, double& value) {
    value = std::bit_cast<double>(take<std::uint64_t>(name));
    if (!std::isfinite(value)) fail<std::uint64_t>(name, fmt::format("{}", value), "a finite number");
  }
  void operator()(const char* name, int& value) { value = static_cast<int>(up_to(name, std::numeric_limits<int>::max())); }
  void operator()(const char* name, std::size_t& value) { value = up_to(name, std::numeric_limits<std::int64_t>::max()); }
  void operator()(const char* name, std::uint8_t& value) { value = flag(name); }
  void operator()(const char* name, bool& value) { value = flag(name) != 0; }
  void operator()(const char* name, RemovalCause& cause) {
    const auto number = take<std::uint8_t>(name);
    const auto known = std::find_if(kRemovalCauses.begin(), kRemovalCauses.end(),
                                    [number](RemovalCause each) { return static_cast<std::uint8_t>(each) == number; });
    if (known == kRemovalCauses.end()) fail<std::uint8_t>(name, fmt::format("{}", number), "the number of a cause");
    cause = *known;
  }
  void operator()(const char* name, TetId& tet) { tet = TetId(up_to(name, lengths_.tets - 1)); }
  void operator()(const char* name, Vec3& v) {
    for (int i = 0; i < 3; ++i) (*this)(name, v[i]);
  }
  void operator()(const char* name, Mat3& m) {
    for (int i = 0; i < 9; ++i) (*this)(name, m.data()[i]);
  }
  void operator()(const char* name, std::string& text) {
    const std::size_t size = up_to(name, bytes_.size() - at_ - std::min(bytes_.size() - at_, sizeof(std::uint64_t)));
    text = std::string(bytes_.substr(at_, size));
    at_ += size;
  }
  template <class Item, class Walk>
  void list(const char* name, std::vector<Item>& items, const Walk& walk) {
    const std::size_t count = up_to(name, bytes_.size());  // no item is smaller than a byte
    items.clear();
    for (std::size_t i = 0; i < count; ++i) walk(items.emplace_back());
  }
  template <class Item, class Walk>
  void per_vertex(const char* name, std::vector<Item>& items, const Walk& walk) { exactly(name, items, lengths_.vertices, "the mesh", walk); }
  template <class Item, class Walk>
  void per_tet(const char* name, std::vector<Item>& items, const Walk& walk) { exactly(name, items, lengths_.tets, "the mesh", walk); }
  template <class Item, class Walk>
  void per_viscous_tet(const char* name, std::vector<Item>& items, const Walk& walk) { exactly(name, items, lengths_.strains, "the tissue", walk); }
  template <class Item, class Walk>
  void per_branch(const char* name, std::vector<Item>& items, const Walk& walk) { exactly(name, items, lengths_.branches, "the tissue", walk); }
  template <class Item, class Walk>
  void ascending(const char* name, std::vector<Item>& items, const Walk& walk) {
    list(name, items, [&](Item& item) {
      const std::size_t start = at_;
      walk(item);
      if (items.size() < 2 || items[items.size() - 2].tet < item.tet) return;
      throw DataError(file_, fmt::format("byte {}: {}", start, name),
                      fmt::format("tet {} behind tet {}", item.tet.value, items[items.size() - 2].tet.value), "each tet once, ascending", kHint);
    });
  }

 private:
  template <class Number>
  Number take(const char* name) {
    if (bytes_.size() - at_ < sizeof(Number)) {
      throw DataError(file_, fmt::format("byte {}: {}", at_, name), "the end of the fields", "more of them", kHint);
    }
    const auto number = number_at<Number>(bytes_, at_);
    at_ += sizeof number;
    return number;
  }

  /// Refuses the number that was taken last.
  template <class Number>
  [[noreturn]] void fail(const char* name, const std::string& found, const std::string& expected) const {
    throw DataError(file_, fmt::format("byte {}: {}", at_ - sizeof(Number), name), found, expected, kHint);
  }

  std::size_t up_to(const char* name, std::uint64_t most) {
    const auto value = take<std::uint64_t>(name);
    if (value > most) fail<std::uint64_t>(name, fmt::format("{}", value), fmt::format("at most {}", most));
    return value;
  }

  std::uint8_t flag(const char* name) {
    const auto value = take<std::uint8_t>(name);
    if (value > 1) fail<std::uint8_t>(name, fmt::format("{}", value), "0 or 1");
    return value;
  }

  template <class Item, class Walk>
  void exactly(const char* name, std::vector<Item>& items, std::size_t expected, const char* owner, const Walk& walk) {
    const std::size_t start = at_;
    const auto count = take<std::uint64_t>(name);
    if (count != expected) fail<std::uint64_t>(name, fmt::format("{}", count), fmt::format("{}, as {} has", expected, owner));
    at_ = start;
    list(name, items, walk);
  }

  const std::filesystem::path& file_;
  std::string_view bytes_;
  std::size_t at_;
  ListLengths lengths_;
};

/// Refuses fields that do not fit each other.
void require_consistent(const std::filesystem::path& file, const IncisionProgress& progress) {
  const auto refuse = [&file](const char* place, const std::string& found, const char* expected) {
    throw DataError(file, place, found, expected, kHint);
  };
  const CutState& state = progress.state;
  for (const Bond& bond : state.bonds) {
    if (state.tissue.is_live[bond.tet.index()] == 0) refuse("bonds", fmt::format("tet {}, which is removed", bond.tet.value), "live tets");
  }
  std::vector<std::uint8_t> is_live(state.tissue.is_live.size(), 1);
  for (const Removal& removal : state.record.removals) {
    std::uint8_t& mark = is_live[removal.tet.index()];
    if (mark == 0) refuse("removals", fmt::format("tet {} again", removal.tet.value), "each tet once");
    mark = 0;
  }
  if (is_live != state.tissue.is_live) refuse("is_live", "other tets than those left by the removals", "one mark for each removal");
  if (progress.steps.size() != static_cast<std::size_t>(state.step) || progress.relaxation_steps > state.step) {
    refuse("step", fmt::format("{} with {} lines of the log, {} of them at rest", state.step, progress.steps.size(), progress.relaxation_steps),
           "one line for each step");
  }
}

/// Refuses a file that is not a whole checkpoint of this version.
void require_whole(const std::filesystem::path& file, std::string_view bytes) {
  if (bytes.size() < kMagic.size() || bytes.substr(0, kMagic.size()) != kMagic) {
    throw DataError(file, "byte 0", "something else", "a checkpoint of incise", kHint);
  }
  if (bytes.size() < kHeaderBytes + kHashDigits) {
    throw DataError(file, fmt::format("byte {}", bytes.size()), "the end of the file", "a complete checkpoint", kHint);
  }
  if (const auto version = number_at<std::uint32_t>(bytes, kMagic.size()); version != kVersion) {
    throw DataError(file, fmt::format("byte {}: version", kMagic.size()), fmt::format("{}", version), fmt::format("{}", kVersion), kHint);
  }
  if (const auto length = number_at<std::uint64_t>(bytes, kLengthAt); length != bytes.size()) {
    throw DataError(file, fmt::format("byte {}", bytes.size()), "the end of the file", fmt::format("{} bytes", length), kHint);
  }
  const std::size_t end = bytes.size() - kHashDigits;
  if (const std::string hash = sha256_of_text(bytes.substr(0, end)); hash != bytes.substr(end)) {
    throw DataError(file, fmt::format("byte {}: SHA-256", end), fmt::format("'{}'", bytes.substr(end, 12)),
                    fmt::format("'{}', that of the bytes before it: the file is damaged", hash.substr(0, 12)), kHint);
  }
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const std::string& key, const std::string& maker,
                      const IncisionProgress& progress) {
  std::string bytes(kMagic);
  put_bytes(bytes, kVersion);
  put_bytes(bytes, std::uint64_t{0});  // the length, once it is known
  FieldWriter put(bytes);
  put("key", key);
  put("maker", maker);
  walk_progress(put, progress);
  std::string length;
  put_bytes(length, std::uint64_t{bytes.size() + kHashDigits});
  bytes.replace(kLengthAt, length.size(), length);
  bytes += sha256_of_text(bytes);
  write_atomically(file, [&bytes](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
}

CheckpointFile::CheckpointFile(const std::filesystem::path& file) : file_(file), bytes_(read_text(file)) {
  require_whole(file_, bytes_);
  FieldReader take(file_, std::string_view(bytes_).substr(0, bytes_.size() - kHashDigits), kHeaderBytes, {});
  take("key", key_);
  take("maker", maker_);
  fields_start_ = take.at();
}

IncisionProgress CheckpointFile::progress(const TissueModel& model) const {
  const std::string_view fields = std::string_view(bytes_).substr(0, bytes_.size() - kHashDigits);
  FieldReader take(file_, fields, fields_start_, lengths_for(model));
  IncisionProgress progress;
  walk_progress(take, progress);
  if (take.at() != fields.size()) {
    throw DataError(file_, fmt::format("byte {}", take.at()), fmt::format("{} bytes too many", fields.size() - take.at()), "the SHA-256", kHint);
  }
  require_consistent(file_, progress);
  return progress;
}

}  // namespace incise
