#include "field_writers.hpp"
#include "yaml_reader.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/utf8.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/meshing/sizing_field.hpp>
#include <incise/storage/case_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace incise {
namespace {

/// Checks a text before it is loaded: aliases can expand to more than memory holds, and each nesting level is a
/// recursive call.
class BoundedYaml : public YAML::EventHandler {
 public:
  explicit BoundedYaml(const std::filesystem::path& file) : file_(file) {}
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuse(mark, "an alias (*name)", "values written out"); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string& value) override {
    count(mark);
    // The file is UTF-8, but the escapes \N and \_ become one byte each, which is no valid UTF-8.
    if (const auto at = first_not_utf8(value)) {
      refuse(mark, fmt::format("a text with a byte 0x{:02X}", static_cast<unsigned char>(value[*at])),
             "UTF-8 text: the character itself in place of its escape");
    }
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override { enter(mark); }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override { enter(mark); }
  void OnMapEnd() override { --depth_; }

 private:
  static constexpr int kDeepest = 32;
  static constexpr int kMostValues = 200000;

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& found, const std::string& expected) const {
    throw DataError(file_, fmt::format("line {}", mark.line + 1), found, expected);
  }
  void count(const YAML::Mark& mark) {
    if (++values_ > kMostValues) refuse(mark, fmt::format("more than {} values", kMostValues), "a case file");
  }
  void enter(const YAML::Mark& mark) {
    count(mark);
    if (++depth_ > kDeepest) refuse(mark, fmt::format("values nested more than {} deep", kDeepest), "a case file");
  }

  const std::filesystem::path& file_;
  int values_ = 0;
  int depth_ = 0;
};

/// Parses the text of a case file within these bounds.
YAML::Node parse(const std::string& text, const std::filesystem::path& file) {
  try {
    if (const auto at = first_not_utf8(text)) {
      throw DataError(file, fmt::format("line {}", 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(*at), '\n')),
                      fmt::format("a byte 0x{:02X}", static_cast<unsigned char>(text[*at])), "UTF-8 text", "Save the file as UTF-8");
    }
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    BoundedYaml bounds(file);
    parser.HandleNextDocument(bounds);
    if (parser.HandleNextDocument(bounds))
      throw DataError(file, "", "several documents", "one document: nothing after a second line '---'");
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw DataError(file, fmt::format("line {}", error.mark.line + 1), error.msg, "YAML or JSON");
  }
}

/// Checks values that must fit each other, which no single range can express.
void require_consistent(const CaseFile& file, const std::string& name) {
  const Case& c = file.settings;
  const auto refuse = [&name](const std::string& group, const std::vector<Problem>& problems, const char* expected) {
    if (problems.empty()) return;
    if (problems.size() > 1)
      throw CaseError(name, group, fmt::format("{}", fmt::join(sentences(problems), "; ")), expected);
    throw CaseError(name, group + "." + problems[0].path, problems[0].found, problems[0].expected);
  };
  if (!c.specimen_id.empty() && !is_specimen_id(c.specimen_id))
    throw CaseError(name, "specimen_id", fmt::format("'{}'", c.specimen_id),
                    std::string(kSpecimenIdForm));
  refuse("ct", validate(c.segmentation), "a usable segmentation");
  refuse("specimen.material", validate(c.material, c.variation), "a usable material");
  refuse("plan", validate(c.plan), "a usable plan");
  refuse("tool", validate(c.tool), "a usable tool");
  CutSettings cut = c.cut;
  refuse("cut", validate(cut, 2.0 * radius_mm(c.tool)), "usable cut settings");
  cut.power_w = c.plan.power_w;
  cut.real_speed_mm_s = c.plan.speed_mm_s;
  cut.depth_mm = c.plan.depth_mm;
  refuse("plan", validate(cut, 2.0 * radius_mm(c.tool)), "power, speed and depth at which tissue is cut");
  if (c.plan.kind == PlanKind::Ring && c.plan.lateral_margin_mm <= radius_mm(c.tool)) {
    throw CaseError(name, "plan.lateral_margin_mm", fmt::format("{} mm", c.plan.lateral_margin_mm),
                    fmt::format("more than the electrode's radius of {} mm", radius_mm(c.tool)));
  }
  refuse("compensation", validate(c.compensation), "a usable correction");
  refuse("thermal", validate(c.thermal), "usable thermal constants");
  const double coarse_mm = c.meshing.coarse_mm.value_or(SizingSettings{}.coarse_mm);  // or less, in a small body
  if (c.meshing.fine_mm && *c.meshing.fine_mm > coarse_mm) {
    throw CaseError(name, "meshing.fine_mm", fmt::format("{} mm", *c.meshing.fine_mm), fmt::format("at most meshing.coarse_mm = {} mm", coarse_mm));
  }
  if (c.meshing.tets > 0 && c.meshing.tets < 100) {
    throw CaseError(name, "meshing.tets", fmt::format("{}", c.meshing.tets),
                    "0 (the edge lengths decide) or at least 100");
  }
  if (const auto length = length_mm(c.tool); length && c.plan.depth_mm > *length) {
    throw CaseError(name, "plan.depth_mm", fmt::format("{} mm", c.plan.depth_mm), fmt::format("at most tool.length_mm = {} mm", *length));
  }
  for (const auto& [field, transform] : {std::pair{"robot.T_robot_sim", &c.T_robot_sim}, std::pair{"robot.T_flange_tool", &c.T_flange_tool}}) {
    if (!*transform) continue;
    const Mat3 rotation = (*transform)->topLeftCorner<3, 3>();
    const bool is_rigid = (rotation.transpose() * rotation - Mat3::Identity()).norm() < 1e-6 && rotation.determinant() > 0.0 &&
                          ((*transform)->row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() < 1e-9;
    if (!is_rigid) throw CaseError(name, field, "a matrix that is not rigid", "a rotation, a translation and the row 0 0 0 1");
  }
}

void require_inputs(const CaseFile& file, const std::string& name) {
  const CaseInputs& in = file.inputs;
  const bool has_scan = !in.ct_volume.empty() || !in.ct_labels.empty();
  if (!has_scan && in.specimen_mesh.empty())
    throw CaseError(name, "ct.volume", "neither a CT nor labels nor a mesh", "ct.volume, ct.labels or specimen.mesh");
  if (has_scan && !in.specimen_mesh.empty())
    throw CaseError(name, "specimen.mesh", "a CT or labels and a mesh", "either a mesh or ct.volume and ct.labels");
}

/// Refuses a list of the case, named `field`, that gives a label twice.
template <class Entry>
void require_each_label_once(const std::vector<Entry>& labels, const char* field, const std::string& name) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (labels[j].label != labels[i].label) continue;
      throw CaseError(name, fmt::format("{}[{}]", field, i), fmt::format("label {} again", labels[i].label), "each label once");
    }
  }
}

