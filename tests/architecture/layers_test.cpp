// The arrow is tested: no source includes, and no target links, a module that its row in cmake/layers.txt does not
// allow.
#include "layers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace incise::architecture {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const fs::path kRoot = INCISE_SOURCE_DIR;

Layers layers() {
  std::ifstream table(kRoot / "cmake" / "layers.txt");
  EXPECT_TRUE(table) << "cmake/layers.txt cannot be read";
  return read_layers(table);
}

bool is_source(const fs::path& file) {
  return file.extension() == ".cpp" || file.extension() == ".hpp";
}

std::vector<fs::path> sources_below(const fs::path& folder) {
  std::vector<fs::path> sources;
  if (!fs::is_directory(folder)) return sources;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && is_source(entry.path())) sources.push_back(entry.path());
  }
  std::sort(sources.begin(), sources.end());
  return sources;
}

std::vector<std::string> folders_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<Offence> check(const Layers& table, const std::string& module, const fs::path& folder, bool is_public) {
  std::vector<Offence> all;
  for (const fs::path& file : sources_below(folder)) {
    std::ifstream text(file);
    const auto found = forbidden_includes(table, module, fs::relative(file, kRoot), text, is_public);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

std::vector<Offence> check_text(const std::string& module, const std::string& text, bool is_public = false) {
  std::istringstream stream(text);
  return forbidden_includes(layers(), module, "example.cpp", stream, is_public);
}

// --- the sources
// -------------------------------------------------------------------------------------------------------

TEST(Layers, NoSourceIncludesWhatItsRowDoesNotAllow) {
  const Layers table = layers();
  for (const auto& [module, row] : table) {
    for (const auto& [folder, is_public] :
         {std::pair{kRoot / "include/incise" / module, true}, {kRoot / "src" / module, false}}) {
      for (const Offence& offence : check(table, module, folder, is_public)) ADD_FAILURE() << to_string(offence);
    }
  }
  for (const auto& [module, folder] : {std::pair{"cli", kRoot / "apps/cli"}, {"python", kRoot / "python"}}) {
    for (const Offence& offence : check(table, module, folder, false)) ADD_FAILURE() << to_string(offence);
  }
}

TEST(Layers, EveryModuleFolderHasARow) {
  const Layers table = layers();
  for (const fs::path& folder : {kRoot / "src", kRoot / "include/incise"}) {
    for (const std::string& name : folders_in(folder))
      EXPECT_EQ(table.count(name), 1U) << folder / name << " has no row in layers.txt";
  }
}

TEST(Layers, EveryTargetLinksOnlyWhatItsRowAllows) {
  const Layers table = layers();
  for (const std::string& module : folders_in(kRoot / "src")) {
    const fs::path list = kRoot / "src" / module / "CMakeLists.txt";
    if (!fs::exists(list)) continue;
    std::ostringstream text;
    text << std::ifstream(list).rdbuf();
    for (const std::string& used : linked_modules(text.str())) {
      EXPECT_TRUE(table.at(module).may_include.count(used) == 1) << list << ": " << module << " may not link " << used;
    }
  }
}

TEST(Layers, TheScanSeesTheSources) {
  // A check that looks in the wrong place would always pass.
  EXPECT_GT(sources_below(kRoot / "src").size(), 100U);
  EXPECT_GT(sources_below(kRoot / "include").size(), 50U);
  EXPECT_GT(sources_below(kRoot / "apps/cli").size(), 10U);
}

// --- the check itself
// --------------------------------------------------------------------------------------------------

TEST(ForbiddenIncludes, NamesTheLineOfAnIncludeAcrossLayers) {
  const auto offences =
      check_text("geometry", "#pragma once\n#include <incise/core/error.hpp>\n#include <incise/io/mesh_io.hpp>\n");
  ASSERT_EQ(offences.size(), 1U);
  EXPECT_EQ(offences[0].line, 3U);
  EXPECT_EQ(to_string(offences[0]), "example.cpp:3: #include <incise/io/mesh_io.hpp>  <- geometry may not include io");
}

TEST(ForbiddenIncludes, SeesQuotesBlanksAndModulesOfTheSameLayer) {
  EXPECT_EQ(check_text("meshing", "#include \"incise/imaging/phantom.hpp\"\n").size(), 1U);
  EXPECT_EQ(check_text("meshing", "  #  include  <incise/imaging/phantom.hpp>\n").size(), 1U);
  EXPECT_EQ(
      check_text("planning", "#include <incise/cutting/tool.hpp>\n#include <incise/mechanics/tissue.hpp>\n").size(),
      0U);
}

TEST(ForbiddenIncludes, TheBenchCannotSeeTheSimulation) {
  EXPECT_EQ(check_text("virtual_bench", "#include <incise/cutting/tool.hpp>\n#include <incise/cutting/incision.hpp>\n")
                .size(),
            2U);
}

TEST(ForbiddenIncludes, ThePlannerCannotSeeTheBench) {
  for (const char* planner : {"planning", "calibration", "cutting", "registration", "evaluation", "workflow"})
    EXPECT_EQ(check_text(planner, "#include <incise/virtual_bench/body.hpp>\n").size(), 1U) << planner;
}

TEST(ForbiddenIncludes, PrivateHeadersStayInTheirModule) {
  EXPECT_EQ(check_text("storage", "#include \"io/vtk_bytes.hpp\"\n").size(), 1U);
  EXPECT_EQ(check_text("io", "#include \"io/vtk_bytes.hpp\"\n#include \"vtk_bytes.hpp\"\n").size(), 0U);
  EXPECT_EQ(check_text("io", "#include \"vtk_bytes.hpp\"\n", true).size(), 1U);
}

TEST(ForbiddenIncludes, AModuleThatThereIsNotIsTold) {
  EXPECT_THAT(to_string(check_text("io", "#include <incise/cuting/tool.hpp>\n").at(0)), HasSubstr("no module cuting"));
}

TEST(ForbiddenIncludes, OutsideHeadersAreNobodysMatter) {
  EXPECT_EQ(check_text("core", "#include <vector>\n#include <Eigen/Core>\n#include <fmt/format.h>\n").size(), 0U);
}

TEST(LayersTable, WhatMayBeIncludedIsTransitive) {
  const Layers table = layers();
  EXPECT_THAT(table.at("cutting").may_include, ElementsAre("core", "cutting", "geometry", "mechanics"));
  EXPECT_EQ(table.at("workflow").may_include.count("io"), 0U);
  for (const char* planner : {"planning", "calibration", "workflow"})
    EXPECT_EQ(table.at(planner).may_include.count("virtual_bench"), 0U) << planner;
  for (const char* hidden : {"cutting", "planning", "calibration"})
    EXPECT_EQ(table.at("virtual_bench").may_include.count(hidden), 0U);
}

TEST(LayersTable, ARowMayOnlyUseRowsBelowIt) {
  std::istringstream upwards("0 core\n1 geometry core\n1 other geometry\n");
  EXPECT_THROW(static_cast<void>(read_layers(upwards)), std::runtime_error);
  std::istringstream unknown("0 core\n1 geometry base\n");
  EXPECT_THROW(static_cast<void>(read_layers(unknown)), std::runtime_error);
}

TEST(LinkedModules, AreThoseAfterUses) {
  EXPECT_THAT(
      linked_modules("incise_module(io\n  SOURCES a.cpp\n  USES geometry core  # both\n  PRIVATE fmt::fmt zlib)\n"),
      ElementsAre("core", "geometry"));
  EXPECT_THAT(linked_modules("incise_module(io USES geometry)\nif(X)\nendif()\n"), ElementsAre("geometry"));
}

}  // namespace
}  // namespace incise::architecture
