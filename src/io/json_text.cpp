#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>

#include <nlohmann/json.hpp>

namespace incise {

void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& value) {
  write_atomically(path, json_text(value));
}

nlohmann::ordered_json read_json(const std::filesystem::path& path) {
  return parse_json(read_text(path), path);
}

}  // namespace incise
