#include "dose_field.hpp"
#include "tet_clip.hpp"

#include <incise/core/error.hpp>
#include <incise/cutting/divided_mesh.hpp>
#include <incise/geometry/disjoint_sets.hpp>
#include <incise/geometry/surface_query.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>

namespace incise {
namespace {

using Edge = std::pair<VertexId, VertexId>;  // of the whole mesh, the lower number first

/// A vertex of a piece of a tet.
struct Corner {
  VertexId id;                   // in the divided mesh
  Edge key;                      // the edge whose middle it is; with two equal numbers: that vertex
  std::array<double, 4> shares;  // barycentric, in the tet
  double dose;
};
using Piece = std::array<Corner, 4>;

/// Regular division of a tet: four pieces at its corners, four in the octahedron between these; 4 … 9 are the middles
/// of its edges.
constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
constexpr std::array<std::array<std::size_t, 4>, 8> kPieces{
    {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}, {4, 9, 5, 6}, {4, 9, 6, 8}, {4, 9, 8, 7}, {4, 9, 7, 5}}};

/// A pair of kPieces that share a face, and the face's corners among the ten.
struct Neighbours {
  std::size_t a, b;
  std::vector<std::size_t> face;
};
std::vector<Neighbours> neighbouring_pieces() {
  std::vector<Neighbours> pairs;
  for (std::size_t a = 0; a < kPieces.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::vector<std::size_t> face;
      for (const std::size_t c : kPieces[a]) {
        if (std::ranges::find(kPieces[b], c) != kPieces[b].end()) face.push_back(c);
      }
      if (face.size() == 3) pairs.push_back({a, b, face});
    }
  }
  return pairs;
}

class Divider {
 public:
  Divider(const TissueModel& whole, const CutState& state)
      : whole_(whole),
        state_(state),
        split_(split_mesh(whole.mesh, state.splits)),
        lattice_(lattice_of(whole, state.points)),
        doses_(lattice_, state.points),
        vertices_(split_.vertices.size()),
        on_skin_(skin_faces(whole.mesh)) {
    lattice_.require_own_tets(state.points, state.splits, whole.mesh.tets.size());
    for (const Removal& removal : state.record.removals) {
      INCISE_REQUIRE(removal.tet.is_valid() && removal.tet.index() < split_.tets.size(),
                     fmt::format("record: expected one of {} tets, found {}", split_.tets.size(), removal.tet.value));
      removals_[removal.tet] = &removal;
    }
    copies_.resize(whole.mesh.tets.size());
    for (std::size_t t = 0; t < split_.tets.size(); ++t)
      copies_[t < copies_.size() ? t : state.splits.copies[t - copies_.size()].whole.index()].emplace_back(t);
  }

  DividedMesh run() {
    std::vector<std::uint8_t> is_divided(copies_.size(), 0);
    std::vector<std::int32_t> gone_step(copies_.size(), -1);  // of tets that lie in the kerf
    for (const TetId tet : state_.points.tets) {
      const int in_kerf = places_in_kerf(tet);
      if (in_kerf == 10)
        gone_step[tet.index()] = parted_step(nearest(tet, {0.25, 0.25, 0.25, 0.25}, true), corner(tet, 0).key);
      if ((in_kerf == 0 || in_kerf == 10) && copies_[tet.index()].size() == 1) continue;
      is_divided[tet.index()] = 1;
      const Tet& corners = whole_.mesh.tets[tet.index()];
      for (const auto& [a, b] : kEdges) halved_.insert(number_of(std::minmax(corners[a], corners[b])));
    }
    for (std::size_t t = 0; t < copies_.size(); ++t) {
      if (is_divided[t] != 0) {
        divide(TetId(t));
        continue;
      }
      const TetId split = copies_[t].front();
      if (has_halved_edge(TetId(t))) {
        add_fan(TetId(t), split, gone_step[t]);
      } else {
        add(whole_piece(split), TetId(t), split, gone_step[t]);
      }
    }
    return std::move(mesh_);
  }

 private:
  /// One of the ten places of a tet of the whole mesh: a corner (0 … 3) or the middle of an edge (4 … 9); without `id`.
  Corner corner(TetId whole, std::size_t i) {
    const Tet& named = whole_.mesh.tets[whole.index()];
    Corner corner{};
    const auto [a, b] = i < 4 ? std::array{i, i} : kEdges[i - 4];
    corner.shares[a] += 0.5;
    corner.shares[b] += 0.5;
    corner.key = std::minmax(named[a], named[b]);
    corner.dose = dose_at(corner.key);
    return corner;
  }
  /// The same place, with the `id` that it has in one of the tet's copies in the split mesh.
  Corner corner(TetId whole, TetId split, std::size_t i) {
    Corner corner = this->corner(whole, i);
    const Tet& own = split_.tets[split.index()];
    const auto [a, b] = i < 4 ? std::array{i, i} : kEdges[i - 4];
    corner.id = a == b ? own[a] : between(own[a], own[b], 0.5);
    return corner;
  }

