#include "mutations.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <utility>

namespace incise::fuzz {
namespace {

constexpr std::size_t kLongestInput = 1 << 16;  // bytes: what is wrong shows in small files, and they are read fast

// Numbers at which readers go wrong.
constexpr std::array kNumbers{"0",          "-1",          "1",     "2",    "3",     "255",   "256",    "65535",  "65536", "2147483647", "-2147483648",
                              "4294967295", "4294967296", "9223372036854775807", "18446744073709551615", "1e308", "-1e308", "1e-320", "nan",
                              "inf",        "-inf",       "1e999", "0x10", "1e5",   "100000000", "+5",  ".",      "-",     "1e",         ""};
constexpr std::array<std::uint64_t, 14> kWholeNumbers{0,          1,          2,          0x7f,       0x80,        0xff,          0x7fff, 0x8000, 0xffff,
                                                      0x7fffffff, 0x80000000, 0xffffffff, 0x100000000, 0xffffffffffffffff};

bool is_of_number(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.' || c == '+'; }

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return std::tolower(static_cast<unsigned char>(c)) - 'a' + 10;
}

std::string unescaped(const std::string& text) {
  std::string word;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 >= text.size()) {
      word += text[i];
    } else if (text[i + 1] == 'x' && i + 3 < text.size()) {
      word += static_cast<char>(16 * hex_digit(text[i + 2]) + hex_digit(text[i + 3]));
      i += 3;
    } else {
      word += text[++i];
    }
  }
  return word;
}

}  // namespace

std::vector<std::string> words_in(const std::filesystem::path& file) {
  std::vector<std::string> words;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t begin = line.find('"');
    const std::size_t end = line.rfind('"');
    if (line.empty() || line.front() == '#' || begin == end) continue;
    words.push_back(unescaped(line.substr(begin + 1, end - begin - 1)));
  }
  return words;
}

Mutations::Mutations(std::uint64_t seed, std::vector<std::string> corpus, std::vector<std::string> words)
    : state_(seed), corpus_(std::move(corpus)), words_(std::move(words)) {}

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers with every standard library.
std::uint64_t Mutations::draw() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

std::size_t Mutations::below(std::size_t end) { return end == 0 ? 0 : static_cast<std::size_t>(draw() % end); }

std::string Mutations::next() {
  std::string bytes = corpus_[below(corpus_.size())];
  constexpr std::size_t kMostChanges = 8;
  for (std::size_t changes = 1 + below(kMostChanges); changes > 0; --changes) change(bytes);
  if (bytes.size() > kLongestInput) bytes.resize(kLongestInput);
  return bytes;
}

void Mutations::change(std::string& bytes) {
  switch (below(10)) {
    case 0:
    case 1:
      return change_byte(bytes);
    case 2:
    case 3:
      return change_number(bytes);
    case 4:
      return put_word(bytes);
    case 5:
      return change_binary_number(bytes);
    case 6:
      return change_line(bytes);
    case 7:
      return take_piece_of_another(bytes);
    case 8:
      bytes.resize(below(bytes.size() + 1));
      return;
    default: {
      const std::size_t from = below(bytes.size());
      bytes.erase(from, below(std::min<std::size_t>(64, bytes.size() - from) + 1));
    }
  }
}

void Mutations::change_byte(std::string& bytes) {
  if (bytes.empty()) return bytes.push_back(static_cast<char>(draw()));
  char& byte = bytes[below(bytes.size())];
  byte = below(2) == 0 ? static_cast<char>(byte ^ (1 << below(8))) : static_cast<char>(draw());
}

/// Puts another number in the place of one that is written in digits.
void Mutations::change_number(std::string& bytes) {
  if (bytes.empty()) return;
  std::size_t begin = below(bytes.size());
  while (begin < bytes.size() && !is_of_number(bytes[begin])) ++begin;
  std::size_t end = begin;
  while (end < bytes.size() && is_of_number(bytes[end])) ++end;
  while (begin > 0 && is_of_number(bytes[begin - 1])) --begin;
  bytes.replace(begin, end - begin, kNumbers[below(kNumbers.size())]);
}

void Mutations::put_word(std::string& bytes) {
  if (words_.empty()) return change_byte(bytes);
  const std::string& word = words_[below(words_.size())];
  const std::size_t at = below(bytes.size() + 1);
  bytes.replace(at, below(2) == 0 ? 0 : word.size(), word);
}

/// Little or big endian, of one to eight bytes.
void Mutations::change_binary_number(std::string& bytes) {
  const std::size_t size = std::size_t{1} << below(4);
  if (bytes.size() < size) return;
  const std::uint64_t number = kWholeNumbers[below(kWholeNumbers.size())];
  const std::size_t at = below(bytes.size() - size + 1);
  const bool is_big = below(2) == 0;
  for (std::size_t i = 0; i < size; ++i) bytes[at + (is_big ? size - 1 - i : i)] = static_cast<char>(number >> (8 * i));
}

/// Takes a line away, or writes it again elsewhere, up to thousands of times.
void Mutations::change_line(std::string& bytes) {
  const std::size_t middle = below(bytes.size());
  const std::size_t before = middle == 0 ? std::string::npos : bytes.rfind('\n', middle - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  const std::size_t after = bytes.find('\n', middle);
  const std::size_t end = after == std::string::npos ? bytes.size() : after + 1;
  if (end <= begin) return;
  const std::string line = bytes.substr(begin, end - begin);
  switch (below(3)) {
    case 0:
      bytes.erase(begin, end - begin);
      return;
    case 1:
      bytes.insert(below(bytes.size() + 1), line);
      return;
    default: {
      std::string many;
      for (std::size_t k = std::min(below(4096), kLongestInput / (2 * line.size() + 1)); k > 0; --k) many += line;
      bytes.insert(begin, many);
    }
  }
}

void Mutations::take_piece_of_another(std::string& bytes) {
  const std::string& other = corpus_[below(corpus_.size())];
  const std::size_t from = below(other.size());
  const std::size_t at = below(bytes.size() + 1);
  const std::string piece = other.substr(from, below(other.size() - from + 1));
  bytes.replace(at, below(2) == 0 ? 0 : piece.size(), piece);
}

}  // namespace incise::fuzz
