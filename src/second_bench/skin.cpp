#include "second_bench/body_state.hpp"

#include <incise/second_bench/cut.hpp>

namespace incise::second_bench {
namespace {

/// The highest remaining voxel of a column.
struct Top {
  int piece = -1;              // none: no tissue is left
  std::array<int, 3> place{};  // of its brick
  int bit = 0;
  bool is_uncut = false;
};

Top find_top(const BodyState& state, int i, int j, const TissueSpan& span) {
  const BrickGrid& grid = state.tissue.grid;
  Top top;
  top.is_uncut = true;
  for (int k = grid.along(2, span.high_mm); k >= 0; --k)
    for (int c = kVoxelsAcross - 1; c >= 0; --c) {
      top.place = {i / kVoxelsAcross, j / kVoxelsAcross, k};
      top.bit = i % kVoxelsAcross + kVoxelsAcross * (j % kVoxelsAcross) + kVoxelsAcross * kVoxelsAcross * c;
      const double z = grid.voxel_mm(top.place, top.bit).z();
      if (z > span.high_mm || z < span.low_mm) continue;
      top.piece = state.tissue.piece_with(grid.brick(top.place[0], top.place[1], k), top.bit);
      if (top.piece >= 0) return top;
      top.is_uncut = false;
    }
  return {};
}

/// Draws the remaining tissue: the skin as a square for each uncut column, joined between neighbouring columns, so it
/// ends exactly at its last voxel; walls and bottom of a kerf as triangles between the middles of columns.
class Surface {
 public:
  explicit Surface(const BodyState& state) : state_(state), nx_(state.columns_x()), ny_(state.columns_y()) {
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) {
        const auto& span = state.columns[at(i, j)];
        tops_.push_back(span ? find_top(state, i, j, *span) : Top{});
      }
    seen_.tumor_edge = tumor_edge_of(state);
  }

  SeenTissue draw() {
    corners_.resize(tops_.size());
    for (int j = 0; j <= ny_; ++j)
      for (int i = 0; i <= nx_; ++i) join_at(i, j);
    for (std::size_t n = 0; n < tops_.size(); ++n) {
      if (tops_[n].is_uncut) add(corners_[n], true);
    }
    walls();
    return std::move(seen_);
  }

 private:
  using Square = std::array<VertexId, 4>;  // counter-clockwise from the corner that is least along x and y

  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
  }

  void add(const Square& square, bool is_skin) {
    for (const std::size_t n : {1U, 2U}) {
      seen_.triangles.push_back({square[0], square[n], square[n + 1]});
      seen_.is_skin.push_back(is_skin ? 1 : 0);
    }
  }

  VertexId add_vertex(const Vec3& position, const Vec3& rest) {
    seen_.vertices.push_back(position);
    seen_.rest.push_back(rest);
    return VertexId(seen_.vertices.size() - 1);
  }

  [[nodiscard]] Vec3 top_mm(const Top& top, const Vec2& from_middle) const {
    const Vec3 voxel = state_.tissue.grid.size_mm(top.place) / kVoxelsAcross;
    Vec3 rest = state_.tissue.grid.voxel_mm(top.place, top.bit) + 0.5 * voxel;
    rest.head<2>() += (from_middle - Vec2::Constant(0.5)).cwiseProduct(voxel.head<2>());
    if (!top.is_uncut) return rest;
    const auto there = span_at(state_.shape, rest.x(), rest.y());
    if (there) rest.z() = there->high_mm;  // otherwise the shape ends within the voxel, and the voxel's top counts
    return rest;
  }

  /// Gives each set of neighbouring uncut columns round a corner one vertex.
  void join_at(int i, int j) {
    struct Member {
      std::size_t column = 0;
      std::size_t corner = 0;  // of its square
      bool is_uncut = false;
    };
    std::array<Member, 4> ring;  // round the corner
    constexpr std::array<std::array<int, 2>, 4> kAround{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
    for (std::size_t n = 0; n < 4; ++n) {
      const int a = i + kAround[n][0], b = j + kAround[n][1];
      if (a < 0 || b < 0 || a >= nx_ || b >= ny_) continue;
      ring[n] = {at(a, b), (n + 2) % 4, tops_[at(a, b)].is_uncut};
    }
    std::size_t first = 0;  // start of a set: the member before it is not uncut; 4: all four are one set
    while (first < 4 && ring[(first + 3) % 4].is_uncut) ++first;
    for (std::size_t n = 0; n < 4;) {
      std::vector<Member> set;
      for (; n < 4 && ring[(first + n) % 4].is_uncut; ++n) set.push_back(ring[(first + n) % 4]);
      ++n;  // the one that ended it
      if (set.empty()) continue;
      Vec3 position = Vec3::Zero(), rest = Vec3::Zero();
      for (const Member& member : set) {
        const Top& top = tops_[member.column];
        const Vec2 side(member.corner == 1 || member.corner == 2 ? 0.5 : -0.5, member.corner >= 2 ? 0.5 : -0.5);
        const Vec3 place = top_mm(top, side);
        rest += place / static_cast<double>(set.size());
        position += state_.tissue.position_of(state_.tissue.rider_on(top.piece, place)) / static_cast<double>(set.size());
      }
      const VertexId vertex = add_vertex(position, rest);
      for (const Member& member : set) corners_[member.column][member.corner] = vertex;
    }
  }

  void walls() {
    std::vector<std::optional<VertexId>> middle(tops_.size());
    const auto vertex_of = [&](std::size_t column) {
      if (!middle[column]) {
        const Vec3 rest = top_mm(tops_[column], Vec2::Zero());
        middle[column] =
            add_vertex(state_.tissue.position_of(state_.tissue.rider_on(tops_[column].piece, rest)), rest);
      }
      return *middle[column];
    };
    for (int j = 0; j + 1 < ny_; ++j)
      for (int i = 0; i + 1 < nx_; ++i) {
        const std::array<std::size_t, 4> column{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        for (const auto& [a, b, c] : {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{0, 2, 3}}) {
          const Top &x = tops_[column[a]], &y = tops_[column[b]], &z = tops_[column[c]];
          if (x.piece < 0 || y.piece < 0 || z.piece < 0 || (x.is_uncut && y.is_uncut && z.is_uncut)) continue;
          seen_.triangles.push_back({vertex_of(column[a]), vertex_of(column[b]), vertex_of(column[c])});
          seen_.is_skin.push_back(0);
        }
      }
  }

  const BodyState& state_;
  int nx_, ny_;
  std::vector<Top> tops_;
  std::vector<Square> corners_;  // per column, of its square of skin
  SeenTissue seen_;
};

}  // namespace

SeenTissue seen_from_above(const BodyState& state) {
  return Surface(state).draw();
}

}  // namespace incise::second_bench
