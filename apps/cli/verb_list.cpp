#include "verb_list.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <vector>

namespace incise::cli {
namespace {

struct VerbGroup {
  struct Verb {
    const char* name;
    const char* line;  ///< at most 85 characters: the list fits 100 columns
  };
  const char* name;
  std::vector<Verb> verbs;
};

const std::vector<VerbGroup>& groups() {
  static const std::vector<VerbGroup> all{
      {"Start here",
       {{"demo", "Make a virtual specimen and carry out everything that `run` does on it"},
        {"studio", "See the specimen, draw the tumour's edge, plan and watch the cut, in a browser"},
        {"run", "Plan, cut, correct and cut again on your case; write the robot program and a report"},
        {"report", "Write the report of a run's folder again, or of a program on measured tissue"}}},
      {"Plan and cut",
       {{"segment", "Find the tissue in a CT and write it as a label volume"},
        {"mesh", "Make a graded tetrahedral mesh from labels or a closed surface"},
        {"deform", "Clamp and stretch the tissue"},
        {"plan", "Plan the intended incision on the stretched tissue"},
        {"simulate", "Cut along the planned path and measure the result"},
        {"compensate", "Correct the path by the simulated error and verify it by cutting again"},
        {"forecast", "Forecast the error of this ring from photographs of earlier cuts"},
        {"assess", "Advise whether to cut a specimen along the corrected path, as planned, or not at all"}}},
      {"Robot",
       {{"surface", "Sample the surface that an observer sees, or clean a camera's cloud"},
        {"register", "Find the similarity transform between two clouds, and whether to trust it"},
        {"project", "Transfer a simulated path and tumour edge to measured tissue, in the robot's frame"},
        {"track", "Find a marked line with a colour and depth camera, and plan an incision on it"},
        {"export", "Check a path in the robot's frame for safety and write it as a program"},
        {"replay", "Play a program and show what the tip of the tool would do"}}},
      {"Measure",
       {{"evaluate", "Measure an incision against the tumour edge, in a photograph or as contours"},
        {"calibrate", "Find the simulated speed and dullness that reproduce photographed cuts"},
        {"compare", "Test whether incisions after a change miss by less than those before it"},
        {"audit", "Find the rows of a published table that cannot be right"}}},
      {"Virtual experiments",
       {{"experiment", "Carry out the paper's whole experiment on virtual specimens (also: study)"},
        {"bench", "Make the readings of a virtual specimen, and cut it with a robot program"},
        {"phantom", "Make a virtual specimen: its CT, tumour edge and case file"},
        {"power", "Find the lowest power that cuts virtual specimens without bulging or thermal damage"}}},
      {"Tools",
       {{"schema", "Print the JSON Schema of an input file, or every default"},
        {"verify", "Check the solver on this machine against known answers"},
        {"interchange", "Write the specimen with its constraints for another solver: SOFA scene or FEBio input"}}}};
  return all;
}

std::string listed(const std::string& name, const std::string& line) {
  return fmt::format("  {:<11}  {}\n", name, line);
}

}  // namespace

std::string line_of(const std::string& verb) {
  for (const VerbGroup& group : groups()) {
    for (const VerbGroup::Verb& one : group.verbs) {
      if (verb == one.name) return one.line;
    }
  }
  throw InvalidArgument(fmt::format("line_of: no line for the verb {}", verb));
}

std::string VerbList::make_subcommands(const CLI::App* app, CLI::AppFormatMode /*mode*/) const {
  std::string text;
  if (app->get_parent() == nullptr) {
    for (const VerbGroup& group : groups()) {
      text += fmt::format("\n{}:\n", group.name);
      for (const VerbGroup::Verb& verb : group.verbs) text += listed(verb.name, verb.line);
    }
    return text;
  }
  for (const CLI::App* verb : app->get_subcommands({})) text += listed(verb->get_name(), verb->get_description());
  return text.empty() ? text : "\nVerbs:\n" + text;
}

}  // namespace incise::cli
