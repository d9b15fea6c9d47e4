#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace incise::fuzz {

/// The words of a dictionary in libFuzzer's form: lines `"text"`, with \xNN, \\ and \" inside; `#` begins a comment. None without a file.
[[nodiscard]] std::vector<std::string> words_in(const std::filesystem::path& file);

/// Damaged versions of the inputs of a corpus, the same for the same seed.
class Mutations {
 public:
  /// @pre the corpus is not empty
  Mutations(std::uint64_t seed, std::vector<std::string> corpus, std::vector<std::string> words);

  /// One to eight changes of one input: bytes, numbers, words, lines, pieces of another input, its end.
  [[nodiscard]] std::string next();

 private:
  std::uint64_t draw();
  std::size_t below(std::size_t end);  ///< in [0, end); 0 where end is 0
  void change(std::string& bytes);
  void change_byte(std::string& bytes);
  void change_number(std::string& bytes);
  void put_word(std::string& bytes);
  void change_binary_number(std::string& bytes);
  void change_line(std::string& bytes);
  void take_piece_of_another(std::string& bytes);

  std::uint64_t state_;
  std::vector<std::string> corpus_;
  std::vector<std::string> words_;
};

}  // namespace incise::fuzz
