#include "io/number_text.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/pvd_io.hpp>

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace incise {

void write_pvd(const std::filesystem::path& path, const std::vector<PvdFrame>& frames) {
  INCISE_REQUIRE(!frames.empty(), "expected at least one frame, found none");
  pugi::xml_document document;
  pugi::xml_node file = document.append_child("VTKFile");
  file.append_attribute("type") = "Collection";
  file.append_attribute("version") = "0.1";
  file.append_attribute("byte_order") = "LittleEndian";
  pugi::xml_node collection = file.append_child("Collection");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    INCISE_REQUIRE(std::isfinite(frames[i].time_s),
                   fmt::format("expected a finite time, found {} in frame {}", frames[i].time_s, i));
    INCISE_REQUIRE(i == 0 || frames[i].time_s > frames[i - 1].time_s,
                   fmt::format("expected increasing times, found {} s in frame {}", frames[i].time_s, i));
    INCISE_REQUIRE(!frames[i].file.empty() && frames[i].file.is_relative(),
                   fmt::format("expected a relative file name, found '{}'", frames[i].file.string()));
    pugi::xml_node item = collection.append_child("DataSet");
    item.append_attribute("timestep") = io_detail::number_text(frames[i].time_s).c_str();
    item.append_attribute("group") = "";
    item.append_attribute("part") = "0";
    item.append_attribute("file") = frames[i].file.generic_string().c_str();
  }
  write_atomically(path, [&](std::ostream& stream) { document.save(stream, "  "); });
}

std::vector<PvdFrame> read_pvd(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    throw DataError(path, fmt::format("byte {}", parsed.offset), parsed.description(), "a ParaView collection");
  std::vector<PvdFrame> frames;
  for (const pugi::xml_node& item : document.child("VTKFile").child("Collection").children("DataSet")) {
    const std::string place = fmt::format("DataSet {}", frames.size());
    const auto time = io_detail::to_number(item.attribute("timestep").as_string());
    if (!time || !std::isfinite(*time)) {
      throw DataError(path, place, fmt::format("timestep '{}'", item.attribute("timestep").as_string()),
                      "a finite number");
    }
    const std::string file = item.attribute("file").as_string();
    if (file.empty()) throw DataError(path, place, "no file", "a file name");
    frames.push_back({*time, file});
  }
  if (frames.empty()) throw DataError(path, "<Collection>", "no DataSet", "at least one");
  std::stable_sort(frames.begin(), frames.end(),
                   [](const PvdFrame& a, const PvdFrame& b) { return a.time_s < b.time_s; });
  return frames;
}

}  // namespace incise
