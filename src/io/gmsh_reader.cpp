#include "io/mesh_readers.hpp"
#include "io/text_cursor.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <array>
#include <unordered_map>

namespace incise::io_detail {
namespace {

constexpr long long kMostOfGmsh = 0x7FFFFFFF;
constexpr int kTet4 = 4;

/// Returns the number of nodes of a Gmsh element type that bounds a body rather than fills it; 0 for all others.
int nodes_of_lower_dimensional(int kind) {
  // By type: 1 line, 2 triangle, 3 quadrangle; 8 to 10 the same, curved; 15 point; 16 curved quadrangle.
  constexpr std::array kNodes{0, 2, 3, 4, 0, 0, 0, 0, 3, 6, 9, 0, 0, 0, 0, 1, 8};
  const auto place = static_cast<std::size_t>(kind);
  return place < kNodes.size() ? kNodes[place] : 0;
}

/// Reads the sections of one file into a mesh.
class GmshReader {
 public:
  GmshReader(const std::filesystem::path& path, std::string_view text) : cursor_(path, text) {}

  TetMesh read() {
    while (!cursor_.is_at_end()) {
      const std::string section(cursor_.word("a section"));
      if (section.empty() || section[0] != '$') cursor_.fail(shown_word(section), "a section such as $Nodes");
      if (section == "$MeshFormat")
        read_format();
      else if (section == "$NOD")
        read_nodes_2();
      else if (section == "$ELM")
        read_elements_1();
      else if (section == "$Entities" && version_ >= 4.0)
        read_entities();
      else if (section == "$Nodes")
        version_ >= 4.0 ? read_nodes_4() : read_nodes_2();
      else if (section == "$Elements")
        version_ >= 4.0 ? read_elements_4() : read_elements_2();
      else if (section == "$NodeData")
        read_data(nodes_, mesh_.vertices.size(), mesh_.point_data);
      else if (section == "$ElementData")
        read_data(elements_, mesh_.tets.size(), mesh_.cell_data);
      else
        skip(section);
      if (section == "$NOD" || section == "$ELM")
        cursor_.require("$END" + section.substr(1));
      else if (!was_skipped_)
        cursor_.require("$End" + section.substr(1));
      was_skipped_ = false;
    }
    if (!physical_.values.empty()) mesh_.cell_data["physical"] = std::move(physical_);
    if (!geometrical_.values.empty()) mesh_.cell_data["geometrical"] = std::move(geometrical_);
    return std::move(mesh_);
  }

 private:
  void read_format() {
    version_ = cursor_.number("format version");
    const bool is_known = (version_ >= 2.0 && version_ < 3.0) || (version_ >= 4.1 && version_ < 4.2);
    if (!is_known)
      cursor_.fail(fmt::format("version {}", version_), "Gmsh format 1, 2.x or 4.1", "Save it as version 2 or 4.1.");
    if (cursor_.integer("file type", 0, 1) == 1)
      cursor_.fail("a binary file", "an ascii file", "Save it with Mesh.Binary = 0.");
    cursor_.integer("data size", 1, 64);
  }

  void skip(const std::string& section) {
    while (cursor_.word("$End" + section.substr(1)) != "$End" + section.substr(1)) continue;
    was_skipped_ = true;
  }

  void add_node(long long tag, const Vec3& position) {
    if (!nodes_.emplace(tag, mesh_.vertices.size()).second)
      cursor_.fail(fmt::format("node {} twice", tag), "each node once");
    mesh_.vertices.push_back(position);
  }

  void read_nodes_2() {
    const std::size_t count = cursor_.count("nodes");
    for (std::size_t i = 0; i < count; ++i) {
      const long long tag = cursor_.integer("node number", 0, kMostOfGmsh);
      add_node(tag, read_point(cursor_, "coordinate"));
    }
  }