  static std::uint64_t number_of(const Edge& edge) {
    return static_cast<std::uint64_t>(edge.first.index()) << 32U | edge.second.index();
  }
  [[nodiscard]] bool is_halved(TetId whole, std::size_t a, std::size_t b) const {
    const Tet& named = whole_.mesh.tets[whole.index()];
    return halved_.contains(number_of(std::minmax(named[a], named[b])));
  }
  [[nodiscard]] bool has_halved_edge(TetId whole) const {
    return std::ranges::any_of(
        kEdges, [&](const std::array<std::size_t, 2>& edge) { return is_halved(whole, edge[0], edge[1]); });
  }

  double dose_at(const Edge& edge) {
    const auto [at, is_new] = dose_.try_emplace(number_of(edge), 0.0);
    if (is_new) {
      const Points& rest = whole_.mesh.vertices;
      at->second = doses_.at(0.5 * (vertex(rest, edge.first) + vertex(rest, edge.second)));
    }
    return at->second;
  }

  /// Counts those of a tet's ten places that lie in the kerf.
  [[nodiscard]] int places_in_kerf(TetId tet) {
    const Tet& corners = whole_.mesh.tets[tet.index()];
    int count = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a; b < 4; ++b) count += dose_at(std::minmax(corners[a], corners[b])) >= 1.0 ? 1 : 0;
    }
    return count;
  }

  VertexId between(VertexId a, VertexId b, double share) {
    const bool is_in_order = a < b;
    const auto [at, is_new] = between_.try_emplace(number_of(std::minmax(a, b)), VertexId(vertices_));
    if (is_new) {
      ++vertices_;
      mesh_.between.push_back(is_in_order ? BetweenVertex{a, b, share} : BetweenVertex{b, a, 1.0 - share});
    }
    return at->second;
  }

  [[nodiscard]] Piece whole_piece(TetId split) const {
    Piece piece{};
    for (std::size_t c = 0; c < 4; ++c) {
      piece[c].id = split_.tets[split.index()][c];
      piece[c].shares[c] = 1.0;
    }
    return piece;
  }

  /// Adds a tet that is not divided but has halved edges, as a fan over its faces, which are divided at the halved
  /// edges. If these edges lie in one face, the fan runs over that face from the opposite vertex; otherwise over all
  /// faces from the tet's middle.
  void add_fan(TetId whole, TetId split, std::int32_t step) {
    const Piece piece = whole_piece(split);
    for (std::size_t f = 0; f < 4; ++f) {
      bool has_others = false;
      for (std::size_t c = 0; c < 4; ++c) has_others = has_others || (c != f && is_halved(whole, f, c));
      if (has_others) continue;
      add_fan_over(f, piece[f], whole, split, step);
      return;
    }
    const VertexId first = between(piece[0].id, piece[1].id, 0.5), second = between(piece[2].id, piece[3].id, 0.5);
    Corner middle{};
    middle.id = between(first, second, 0.5);
    middle.shares.fill(0.25);
    for (std::size_t f = 0; f < 4; ++f) add_fan_over(f, middle, whole, split, step);
  }

  void add_fan_over(std::size_t face, const Corner& from, TetId whole, TetId split, std::int32_t step) {
    const Piece piece = whole_piece(split);
    const Tet& named = whole_.mesh.tets[whole.index()];
    std::vector<std::size_t> at;
    for (std::size_t c = 0; c < 4; ++c) {
      if (c != face) at.push_back(c);
    }
    std::ranges::sort(at, {}, [&](std::size_t c) { return named[c]; });  // neighbours divide a shared face alike
    const auto add_part = [&](const Corner& a, const Corner& b, const Corner& c) {
      add({from, a, b, c}, whole, split, step);
    };
    const Corner &a = piece[at[0]], &b = piece[at[1]], &c = piece[at[2]];
    const std::optional<Corner> ab = middle_of(whole, split, at[0], at[1]), ac = middle_of(whole, split, at[0], at[2]),
                                bc = middle_of(whole, split, at[1], at[2]);
    if (ab && ac && bc) {
      add_part(a, *ab, *ac);
      add_part(*ab, b, *bc);
      add_part(*ac, *bc, c);
      add_part(*ab, *bc, *ac);
    } else {
      add_parts(a, b, c, ab, ac, bc, add_part);
    }
  }

  /// A triangle with at most two halved edges.
  template <class Add>
  static void add_parts(const Corner& a, const Corner& b, const Corner& c, const std::optional<Corner>& ab,
                        const std::optional<Corner>& ac, const std::optional<Corner>& bc, const Add& add_part) {
    if (ab) {  // the triangles on either side of the line from ab to c have at most one halved edge
      add_parts(a, *ab, c, std::nullopt, ac, std::nullopt, add_part);
      add_parts(*ab, b, c, std::nullopt, std::nullopt, bc, add_part);
    } else if (ac) {
      add_parts(a, b, *ac, std::nullopt, std::nullopt, std::nullopt, add_part);
      add_parts(*ac, b, c, std::nullopt, std::nullopt, bc, add_part);
    } else if (bc) {
      add_part(a, b, *bc);
      add_part(a, *bc, c);
    } else {
      add_part(a, b, c);
    }
  }

  /// The middle of an edge of a tet; nullopt: the edge is not halved.
  std::optional<Corner> middle_of(TetId whole, TetId split, std::size_t a, std::size_t b) {
    if (!is_halved(whole, a, b)) return std::nullopt;
    const auto edge = std::ranges::find(kEdges, std::array{std::min(a, b), std::max(a, b)});
    return corner(whole, split, 4 + static_cast<std::size_t>(edge - kEdges.begin()));
  }

  /// Divides a tet at the border. Each connected part of the tet on one side of the border moves with one copy of the
  /// tet: the copy that holds most of the points nearest to the part's pieces.
  void divide(TetId whole) {
    static const std::vector<Neighbours> kNeighbours = neighbouring_pieces();
    std::array<Corner, 10> places{};
    for (std::size_t i = 0; i < 10; ++i) places[i] = corner(whole, i);
    for (const bool is_gone : {false, true}) {
      const auto is_own = [&](std::size_t i) { return (places[i].dose >= 1.0) == is_gone; };
      DisjointSets sets(kPieces.size());
      for (const auto& [a, b, face] : kNeighbours) {
        if (std::ranges::any_of(face, is_own)) sets.join(a, b);
      }
      std::array<std::optional<std::size_t>, 8> near;  // the point nearest to each piece
      std::map<std::size_t, std::map<TetId, int>> votes;
      for (std::size_t k = 0; k < kPieces.size(); ++k) {
        std::array<double, 4> middle{};
        int own = 0;
        for (const std::size_t i : kPieces[k]) {
          if (!is_own(i)) continue;
          ++own;
          for (std::size_t m = 0; m < 4; ++m) middle[m] += places[i].shares[m];
        }
        if (own == 0) continue;
        for (double& share : middle) share /= own;
        near[k] = nearest(whole, middle, is_gone);
        ++votes[sets.root(k)][state_.points.tet_of[*near[k]]];
      }
      for (std::size_t k = 0; k < kPieces.size(); ++k) {
        if (!near[k]) continue;
        const auto& counts = votes.at(sets.root(k));
        const auto most = std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
        // If the halves of edges do not resolve the kerf between two parts, each piece follows its nearest point.
        const TetId split = !is_gone && votes.size() == 1 ? state_.points.tet_of[*near[k]] : most->first;
        Piece piece;
        for (std::size_t c = 0; c < 4; ++c) piece[c] = corner(whole, split, kPieces[k][c]);
        std::ranges::sort(piece, {}, &Corner::key);  // neighbours divide a shared face alike
        std::vector<Corner> own, others;
        for (const Corner& c : piece) ((c.dose >= 1.0) == is_gone ? own : others).push_back(c);
        const std::int32_t step = is_gone ? parted_step(*near[k], own[0].key) : -1;
        clip_tet(
            own, others, [&](const Corner& a, const Corner& b) { return crossing(a, b); },
            [&](const Piece& part) { add(part, whole, split, step); });
      }
    }
  }

  /// The point of a tet nearest to a place: among those on the given side of the border, if there are any.
  [[nodiscard]] std::size_t nearest(TetId whole, const std::array<double, 4>& shares, bool is_gone) const {
    const Vec3 place = position_of({whole, shares}, whole_.mesh, whole_.mesh.vertices);
    const auto [first, last] = lattice_.points_of(whole);
    std::size_t found = first;
    std::pair<bool, double> least{true, std::numeric_limits<double>::infinity()};
    for (std::size_t i = first; i < last; ++i) {
      const bool is_other = (state_.points.parted_step[i] >= 0) != is_gone;
      const std::pair<bool, double> apart{is_other, (lattice_.rest_position(i) - place).squaredNorm()};
      if (apart >= least) continue;
      least = apart;
      found = i;
    }
    return found;
  }

  /// The step in which tissue in the kerf parted: that of the point `near` it or, if this is not parted, of the parted
  /// node nearest to `place`.
  [[nodiscard]] std::int32_t parted_step(std::size_t near, const Edge& place) const {
    if (state_.points.parted_step[near] >= 0) return state_.points.parted_step[near];
    const Points& rest = whole_.mesh.vertices;
    const auto step = doses_.parted_step_near(0.5 * (vertex(rest, place.first) + vertex(rest, place.second)));
    INCISE_REQUIRE(step.has_value(), "points: expected a step for each parted point, found a dose of 1 without a step");
    return *step;
  }

  Corner crossing(const Corner& a, const Corner& b) {
    Corner cut{};
    const double share = (1.0 - a.dose) / (b.dose - a.dose);
    cut.id = between(a.id, b.id, share);
    for (std::size_t k = 0; k < 4; ++k) cut.shares[k] = a.shares[k] + share * (b.shares[k] - a.shares[k]);
    return cut;
  }

  /// @param step  in which the piece was removed, unless its tet was removed earlier; -1: it goes only with its tet.
  void add(Piece piece, TetId whole, TetId split, std::int32_t step) {
    std::array<Vec3, 4> at;
    for (std::size_t c = 0; c < 4; ++c) at[c] = {piece[c].shares[1], piece[c].shares[2], piece[c].shares[3]};
    if (signed_volume(at[0], at[1], at[2], at[3]) < 0.0) std::swap(piece[2], piece[3]);
    RemovalCause cause = RemovalCause::Dwell;
    const auto removal = removals_.find(split);  // doses still grow after the removal
    if (removal != removals_.end() && (step < 0 || removal->second->step < step)) {
      step = removal->second->step;
      cause = removal->second->cause;
    }
    std::uint8_t skin = 0;
    for (std::size_t f = 0; f < 4; ++f) {
      if (lies_on_skin(piece, f, whole)) skin = static_cast<std::uint8_t>(skin | 1U << f);
    }
    mesh_.tets.push_back({piece[0].id, piece[1].id, piece[2].id, piece[3].id});
    mesh_.split_tet.push_back(split);
    mesh_.skin_faces.push_back(skin);
    mesh_.gone_step.push_back(step);
    mesh_.gone_cause.push_back(cause);
  }

  [[nodiscard]] bool lies_on_skin(const Piece& piece, std::size_t face, TetId whole) const {
    for (std::size_t f = 0; f < 4; ++f) {
      bool is_within = true;
      for (std::size_t c = 0; c < 4; ++c) is_within = is_within && (c == face || piece[c].shares[f] == 0.0);
      if (is_within) return (on_skin_[whole.index()] >> f & 1U) != 0;
    }
    return false;
  }

  const TissueModel& whole_;
  const CutState& state_;
  TetMesh split_;
  PointLattice lattice_;
  DoseField doses_;
  std::size_t vertices_;
  std::map<TetId, const Removal*> removals_;
  std::vector<std::uint8_t> on_skin_;                    // of each tet of the whole mesh
  std::unordered_set<std::uint64_t> halved_;             // edges of divided tets
  std::vector<std::vector<TetId>> copies_;               // of each tet of the whole mesh: itself and its copies
  std::unordered_map<std::uint64_t, double> dose_;       // at vertices and middles of edges, by edge of the whole mesh
  std::unordered_map<std::uint64_t, VertexId> between_;  // by the two vertices in the divided mesh
  DividedMesh mesh_;
};

