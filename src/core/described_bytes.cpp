#include <incise/core/described_bytes.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

namespace incise {
namespace {

static_assert(std::endian::native == std::endian::little, "blocks lie in files as they lie in memory");

std::size_t size_of(const Block& block) {
  return block.count * with_numbers(block, [](const auto* number) { return sizeof *number; });
}

template <class Number>
void append(std::string& bytes, Number number) {
  std::array<char, sizeof number> own{};
  std::memcpy(own.data(), &number, sizeof number);
  bytes.append(own.data(), own.size());
}

template <class Number>
Number number_in(std::string_view bytes) {
  Number number{};
  std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

}  // namespace

std::size_t ByteWriter::begin_list(const Field&, std::size_t size, std::size_t) {
  append(bytes_, std::uint64_t{size});
  return size;
}

bool ByteWriter::optional(const Field&, bool is_there) {
  append(bytes_, std::uint8_t{is_there});
  return is_there;
}

void ByteWriter::number(const Field&, double& value, const Range&) {
  append(bytes_, value);
}
void ByteWriter::integer(const Field&, std::int64_t& value, const Range&) {
  append(bytes_, value);
}
void ByteWriter::flag(const Field&, bool& value) {
  append(bytes_, std::uint8_t{value});
}

void ByteWriter::text(const Field&, std::string& value) {
  append(bytes_, std::uint64_t{value.size()});
  bytes_ += value;
}

void ByteWriter::choice(const Field&, std::size_t& value, Names) {
  append(bytes_, static_cast<std::uint32_t>(value));
}

void ByteWriter::block(const Field&, const Block& block) {
  bytes_.append(static_cast<const char*>(block.data), size_of(block));
}

std::string_view ByteReader::take(const Field& field, std::size_t count) {
  last_ = at_;
  if (bytes_.size() - at_ < count) refuse(field, "the end of the data", fmt::format("{} more bytes", count));
  at_ += count;
  return bytes_.substr(last_, count);
}

std::size_t ByteReader::begin_list(const Field& field, std::size_t, std::size_t item_bytes) {
  const auto size = number_in<std::uint64_t>(take(field, sizeof(std::uint64_t)));
  const std::size_t most = (bytes_.size() - at_) / item_bytes;
  if (size > most) refuse(field, fmt::format("{} items", size), fmt::format("at most {}", most));
  return size;
}

bool ByteReader::optional(const Field& field, bool) {
  bool is_there = false;
  flag(field, is_there);
  return is_there;
}

void ByteReader::number(const Field& field, double& value, const Range& range) {
  value = number_in<double>(take(field, sizeof value));
  const bool is_bounded = std::isfinite(range.least) || std::isfinite(range.most);  // otherwise NaN may mean "none"
  if (is_bounded && !contains(range, value)) refuse(field, fmt::format("{}", value), describe(range));
}

void ByteReader::integer(const Field& field, std::int64_t& value, const Range& range) {
  value = number_in<std::int64_t>(take(field, sizeof value));
  if (!contains(range, as_number(value, range))) refuse(field, fmt::format("{}", value), describe(range));
}

void ByteReader::flag(const Field& field, bool& value) {
  const auto found = number_in<std::uint8_t>(take(field, 1));
  if (found > 1) refuse(field, fmt::format("{}", found), "0 or 1");
  value = found == 1;
}

void ByteReader::text(const Field& field, std::string& value) {
  const std::size_t size = begin_list(field, 0, 1);
  value = std::string(take(field, size));
}

void ByteReader::choice(const Field& field, std::size_t& value, Names names) {
  value = number_in<std::uint32_t>(take(field, sizeof(std::uint32_t)));
  if (value >= names.size()) refuse(field, fmt::format("{}", value), fmt::format("a number below {}", names.size()));
}

void ByteReader::block(const Field& field, const Block& block) {
  const std::string_view found = take(field, size_of(block));
  if (!found.empty()) std::memcpy(block.data, found.data(), found.size());
}

void ByteReader::refuse(const Field& field, const std::string& found, const std::string& expected) const {
  throw DataError(name_,
                  field.name.empty() ? fmt::format("byte {}", last_) : fmt::format("byte {}: {}", last_, field.name),
                  found, expected);
}

void ByteReader::finish() const {
  if (at_ != bytes_.size())
    throw DataError(name_, fmt::format("byte {}", at_), fmt::format("{} bytes too many", bytes_.size() - at_),
                    "the end");
}

}  // namespace incise