  void read_nodes_4() {
    const std::size_t blocks = cursor_.count("node blocks");
    const std::size_t total = cursor_.count("nodes");
    cursor_.integer("smallest node number", 0, kMostOfGmsh);
    cursor_.integer("largest node number", 0, kMostOfGmsh);
    for (std::size_t b = 0; b < blocks; ++b) {
      cursor_.integer("entity dimension", 0, 3);
      cursor_.integer("entity number", -kMostOfGmsh, kMostOfGmsh);
      const long long parameters = cursor_.integer("parametric flag", 0, 1);
      if (parameters == 1) cursor_.fail("parametric nodes", "plain nodes", "Save it without parametric coordinates.");
      std::vector<long long> tags(cursor_.count("nodes in the block"));
      for (long long& tag : tags) tag = cursor_.integer("node number", 0, kMostOfGmsh);
      for (const long long tag : tags) add_node(tag, read_point(cursor_, "coordinate"));
    }
    if (mesh_.vertices.size() != total)
      cursor_.fail(fmt::format("{} nodes", mesh_.vertices.size()), fmt::format("the {} announced", total));
  }

  /// Reads the nodes of one element; keeps it if it is a tet.
  void read_element(int kind, long long tag, long long physical, long long geometrical) {
    if (kind != kTet4) {
      const int count = nodes_of_lower_dimensional(kind);
      if (count == 0)
        cursor_.fail(fmt::format("element type {}", kind), "linear tetrahedra (type 4) and their boundary");
      for (int k = 0; k < count; ++k) cursor_.integer("node number", 0, kMostOfGmsh);
      return;
    }
    Tet tet;
    for (VertexId& id : tet) {
      const long long node = cursor_.integer("node number", 0, kMostOfGmsh);
      const auto found = nodes_.find(node);
      if (found == nodes_.end()) cursor_.fail(fmt::format("node {}", node), "a node of this file");
      id = VertexId(found->second);
    }
    elements_.emplace(tag, mesh_.tets.size());
    mesh_.tets.push_back(tet);
    physical_.values.push_back(static_cast<double>(physical));
    geometrical_.values.push_back(static_cast<double>(geometrical));
  }

  void read_elements_1() {
    const std::size_t count = cursor_.count("elements");
    for (std::size_t i = 0; i < count; ++i) {
      const long long tag = cursor_.integer("element number", 0, kMostOfGmsh);
      const int kind = static_cast<int>(cursor_.integer("element type", 1, 200));
      const long long physical = cursor_.integer("physical tag", -kMostOfGmsh, kMostOfGmsh);
      const long long geometrical = cursor_.integer("geometrical tag", -kMostOfGmsh, kMostOfGmsh);
      cursor_.integer("number of nodes", 1, 1000);
      read_element(kind, tag, physical, geometrical);
    }
  }

  void read_elements_2() {
    const std::size_t count = cursor_.count("elements");
    for (std::size_t i = 0; i < count; ++i) {
      const long long tag = cursor_.integer("element number", 0, kMostOfGmsh);
      const int kind = static_cast<int>(cursor_.integer("element type", 1, 200));
      const long long tag_count = cursor_.integer("number of tags", 0, 1000);
      std::array<long long, 2> tags{0, 0};
      for (long long k = 0; k < tag_count; ++k) {
        const long long value = cursor_.integer("tag", -kMostOfGmsh, kMostOfGmsh);
        if (k < 2) tags[static_cast<std::size_t>(k)] = value;
      }
      read_element(kind, tag, tags[0], tags[1]);
    }
  }

  /// Reads the physical tags of the model's volumes, one line each; skips all other entities.
  void read_entities() {
    std::array<std::size_t, 4> counts{};
    for (std::size_t& count : counts) count = cursor_.count("entities");
    cursor_.line();
    for (std::size_t i = 0; i < counts[0] + counts[1] + counts[2]; ++i) cursor_.line();
    for (std::size_t i = 0; i < counts[3]; ++i) {
      const long long tag = cursor_.integer("volume number", -kMostOfGmsh, kMostOfGmsh);
      for (int k = 0; k < 6; ++k) cursor_.number("box corner");
      const std::size_t physical_count = cursor_.count("physical tags");
      for (std::size_t k = 0; k < physical_count; ++k) {
        const long long value = cursor_.integer("physical tag", -kMostOfGmsh, kMostOfGmsh);
        if (k == 0) volume_physical_[tag] = value;
      }
      cursor_.line();
    }
  }

