#include "parting.hpp"

#include "point_rule.hpp"

#include <incise/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace incise {
namespace {

// Points are connected up to the diagonal of a cell of the lattice.
constexpr double kLinkMm = 1.75 * PointLattice::kSpacingMm;
// Points that are not nodes represent a whole small or flat tet. The nearest across a face are connected up to this.
constexpr double kFarLinkMm = 1.0;

/// Connected points of one tet.
struct Part {
  std::size_t star;  // index of its tet in stars_
  std::vector<std::size_t> points;
};

/// A tet that may have come apart, or that shares a vertex with one that may.
struct StarTet {
  TetId tet;
  std::size_t first_part = 0, last_part = 0;  // [first, last)
  bool is_cut = false;                        // a point of it, or of another copy of its whole tet, is parted
  bool has_nodes = true;                      // its points are nodes of the lattice
};

class Splitter {
 public:
  Splitter(const TissueModel& model, PointLattice& lattice, CutState& state)
      : model_(model),
        lattice_(lattice),
        state_(state),
        whole_tets_(model.mesh.tets.size() - state.splits.copies.size()) {}

  std::vector<TetId> run() {
    list_stars();
    find_parts();
    DisjointSets corners(4 * parts_.size());  // 4 * part + corner; the corners in one set share a vertex
    join_across_faces(corners);
    return apply(corners);
  }

 private:
  [[nodiscard]] bool is_parted(std::size_t point) const { return state_.points.dose[point] >= 1.0; }
  [[nodiscard]] const Tet& corners_of_star(std::size_t s) const { return model_.mesh.tets[stars_[s].tet.index()]; }

  /// Lists the live tets that share a vertex with a tet, live or removed, in which points parted since the last search.
  void list_stars() {
    std::set<TetId> changed;
    for (std::size_t i = 0; i < state_.points.parted_step.size(); ++i) {
      if (state_.points.parted_step[i] > state_.split_step) changed.insert(state_.points.tet_of[i]);
    }
    for (const TetId tet : changed) {
      for (const VertexId v : model_.mesh.tets[tet.index()]) vertices_.insert(v);
    }
    std::set<TetId> tets;
    for (const VertexId v : vertices_) {
      for (const std::int32_t place : model_.corners_at(v.index())) {
        const auto tet = static_cast<std::size_t>(place / 4);
        if (state_.tissue.is_live[tet] != 0) tets.emplace(tet);
      }
    }
    const std::vector<TetId> list(tets.begin(), tets.end());
    meet_points(list, lattice_, state_.points);
    for (const TetId tet : list) stars_.push_back({tet});
  }

  /// Finds the points of the stars that are not parted, and the connected parts of each tet.
  void find_parts() {
    std::vector<std::size_t> star_of;  // of each of left_
    for (std::size_t s = 0; s < stars_.size(); ++s) {
      StarTet& star = stars_[s];
      const auto [begin, end] = lattice_.points_of(star.tet);
      for (std::size_t i = begin; i < end; ++i) {
        if (lattice_.volume_mm3(i) == 0.0) continue;
        star.has_nodes = lattice_.node_of(i).has_value();
        star.is_cut = star.is_cut || is_parted(i);
        if (lattice_.tet_of(i) != star.tet || is_parted(i)) continue;
        if (star.has_nodes) at_node_[*lattice_.node_of(i)] = left_.size();
        left_.push_back(i);
        star_of.push_back(s);
      }
    }
    DisjointSets sets(left_.size());
    for (std::size_t a = 0; a < left_.size(); ++a) {
      if (!is_searched(stars_[star_of[a]])) {
        if (a > 0 && star_of[a - 1] == star_of[a]) sets.join(a - 1, a);
        continue;
      }
      for_each_neighbour(a, [&](std::size_t b) {
        if (star_of[a] == star_of[b]) sets.join(a, b);
      });
    }
    std::map<std::size_t, std::size_t> part_of;  // by root
    for (std::size_t a = 0; a < left_.size(); ++a) {
      StarTet& star = stars_[star_of[a]];
      if (a == 0 || star_of[a - 1] != star_of[a]) star.first_part = parts_.size();
      const auto [at, is_new] = part_of.try_emplace(sets.root(a), parts_.size());
      if (is_new) parts_.push_back({star_of[a], {}});
      parts_[at->second].points.push_back(left_[a]);
      part_of_.push_back(at->second);
      star.last_part = parts_.size();
    }
  }

  /// Whether the points of a tet may form several parts. A tet without parted points is one part, and so is a tet whose
  /// points are not nodes.
  [[nodiscard]] static bool is_searched(const StarTet& star) { return star.is_cut && star.has_nodes; }