/// Refuses labels that are listed twice, or without a material value of their own.
void require_consistent_labels(const Case& settings, const std::string& name) {
  const char* field = "specimen.material.labels";
  const std::vector<LabelMaterial>& labels = settings.variation.labels;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i].youngs_modulus_kpa || labels[i].poissons_ratio) continue;
    throw CaseError(name, fmt::format("{}[{}]", field, i), fmt::format("label {} without a value", labels[i].label),
                    "youngs_modulus_kpa, poissons_ratio or both");
  }
  require_each_label_once(labels, field, name);
  require_each_label_once(settings.toughness.labels, "cut.toughness", name);
}

/// Reads the holders' surfaces that support constraints name.
void read_holders(CaseFile& file, const std::string& name) {
  if (!file.settings.constraints) return;
  for (std::size_t i = 0; i < file.settings.constraints->size(); ++i) {
    auto* support = std::get_if<SupportConstraint>(&(*file.settings.constraints)[i]);
    if (support == nullptr || !support->holder) continue;
    const std::filesystem::path path = (file.folder / support->holder->name).lexically_normal();
    if (!std::filesystem::exists(path)) {
      throw DataError(path, "", "no such file",
                      fmt::format("the file that {} names as specimen.constraints[{}].surface", name, i));
    }
    support->holder = std::make_shared<HolderSurface>(HolderSurface{support->holder->name, read_surface(path)});
    file.inputs.holders.push_back(path);
  }
}

template <class Writer>
Writer walk(const CaseFile& file) {
  Writer writer;
  describe(writer, const_cast<CaseFile&>(file));  // a writer changes nothing
  return writer;
}

}  // namespace

CaseFile read_case(const std::filesystem::path& file_or_folder) {
  const bool is_folder = std::filesystem::is_directory(file_or_folder);
  const std::filesystem::path path = is_folder ? file_or_folder / "case.yaml" : file_or_folder;
  if (!std::filesystem::exists(path)) {
    throw DataError(path, "", "no such file", "a case file",
                    "`incise schema case --defaults` prints one to start from");
  }
  require_regular_file(path, kLargestCaseBytes);
  return parse_case(read_text(path), path);
}

CaseFile parse_case(const std::string& text, const std::filesystem::path& case_path) {
  CaseFile file;
  file.file = case_path;
  file.folder = std::filesystem::absolute(file.file).parent_path();
  const std::string name = file.file.string();
  const YAML::Node root = parse(text, file.file);
  if (root.IsMap() && !root["schema"].IsDefined()) {
    throw CaseError(name, "schema", "nothing", fmt::format("schema: {}", kCaseSchemaName));
  }
  YamlReader reader(root, name);
  describe(reader, file);
  reader.finish();
  for (std::filesystem::path* path :
       {&file.inputs.ct_volume, &file.inputs.ct_labels, &file.inputs.specimen_mesh, &file.inputs.tumor_contour,
        &file.inputs.tumor_surface, &file.inputs.elasticity_map, &file.inputs.line_contour, &file.inputs.tool_path}) {
    if (!path->empty()) *path = (file.folder / *path).lexically_normal();
  }
  require_consistent(file, name);
  require_consistent_labels(file.settings, name);
  require_inputs(file, name);
  read_holders(file, name);
  return file;
}