/// The mesh of a cut by whole tets.
DividedMesh undivided(const TissueModel& whole, const CutState& state) {
  DividedMesh mesh;
  mesh.tets = whole.mesh.tets;
  mesh.skin_faces = skin_faces(whole.mesh);
  mesh.gone_step.assign(mesh.tets.size(), -1);
  mesh.gone_cause.assign(mesh.tets.size(), RemovalCause::Dwell);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.split_tet.emplace_back(t);
  for (const Removal& removal : state.record.removals) {
    mesh.gone_step.at(removal.tet.index()) = removal.step;
    mesh.gone_cause.at(removal.tet.index()) = removal.cause;
  }
  return mesh;
}

}  // namespace

Points DividedMesh::positions(std::span<const Vec3> split) const {
  Points all(split.begin(), split.end());
  all.reserve(all.size() + between.size());
  for (const BetweenVertex& v : between) {
    const Vec3 from = vertex(all, v.a);
    all.emplace_back(from + v.share * (vertex(all, v.b) - from));
  }
  return all;
}

std::vector<std::uint8_t> DividedMesh::is_left(int step) const {
  std::vector<std::uint8_t> left;
  left.reserve(tets.size());
  for (const std::int32_t gone : gone_step) left.push_back(gone < 0 || gone > step ? 1 : 0);
  return left;
}

DividedMesh divide_at_kerf(const TissueModel& whole, const CutState& state) {
  if (state.points.tets.empty()) return undivided(whole, state);
  return Divider(whole, state).run();
}

}  // namespace incise
