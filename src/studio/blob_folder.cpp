#include "blob_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/studio/access.hpp>

#include <bit>
#include <cerrno>
#include <fstream>

namespace incise::studio {

static_assert(std::endian::native == std::endian::little, "a page reads the arrays as they lie in memory");

namespace {

template <class Value>
std::string_view bytes_of(std::span<const Value> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

nlohmann::ordered_json BlobFolder::write(const std::string& slot, std::string_view bytes, const char* type,
                                         std::size_t count) {
  const std::string name = new_token();
  const std::filesystem::path path = folder_ / name;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    const std::string why = system_reason(errno);
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    throw DataError(path, "", why, "room for an array that the page shows");
  }
  if (const auto old = names_.find(slot); old != names_.end()) {
    std::error_code ignored;
    std::filesystem::remove(folder_ / old->second, ignored);
  }
  names_[slot] = name;
  return {{"blob", name}, {"type", type}, {"count", count}};
}

nlohmann::ordered_json BlobFolder::put(const std::string& slot, std::span<const std::int16_t> values) {
  return write(slot, bytes_of(values), "int16", values.size());
}
nlohmann::ordered_json BlobFolder::put(const std::string& slot, std::span<const std::uint8_t> values) {
  return write(slot, bytes_of(values), "uint8", values.size());
}
nlohmann::ordered_json BlobFolder::put(const std::string& slot, std::span<const std::uint32_t> values) {
  return write(slot, bytes_of(values), "uint32", values.size());
}
nlohmann::ordered_json BlobFolder::put(const std::string& slot, std::span<const float> values) {
  return write(slot, bytes_of(values), "float32", values.size());
}

nlohmann::ordered_json BlobFolder::put(const std::string& slot, std::span<const Vec3> points) {
  std::vector<float> values;
  values.reserve(3 * points.size());
  for (const Vec3& p : points) {
    for (int a = 0; a < 3; ++a) values.push_back(static_cast<float>(p[a]));
  }
  return put(slot, std::span<const float>(values));
}

nlohmann::ordered_json BlobFolder::put(const std::string& slot, std::span<const Triangle> triangles) {
  std::vector<std::uint32_t> values;
  values.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (const VertexId v : t) values.push_back(static_cast<std::uint32_t>(v.value));
  }
  return put(slot, std::span<const std::uint32_t>(values));
}

}  // namespace incise::studio