void require_plan_inputs(const CaseFile& file) {
  const std::string name = file.file.string();
  if (file.settings.plan.kind == PlanKind::Ring && file.inputs.tumor_contour.empty()) {
    throw CaseError(name, "tumor.contour", "nothing", "the tumour edge that the ring goes round");
  }
  if (file.settings.plan.kind == PlanKind::Line && file.inputs.line_contour.empty()) {
    throw CaseError(name, "plan.line", "nothing", "the curve of the open cut");
  }
}

TetMesh read_specimen_mesh(const CaseFile& file, Monitor& monitor) {
  const std::filesystem::path& path = file.inputs.specimen_mesh;
  INCISE_REQUIRE(!path.empty(), "expected a case that names a mesh");
  TetMesh mesh = read_tet_mesh(path, monitor);
  Box3 box;
  for (const Vec3& p : mesh.vertices) box.extend(p);
  require_body_size(box, path);
  const std::vector<MeshProblem> problems = find_problems(mesh);
  if (problems.empty()) return mesh;
  std::string others;
  for (std::size_t i = 1; i < problems.size(); ++i) others += (i > 1 ? "; also " : "Also ") + problems[i].text;
  throw DataError(path, "", problems.front().text, "one body of sound tets", others);
}

void require_input_files(const CaseFile& file) {
  const CaseInputs& in = file.inputs;
  const std::pair<const char*, const std::filesystem::path&> inputs[] = {
      {"ct.volume", in.ct_volume},         {"ct.labels", in.ct_labels},
      {"specimen.mesh", in.specimen_mesh}, {"tumor.contour", in.tumor_contour},
      {"tumor.surface", in.tumor_surface}, {"specimen.material.elasticity_map", in.elasticity_map},
      {"plan.line", in.line_contour},      {"path", in.tool_path}};
  for (const auto& [field, path] : inputs) {
    if (path.empty() || std::filesystem::exists(path)) continue;
    throw DataError(path, "", "no such file or folder",
                    fmt::format("the input that {} names as {}", file.file.string(), field));
  }
}

std::string specimen_id_of_case(const CaseFile& file,
                                const std::function<std::string(const std::filesystem::path&)>& digest) {
  if (!file.settings.specimen_id.empty()) return file.settings.specimen_id;
  const std::filesystem::path& mesh = file.inputs.specimen_mesh;
  const std::filesystem::path& scan = file.inputs.ct_volume.empty() ? file.inputs.ct_labels : file.inputs.ct_volume;
  if (mesh.empty()) return scan.empty() ? "" : specimen_id_of_scan(digest(scan));
  const std::string stated = specimen_id_of(mesh);
  return stated.empty() ? specimen_id_of_mesh(digest(mesh)) : stated;
}

std::vector<SettingLine> settings_of(const CaseFile& file) {
  std::vector<SettingLine> settings;
  const auto lister = walk<SettingLister>(file);
  for (const auto& line : lister.lines()) {
    if (line.is_group) continue;
    settings.push_back({line.group.empty() ? line.name : line.group + "." + line.name, line.value, line.unit});
  }
  return settings;
}

std::string settings_json(const CaseFile& file) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const SettingLine& line : settings_of(file)) json[line.key] = line.value;
  return json_text(json);
}

std::string case_schema_json() {
  nlohmann::ordered_json schema;
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = kCaseSchemaName;
  schema["description"] = "A case for incise: what to cut, where, and with what. Lengths in mm, coordinates in LPS.";
  schema["type"] = "object";
  schema["properties"] = walk<SchemaWriter>(CaseFile{}).properties();
  schema["required"] = {"schema"};
  schema["additionalProperties"] = false;
  return json_text(schema);
}

std::string case_defaults_yaml() {
  std::string text;
  const auto depth_of = [](const std::string& group) {
    return group.empty() ? 0 : 1 + std::count(group.begin(), group.end(), '.');
  };
  const auto lister = walk<SettingLister>(CaseFile{});
  for (const auto& line : lister.lines()) {
    const std::string indent(static_cast<std::size_t>(2 * depth_of(line.group)), ' ');
    const std::string unit = line.unit.empty() ? "" : fmt::format(" [{}]", line.unit);
    if (line.is_group) {
      text += fmt::format("{}{}:  # {}\n", indent, line.name, line.meaning);
    } else if (line.value.empty()) {  // optional and absent
      text += fmt::format("{}# {}:  # {}{}\n", indent, line.name, line.meaning, unit);
    } else {
      text += fmt::format("{}{}: {}  # {}{}\n", indent, line.name, line.value, line.meaning, unit);
    }
  }
  return text;
}

}  // namespace incise