  void read_elements_4() {
    const std::size_t blocks = cursor_.count("element blocks");
    cursor_.count("elements");
    cursor_.integer("smallest element number", 0, kMostOfGmsh);
    cursor_.integer("largest element number", 0, kMostOfGmsh);
    for (std::size_t b = 0; b < blocks; ++b) {
      cursor_.integer("entity dimension", 0, 3);
      const long long entity = cursor_.integer("entity number", -kMostOfGmsh, kMostOfGmsh);
      const int kind = static_cast<int>(cursor_.integer("element type", 1, 200));
      const auto physical = volume_physical_.find(entity);
      const std::size_t count = cursor_.count("elements in the block");
      for (std::size_t i = 0; i < count; ++i) {
        const long long tag = cursor_.integer("element number", 0, kMostOfGmsh);
        read_element(kind, tag, physical == volume_physical_.end() ? 0 : physical->second, entity);
      }
    }
  }

  /// $NodeData or $ElementData: text tags (the first is the name), real tags, then step, components, entries. All items
  /// must have a value.
  void read_data(const std::unordered_map<long long, std::size_t>& index, std::size_t items,
                 std::map<std::string, DataArray>& data) {
    const std::size_t texts = cursor_.count("text tags");
    cursor_.line();
    std::string name = "data";
    for (std::size_t i = 0; i < texts; ++i) {
      std::string text(cursor_.line());
      std::erase(text, '"');
      if (i == 0) name = text;
    }
    const std::size_t reals = cursor_.count("real tags");
    for (std::size_t i = 0; i < reals; ++i) cursor_.number("real tag");
    const std::size_t integers = cursor_.count("integer tags");
    if (integers < 3) cursor_.fail(fmt::format("{} integer tags", integers), "at least 3");
    cursor_.integer("time step", -kMostOfGmsh, kMostOfGmsh);
    DataArray array{static_cast<int>(cursor_.integer("components", 1, 9)), {}};
    const std::size_t entries = cursor_.count("entries");
    for (std::size_t i = 3; i < integers; ++i) cursor_.integer("integer tag", -kMostOfGmsh, kMostOfGmsh);
    const std::size_t width = static_cast<std::size_t>(array.components);
    array.values.assign(items * width, 0.0);
    std::vector<bool> is_set(items, false);
    std::size_t set_count = 0;
    for (std::size_t i = 0; i < entries; ++i) {
      const auto found = index.find(cursor_.integer("number", 0, kMostOfGmsh));
      for (std::size_t k = 0; k < width; ++k) {
        const double value = cursor_.number("value");
        if (found != index.end()) array.values[found->second * width + k] = value;
      }
      if (found != index.end() && !is_set[found->second]) {
        is_set[found->second] = true;
        ++set_count;
      }
    }
    if (set_count != items)
      cursor_.fail(fmt::format("'{}' for {} of {} items", name, set_count, items), "a value for each");
    data[name] = std::move(array);
  }

  TextCursor cursor_;
  double version_ = 1.0;
  bool was_skipped_ = false;
  TetMesh mesh_;
  std::unordered_map<long long, std::size_t> nodes_;     ///< node number -> vertex
  std::unordered_map<long long, std::size_t> elements_;  ///< element number -> tet
  std::unordered_map<long long, long long> volume_physical_;
  DataArray physical_, geometrical_;
};

}  // namespace

TetMesh read_gmsh(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  return GmshReader(path, text).read();
}

}  // namespace incise::io_detail
