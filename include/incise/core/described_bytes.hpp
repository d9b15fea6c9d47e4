#pragma once

#include <incise/core/describe.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace incise {

/// Returns every field of a described value as bytes, little-endian, in the order of the description: numbers and
/// counts as 8 bytes, flags and choices as 1 and 4, texts and lists after their count, blocks as in memory. Equal
/// values give equal bytes; a number keeps all its bits.
template <class T>
[[nodiscard]] std::string bytes_of(const T& value);

/// Returns the value that the bytes encode. Memory grows with the number of bytes, whatever the counts in them claim.
/// @param name  names the bytes in messages.
/// @throws DataError naming byte and field: too few or too many bytes, a number out of its range (numbers in blocks are
/// not checked), an unknown choice.
template <class T>
[[nodiscard]] T from_bytes(std::string_view bytes, const std::filesystem::path& name);

/// Appends each value that it visits.
class ByteWriter : public Visitor {
 public:
  [[nodiscard]] bool sets() const override { return false; }
  void begin(const Field&) override {}
  void end() override {}
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) override;
  bool optional(const Field& field, bool is_there) override;
  void number(const Field& field, double& value, const Range& range) override;
  void integer(const Field& field, std::int64_t& value, const Range& range) override;
  void flag(const Field& field, bool& value) override;
  void text(const Field& field, std::string& value) override;
  void choice(const Field& field, std::size_t& value, Names names) override;
  void block(const Field& field, const Block& block) override;

  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class ByteReader : public Visitor {
 public:
  ByteReader(std::string_view bytes, const std::filesystem::path& name) : bytes_(bytes), name_(name) {}
  [[nodiscard]] bool sets() const override { return true; }
  void begin(const Field&) override {}
  void end() override {}
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) override;
  bool optional(const Field& field, bool is_there) override;
  void number(const Field& field, double& value, const Range& range) override;
  void integer(const Field& field, std::int64_t& value, const Range& range) override;
  void flag(const Field& field, bool& value) override;
  void text(const Field& field, std::string& value) override;
  void choice(const Field& field, std::size_t& value, Names names) override;
  void block(const Field& field, const Block& block) override;
  [[noreturn]] void refuse(const Field& field, const std::string& found, const std::string& expected) const override;

  /// @throws DataError if bytes are left over.
  void finish() const;

 private:
  std::string_view take(const Field& field, std::size_t count);
  std::string_view bytes_;
  std::filesystem::path name_;
  std::size_t at_ = 0;
  std::size_t last_ = 0;  ///< offset of the value that was read last
};

template <class T>
std::string bytes_of(const T& value) {
  ByteWriter writer;
  writer(Field{}, const_cast<T&>(value));  // a writer changes nothing
  return writer.take();
}

template <class T>
T from_bytes(std::string_view bytes, const std::filesystem::path& name) {
  T value{};
  ByteReader reader(bytes, name);
  reader(Field{}, value);
  reader.finish();
  return value;
}

}  // namespace incise