  /// Calls `f` with the index in left_ of each node next to node `a`, itself included.
  template <class F>
  void for_each_neighbour(std::size_t a, const F& f) const {
    const PointLattice::Node& node = *lattice_.node_of(left_[a]);
    for (int step = 0; step < 27; ++step) {
      const auto found = at_node_.find({node[0] + step % 3 - 1, node[1] + step / 3 % 3 - 1, node[2] + step / 9 - 1});
      if (found != at_node_.end()) f(found->second);
    }
  }

  [[nodiscard]] double distance(std::size_t a, std::size_t b) const {
    return (lattice_.rest_position(a) - lattice_.rest_position(b)).norm();
  }
  [[nodiscard]] double distance(const Part& a, const Part& b) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t i : a.points) {
      for (const std::size_t k : b.points) least = std::min(least, distance(i, k));
    }
    return least;
  }

  void join_across_faces(DisjointSets& corners) const {
    std::set<std::pair<std::size_t, std::size_t>> linked;  // parts of two tets, the lower number first
    for (std::size_t a = 0; a < left_.size(); ++a) {
      if (!is_searched(stars_[parts_[part_of_[a]].star])) continue;
      for_each_neighbour(a, [&](std::size_t b) {
        if (part_of_[a] != part_of_[b]) linked.insert(std::minmax(part_of_[a], part_of_[b]));
      });
    }
    std::map<Triangle, std::vector<std::size_t>> at_face;  // by sorted vertices; several parts may lie on one side
    for (std::size_t s = 0; s < stars_.size(); ++s) {
      for (int f = 0; f < 4; ++f) {
        Triangle face = face_of(corners_of_star(s), f);
        std::ranges::sort(face);
        std::vector<std::size_t>& others = at_face[face];
        for (const std::size_t t : others) join(face, t, s, linked, corners);
        others.push_back(s);
      }
    }
  }

  void join(const Triangle& face, std::size_t s, std::size_t t,
            const std::set<std::pair<std::size_t, std::size_t>>& linked, DisjointSets& corners) const {
    const auto join_parts = [&](std::size_t p, std::size_t q) {
      for (const VertexId v : face) corners.join(corner_of(s, p, v), corner_of(t, q, v));
    };
    const bool is_whole = !stars_[s].is_cut && !stars_[t].is_cut;
    const bool has_nodes = stars_[s].has_nodes && stars_[t].has_nodes;
    std::optional<std::pair<std::size_t, std::size_t>> nearest;
    double least = kFarLinkMm;
    for (std::size_t p = stars_[s].first_part; p < stars_[s].last_part; ++p) {
      for (std::size_t q = stars_[t].first_part; q < stars_[t].last_part; ++q) {
        if (is_whole || linked.contains(std::minmax(p, q))) join_parts(p, q);
        if (is_whole || has_nodes) continue;
        const double apart = distance(parts_[p], parts_[q]);
        if (apart <= kLinkMm) join_parts(p, q);
        if (apart >= least) continue;
        least = apart;
        nearest = {p, q};
      }
    }
    if (nearest) join_parts(nearest->first, nearest->second);
  }

  [[nodiscard]] std::size_t corner_of(std::size_t s, std::size_t part, VertexId v) const {
    const Tet& tet = corners_of_star(s);
    return 4 * part + static_cast<std::size_t>(std::ranges::find(tet, v) - tet.begin());
  }

  /// Assigns a vertex to each set of corners: the first set at a vertex keeps it, each other set gets a copy.
  void name_vertices(DisjointSets& corners) {
    std::set<VertexId> kept;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (std::size_t c = 0; c < 4; ++c) {
        const VertexId v = corners_of_star(parts_[p].star)[c];
        if (!vertices_.contains(v) || vertex_of_.contains(corners.root(4 * p + c))) continue;
        vertex_of_[corners.root(4 * p + c)] = kept.insert(v).second ? v : add_vertex(v);
      }
    }
  }

  VertexId add_vertex(VertexId v) {
    state_.splits.vertices.push_back(v);
    const Vec3 place = state_.tissue.positions[v.index()];
    state_.tissue.positions.push_back(place);
    return VertexId(state_.tissue.positions.size() - 1);
  }

  std::vector<TetId> apply(DisjointSets& corners) {
    name_vertices(corners);
    std::vector<TetId> touched;
    for (const StarTet& star : stars_) {
      const Tet& before = model_.mesh.tets[star.tet.index()];
      std::vector<std::pair<Tet, std::vector<std::size_t>>> groups;  // corners, parts
      for (std::size_t p = star.first_part; p < star.last_part; ++p) {
        Tet tet = before;
        for (std::size_t c = 0; c < 4; ++c) {
          if (vertices_.contains(before[c])) tet[c] = vertex_of_.at(corners.root(4 * p + c));
        }
        const auto same = std::ranges::find(groups, tet, [](const auto& group) { return group.first; });
        if (same == groups.end()) {
          groups.push_back({tet, {p}});
        } else {
          same->second.push_back(p);
        }
      }
      if (groups.empty() || (groups.size() == 1 && groups[0].first == before)) continue;
      share_out(star, groups, touched);
    }
    std::ranges::sort(touched);
    return touched;
  }

  /// Gives each group of parts its own tet: the first group keeps the old one, the others get copies.
  void share_out(const StarTet& star, const std::vector<std::pair<Tet, std::vector<std::size_t>>>& groups,
                 std::vector<TetId>& touched) {
    std::vector<TetId> ids;
    for (std::size_t g = 0; g < groups.size(); ++g) ids.push_back(g == 0 ? star.tet : add_copy(star.tet));
    const auto [begin, end] = lattice_.points_of(star.tet);
    std::vector<std::size_t> own;
    for (std::size_t i = begin; i < end; ++i) {
      if (lattice_.tet_of(i) == star.tet) own.push_back(i);
    }
    std::vector<std::pair<Vec3, TetId>> left;  // at rest, mm
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (const std::size_t p : groups[g].second) {
        for (const std::size_t k : parts_[p].points) {
          left.emplace_back(lattice_.rest_position(k), ids[g]);
          state_.points.tet_of[k] = ids[g];
        }
      }
    }
    for (const std::size_t i : own) {  // a point of no part moves with the nearest one that has a part
      if (!is_parted(i) && lattice_.volume_mm3(i) != 0.0) continue;
      const Vec3 place = lattice_.rest_position(i);
      double least = std::numeric_limits<double>::infinity();
      for (const auto& [other, tet] : left) {
        const double apart = (place - other).norm();
        if (apart >= least) continue;
        least = apart;
        state_.points.tet_of[i] = tet;
      }
    }
    const double volume_mm3 = model_.volumes_mm3[star.tet.index()];
    const double share = share_of(state_.splits, whole_tets_, star.tet);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      double all = 0.0, filled = 0.0, dosed = 0.0;
      for (const std::size_t i : own) {
        if (state_.points.tet_of[i] != ids[g]) continue;
        all += lattice_.volume_mm3(i);
        dosed += lattice_.volume_mm3(i) * std::min(1.0, state_.points.dose[i]);
        if (!is_parted(i)) filled += lattice_.volume_mm3(i);
      }
      state_.tissue.fill[ids[g].index()] = std::clamp(filled / volume_mm3, kLeastFill, 1.0);
      state_.dose[ids[g].index()] = dosed / all;
      record(ids[g], groups[g].first, groups.size() == 1 ? share : std::min(1.0, all / volume_mm3));
      touched.push_back(ids[g]);
    }
  }

  [[nodiscard]] TetId whole_of(TetId tet) const {
    return tet.index() < whole_tets_ ? tet : state_.splits.copies[tet.index() - whole_tets_].whole;
  }
  void record(TetId tet, const Tet& corners, double share) {
    const SplitTet entry{whole_of(tet), corners, share};
    if (tet.index() >= whole_tets_) {
      state_.splits.copies[tet.index() - whole_tets_] = entry;
      return;
    }
    const auto at = std::ranges::lower_bound(state_.splits.changed, tet, {}, &SplitTet::whole);
    if (at != state_.splits.changed.end() && at->whole == tet) {
      *at = entry;
    } else {
      state_.splits.changed.insert(at, entry);
    }
  }

  TetId add_copy(TetId tet) {
    const std::size_t t = tet.index();
    TissueState& tissue = state_.tissue;
    const auto copy = [t](auto& list) { list.push_back(list[t]); };
    copy(tissue.rotations);
    copy(tissue.is_live);
    copy(tissue.fill);
    copy(state_.dose);
    copy(state_.tear_dose);
    if (!tissue.memory.strains.empty()) {
      const std::size_t terms = tissue.memory.branches.size() / tissue.memory.strains.size();
      copy(tissue.memory.strains);
      for (std::size_t k = 0; k < terms; ++k) tissue.memory.branches.push_back(tissue.memory.branches[t * terms + k]);
    }
    state_.splits.copies.push_back({whole_of(tet), model_.mesh.tets[t], 0.0});
    return TetId(whole_tets_ + state_.splits.copies.size() - 1);
  }

  const TissueModel& model_;
  PointLattice& lattice_;
  CutState& state_;
  std::size_t whole_tets_;
  std::set<VertexId> vertices_;  // of tets that may have come apart
  std::vector<StarTet> stars_;
  std::vector<std::size_t> left_;  // points of the stars that are not parted
  std::vector<std::size_t> part_of_;  // of each of them
  PointLattice::AtNodes<std::size_t> at_node_;  // place in left_
  std::vector<Part> parts_;
  std::map<std::size_t, VertexId> vertex_of_;  // by the root of a set of corners
};

}  // namespace

std::vector<TetId> split_parted_tets(const TissueModel& model, PointLattice& lattice, CutState& state) {
  std::vector<TetId> touched = Splitter(model, lattice, state).run();
  state.split_step = state.step;
  return touched;
}

}  // namespace incise
