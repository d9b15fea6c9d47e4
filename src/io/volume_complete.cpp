#include "io/volume_complete.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = 1 << 18;

[[noreturn]] void stop_short(const fs::path& path, const std::string& found, std::size_t expected) {
  throw DataError(path, "voxels", found, fmt::format("{} bytes", expected), "Is the file cut short?");
}

template <class T>
T number_at(const std::array<char, 540>& header, std::size_t position, bool is_swapped) {
  std::array<char, sizeof(T)> bytes{};
  std::copy_n(header.begin() + static_cast<std::ptrdiff_t>(position), sizeof(T), bytes.begin());
  if (is_swapped) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Returns the offset of the voxels, from a header of version 1 (348 bytes) or 2 (540 bytes) in either byte order.
std::size_t nifti_voxel_offset(const fs::path& path, const std::array<char, 540>& header) {
  for (const bool is_swapped : {false, true}) {
    const auto size = number_at<std::int32_t>(header, 0, is_swapped);
    double offset = -1;
    if (size == 348) offset = static_cast<double>(number_at<float>(header, 108, is_swapped));
    if (size == 540) offset = static_cast<double>(number_at<std::int64_t>(header, 168, is_swapped));
    if (offset >= 348 && offset < 1e9) return static_cast<std::size_t>(offset);
  }
  throw DataError(path, "header", "no offset of the voxels", "a NIfTI file with header and voxels in one");
}

/// Counts the bytes of the whole file, unpacked if it is packed.
void require_complete_nifti(const fs::path& path, std::size_t voxel_bytes) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw DataError(path, "", "a file that cannot be opened", "a readable file");
  std::array<char, 540> header{};
  std::vector<char> block(kBlock);
  std::size_t total = 0;
  int count = 0;
  while ((count = gzread(file.get(), block.data(), static_cast<unsigned>(block.size()))) > 0) {
    if (total == 0)
      std::copy_n(block.begin(), std::min<std::size_t>(header.size(), static_cast<std::size_t>(count)), header.begin());
    total += static_cast<std::size_t>(count);
  }
  int problem = Z_OK;
  gzerror(file.get(), &problem);
  const std::size_t expected = nifti_voxel_offset(path, header) + voxel_bytes;
  if (total < expected) stop_short(path, fmt::format("{} bytes", total), expected);
  if (problem != Z_OK && problem != Z_STREAM_END) stop_short(path, "damaged packing", expected);
}

/// The keys of a MetaImage header, and where it ends.
struct MetaHeader {
  std::map<std::string, std::string> values;
  std::size_t end = 0;
  [[nodiscard]] std::string get(const std::string& key) const {
    const auto found = values.find(key);
    return found == values.end() ? "" : found->second;
  }
};

MetaHeader read_meta_header(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  MetaHeader header;
  std::string line;
  constexpr int longest = 200;  // lines; more than any header needs
  for (int count = 0; count < longest && std::getline(stream, line); ++count) {
    const auto trim = [](const std::string& text) {
      const auto first = text.find_first_not_of(" \t\r");
      return first == std::string::npos ? std::string()
                                        : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
    };
    const auto equals = line.find('=');
    if (equals == std::string::npos) continue;
    header.values[trim(line.substr(0, equals))] = trim(line.substr(equals + 1));
    if (header.values.contains("ElementDataFile")) break;
  }
  header.end = stream ? static_cast<std::size_t>(stream.tellg()) : static_cast<std::size_t>(fs::file_size(path));
  return header;
}

/// Returns how many bytes a packed stream unpacks to; too few if it ends early or is damaged.
std::size_t unpacked_size(std::ifstream& stream) {
  z_stream packed{};
  constexpr int zlib_or_gzip = 32 + MAX_WBITS;
  if (inflateInit2(&packed, zlib_or_gzip) != Z_OK) return 0;
  std::vector<char> in(kBlock);
  std::vector<char> out(kBlock);
  std::size_t total = 0;
  int state = Z_OK;
  while (state == Z_OK && (stream.read(in.data(), static_cast<std::streamsize>(in.size())), stream.gcount() > 0)) {
    packed.next_in = reinterpret_cast<Bytef*>(in.data());
    packed.avail_in = static_cast<uInt>(stream.gcount());
    do {
      packed.next_out = reinterpret_cast<Bytef*>(out.data());
      packed.avail_out = static_cast<uInt>(out.size());
      state = inflate(&packed, Z_NO_FLUSH);
      total += out.size() - packed.avail_out;
    } while (state == Z_OK && packed.avail_out == 0);
    if (state == Z_BUF_ERROR) state = Z_OK;  // it only needs more input
  }
  inflateEnd(&packed);
  return state == Z_STREAM_END || total == 0 ? total : total - 1;  // the closing checksum is missing or wrong
}

void require_complete_meta(const fs::path& path, std::size_t voxel_bytes) {
  const MetaHeader header = read_meta_header(path);
  const std::string data_name = header.get("ElementDataFile");
  if (data_name.empty() || data_name.rfind("LIST", 0) == 0 || data_name.find('%') != std::string::npos) {
    throw DataError(path, "ElementDataFile", fmt::format("'{}'", data_name), "LOCAL or the name of one file");
  }
  if (header.get("BinaryData") == "False") throw DataError(path, "BinaryData", "False", "True");
  const bool is_local = data_name == "LOCAL" || data_name == "Local" || data_name == "local";
  const fs::path voxels = is_local ? path : path.parent_path() / data_name;
  std::ifstream stream(voxels, std::ios::binary);
  if (!stream)
    throw DataError(path, "ElementDataFile", fmt::format("no readable file '{}'", voxels.string()),
                    "the file with the voxels");
  if (is_local) stream.seekg(static_cast<std::streamoff>(header.end));
  const std::size_t begin = is_local ? header.end : 0;
  const std::size_t available = header.get("CompressedData") == "True"
                                    ? unpacked_size(stream)
                                    : static_cast<std::size_t>(fs::file_size(voxels)) - begin;
  if (available < voxel_bytes) stop_short(voxels, fmt::format("{} bytes", available), voxel_bytes);
}

}  // namespace

void require_complete_voxels(const fs::path& path, VolumeFormat format, std::size_t voxel_bytes) {
  if (format == VolumeFormat::Nifti) require_complete_nifti(path, voxel_bytes);
  if (format == VolumeFormat::MetaImage) require_complete_meta(path, voxel_bytes);
}

}  // namespace incise
