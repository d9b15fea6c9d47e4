#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace incise::studio {

/// Arrays of results as little-endian files. A slot holds one array; the next one replaces it.
class BlobFolder {
 public:
  explicit BlobFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// @returns {"blob", "type", "count"}. @throws DataError if the file cannot be written.
  nlohmann::ordered_json put(const std::string& slot, std::span<const std::int16_t> values);
  nlohmann::ordered_json put(const std::string& slot, std::span<const std::uint8_t> values);
  nlohmann::ordered_json put(const std::string& slot, std::span<const std::uint32_t> values);
  nlohmann::ordered_json put(const std::string& slot, std::span<const float> values);
  /// Coordinates as float32: x y z of each point in turn.
  nlohmann::ordered_json put(const std::string& slot, std::span<const Vec3> points);
  /// Corners of triangles as uint32.
  nlohmann::ordered_json put(const std::string& slot, std::span<const Triangle> triangles);

 private:
  nlohmann::ordered_json write(const std::string& slot, std::string_view bytes, const char* type, std::size_t count);

  std::filesystem::path folder_;
  std::map<std::string, std::string> names_;  ///< by slot
};

}  // namespace incise::studio
