#include "report/page_files.hpp"
#include "report/scene.hpp"
#include "report/sections.hpp"
#include "report/three_script.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/text_encoding.hpp>
#include <incise/report/html_report.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kFrameBudget = 9'000'000;  ///< bytes of text that the frames of all animations may take together
constexpr std::size_t kMaxShownTets = 200'000;   ///< about 4 MB of text
constexpr int kMaxAxialSlices = 40;

/// Fills {{name}} places of a template. Every place has to have its text.
std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& parts) {
  std::string result;
  while (true) {
    const std::size_t open = text.find("{{");
    result += text.substr(0, open);
    if (open == std::string_view::npos) return result;
    const std::size_t close = text.find("}}", open);
    result += parts.at(std::string(text.substr(open + 2, close - open - 2)));
    text.remove_prefix(close + 2);
  }
}

Json view_json(const ReportData& data) {
  const ViewFrame view = view_along(data.approach);
  return {{"x", json_of(view.x)}, {"y", json_of(view.y)}, {"z", json_of(view.z)}, {"ends", data.axis_names}};
}

Json axial_json(const SlicePlane& plane) {
  Json slices = Json::array();
  for (const Slice& slice : plane.slices) {
    slices.push_back({{"position_mm", slice.position_mm},
                      {"image", slice.image_uri},
                      {"outline", slice.outline},
                      {"tumor", slice.tumor},
                      {"planned", slice.planned_cut}});
  }
  return {{"axis", plane.axis_name}, {"first", plane.shown_first}, {"slices", slices}};
}

Json animations_json(const ReportData& data) {
  std::vector<const ReportAnimation*> shown;
  for (const ReportAnimation& animation : data.animations) {
    if (!animation.frames.empty()) shown.push_back(&animation);
  }
  Json animations = Json::array();
  for (const ReportAnimation* animation : shown) {
    animations.push_back(animation_json(*animation, kFrameBudget / shown.size()));
  }
  return animations;
}

/// The page's own scripts, one after another; what a module exports is known to those after it.
std::string page_script() {
  constexpr std::string_view kExport = "\nexport ";
  std::string script;
  for (const char* name : {"decode.js", "gizmo.js", "viewer.js", "cut_view.js", "mesh_view.js", "main.js"}) {
    std::string code(page::file(name));
    for (std::size_t at = 0; (at = code.find(kExport, at)) != std::string::npos;)
      code.replace(at, kExport.size(), "\n");
    script += code + '\n';
  }
  return script;
}

void require_reportable(const ReportData& data) {
  const std::vector<std::string> problems = find_problems(data);
  INCISE_REQUIRE(problems.empty(), fmt::format("these data cannot be reported:\n  {}", fmt::join(problems, "\n  ")));
}

}  // namespace

std::string html_report(const ReportData& data) {
  require_reportable(data);
  Json scene{{"view", view_json(data)}};
  std::array<SlicePlane, 3> planes;
  if (!data.ct.ct.voxels.empty()) {
    planes = slice_planes(data.ct, data.axis_names, kMaxAxialSlices);
    scene["axial"] = axial_json(planes.front());
  }
  const bool mesh_is_shown = !data.mesh.mesh.tets.empty() && data.mesh.mesh.tets.size() <= kMaxShownTets;
  if (mesh_is_shown) scene["mesh"] = mesh_json(data.mesh.mesh);
  scene["animations"] = animations_json(data);

  const std::string study = !data.is_of_a_study ? ""
                                                : answer_section(data) + findings_section(data) +
                                                      caveats_section(data) + scan_section(data, planes) +
                                                      mesh_section(data, mesh_is_shown) + cut_section(data) +
                                                      error_section(data) + kerf_section(data) + program_section(data);
  const std::string body = page_header(data) + "<main>\n" + study + tissue_section(data) + record_section(data) +
                           "</main>\n" + page_footer();
  return filled(page::file("page.html"),
                {{"title", escaped(data.title)},
                 {"style", std::string(page::file("page.css"))},
                 {"body", body},
                 {"data", script_json(scene)},
                 {"licence", std::string(page::file("three_licence.txt"))},
                 {"three", three_script(page::file("three.core.js"), page::file("three.module.js"))},
                 {"script", page_script()}});
}

void write_report(const ReportData& data, const std::filesystem::path& path) {
  const std::string page = html_report(data);
  write_atomically(path, page);
}

}  // namespace incise
