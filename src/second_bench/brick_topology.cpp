#include "second_bench/brick_tissue.hpp"

#include <incise/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <bit>
#include <limits>

namespace incise::second_bench {
namespace {

constexpr Voxels kLowX = 0x1111111111111111ULL;
constexpr Voxels kLowY = 0x000F000F000F000FULL;
constexpr Voxels kLowZ = 0x000000000000FFFFULL;

Voxels grown(Voxels seed, Voxels within) {
  for (;;) {
    const Voxels x = ((seed & ~(kLowX << 3)) << 1) | ((seed & ~kLowX) >> 1);
    const Voxels y = ((seed & ~(kLowY << 12)) << 4) | ((seed & ~kLowY) >> 4);
    const Voxels z = (seed << 16) | (seed >> 16);
    const Voxels next = (seed | x | y | z) & within;
    if (next == seed) return seed;
    seed = next;
  }
}

void set_lane(Lanes& lanes, int piece, float value) {
  lanes[piece % kLanes] = value;
}

/// Copies material, size, viscous stress and corner nodes of a piece to another one.
void copy_state(BrickTissue& tissue, int from, int to) {
  const Octet source = tissue.octets[static_cast<std::size_t>(from) / kLanes];
  Octet& target = tissue.octets[static_cast<std::size_t>(to) / kLanes];
  const int a = from % kLanes;
  for (std::size_t i = 0; i < 3; ++i) {
    set_lane(target.inverse_size[i], to, source.inverse_size[i][a]);
    set_lane(target.fibre_axis[i], to, source.fibre_axis[i][a]);
  }
  for (std::size_t i = 0; i < 6; ++i) set_lane(target.past[i], to, source.past[i][a]);
  set_lane(target.c1, to, source.c1[a]);
  set_lane(target.c2, to, source.c2[a]);
  set_lane(target.lambda, to, source.lambda[a]);
  set_lane(target.fibre, to, source.fibre[a]);
  for (std::size_t c = 0; c < 8; ++c)
    target.node[c][static_cast<std::size_t>(to) % kLanes] = source.node[c][static_cast<std::size_t>(a)];
}

constexpr float kHourglassShare = 0.5F;  // of the bending stiffness of a fully integrated brick

void set_voxels(BrickTissue& tissue, int piece, Voxels voxels) {
  tissue.voxels_of[static_cast<std::size_t>(piece)] = voxels;
  Octet& octet = tissue.octets[static_cast<std::size_t>(piece) / kLanes];
  const int lane = piece % kLanes;
  const float fine = std::max({octet.inverse_size[0][lane], octet.inverse_size[1][lane], octet.inverse_size[2][lane]});
  const float brick = 1.0F / (octet.inverse_size[0][lane] * octet.inverse_size[1][lane] * octet.inverse_size[2][lane]);
  const float volume = brick * static_cast<float>(std::popcount(voxels)) / kVoxels;
  set_lane(octet.volume, piece, volume);
  set_lane(octet.hourglass, piece, kHourglassShare * volume * fine * fine / 24.0F);
  if (voxels != 0) return;
  for (std::size_t c = 0; c < 8; ++c) octet.node[c][static_cast<std::size_t>(lane)] = 0;
}

int add_piece(BrickTissue& tissue, std::size_t brick) {
  const auto piece = static_cast<int>(tissue.piece_count());
  if (piece % kLanes == 0) {
    Octet& octet = tissue.octets.emplace_back();
    octet = Octet{};
    for (Lanes& lanes : octet.inverse_size) lanes += 1.0F;  // in lanes without a piece: no division by 0
    octet.lambda += 1.0F;
    octet.c1 += 1.0F;
  }
  tissue.brick_of.push_back(static_cast<std::uint32_t>(brick));
  tissue.voxels_of.push_back(0);
  return piece;
}

std::int32_t add_node(BrickTissue& tissue, const std::array<float, 4>& position) {
  tissue.position.push_back(position);
  tissue.velocity.push_back({});
  tissue.force.push_back({});
  tissue.mass.push_back(1.0F);
  tissue.is_held.push_back(0);
  return static_cast<std::int32_t>(tissue.position.size()) - 1;
}

/// Gives each connected set of pieces round a corner of the grid its own node.
void share_corner(BrickTissue& tissue, int i, int j, int k) {
  struct Member {
    int piece;
    int octant;  // bit 0: the brick lies after the corner along x, ...
  };
  std::vector<Member> members;
  const BrickGrid& grid = tissue.grid;
  for (int octant = 0; octant < 8; ++octant) {
    const int a = i - 1 + (octant & 1), b = j - 1 + (octant >> 1 & 1), c = k - 1 + (octant >> 2);
    if (a < 0 || b < 0 || c < 0 || a >= grid.bricks_along(0) || b >= grid.bricks_along(1) || c >= grid.bricks_along(2))
      continue;
    for (const int piece : tissue.pieces_of[grid.brick(a, b, c)]) members.push_back({piece, octant});
  }
  DisjointSets sets(members.size());
  for (std::size_t m = 0; m < members.size(); ++m)
    for (std::size_t n = m + 1; n < members.size(); ++n) {
      const Member &low = members[m], &high = members[n];
      const int way = low.octant ^ high.octant;
      if (!std::has_single_bit(static_cast<unsigned>(way))) continue;
      const int axis = std::countr_zero(static_cast<unsigned>(way));
      if (touch(tissue.voxels_of[static_cast<std::size_t>(low.piece)],
                tissue.voxels_of[static_cast<std::size_t>(high.piece)], axis))
        sets.join(m, n);
    }
  std::vector<std::int32_t> node_of(members.size(), -1);
  std::vector<std::int32_t> taken;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Member& member = members[m];
    auto& corner =
        tissue.octets[static_cast<std::size_t>(member.piece) / kLanes]
            .node[static_cast<std::size_t>(7 - member.octant)][static_cast<std::size_t>(member.piece) % kLanes];
    std::int32_t& node = node_of[sets.root(m)];
    if (node < 0) {
      node = corner;
      if (std::find(taken.begin(), taken.end(), node) != taken.end()) {
        const auto old = static_cast<std::size_t>(corner);
        node = add_node(tissue, tissue.position[old]);
        tissue.velocity.back() = tissue.velocity[old];
        tissue.is_held.back() = tissue.is_held[old];
      }
      taken.push_back(node);
    }
    corner = node;
  }
}

}  // namespace

Voxels first_connected(Voxels voxels) {
  return grown(voxels & (~voxels + 1), voxels);
}

bool touch(Voxels low, Voxels high, int axis) {
  switch (axis) {
    case 0:
      return ((low >> 3) & high & kLowX) != 0;
    case 1:
      return ((low >> 12) & high & kLowY) != 0;
    default:
      return ((low >> 48) & high & kLowZ) != 0;
  }
}

std::size_t BrickGrid::brick_count() const {
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) count *= static_cast<std::size_t>(bricks_along(axis));
  return count;
}
std::size_t BrickGrid::brick(int i, int j, int k) const {
  return static_cast<std::size_t>((k * bricks_along(1) + j) * bricks_along(0) + i);
}
std::size_t BrickGrid::corner(int i, int j, int k) const {
  return static_cast<std::size_t>((k * (bricks_along(1) + 1) + j) * (bricks_along(0) + 1) + i);
}
std::array<int, 3> BrickGrid::place_of(std::size_t brick) const {
  const auto n = static_cast<int>(brick);
  return {n % bricks_along(0), n / bricks_along(0) % bricks_along(1), n / bricks_along(0) / bricks_along(1)};
}
Vec3 BrickGrid::low_mm(const std::array<int, 3>& place) const {
  return {planes_mm[0][static_cast<std::size_t>(place[0])], planes_mm[1][static_cast<std::size_t>(place[1])],
          planes_mm[2][static_cast<std::size_t>(place[2])]};
}
Vec3 BrickGrid::size_mm(const std::array<int, 3>& place) const {
  return low_mm({place[0] + 1, place[1] + 1, place[2] + 1}) - low_mm(place);
}
Vec3 BrickGrid::voxel_mm(const std::array<int, 3>& place, int bit) const {
  const Vec3 share((bit % 4 + 0.5) / kVoxelsAcross, (bit / 4 % 4 + 0.5) / kVoxelsAcross,
                   (bit / 16 + 0.5) / kVoxelsAcross);
  return low_mm(place) + share.cwiseProduct(size_mm(place));
}
int BrickGrid::along(int axis, double x_mm) const {
  const auto& planes = planes_mm[static_cast<std::size_t>(axis)];
  const auto after = std::upper_bound(planes.begin(), planes.end(), x_mm);
  return std::clamp(static_cast<int>(after - planes.begin()) - 1, 0, bricks_along(axis) - 1);
}

Vec3 BrickTissue::position_of(const Rider& rider) const {
  Vec3 sum = Vec3::Zero();
  for (int c = 0; c < 8; ++c) {
    const auto& p = position[static_cast<std::size_t>(node(rider.piece, c))];
    sum += static_cast<double>(rider.weights[static_cast<std::size_t>(c)]) * Vec3(p[0], p[1], p[2]);
  }
  return sum;
}

int BrickTissue::piece_with(std::size_t brick, int bit) const {
  for (const int piece : pieces_of[brick])
    if ((voxels_of[static_cast<std::size_t>(piece)] >> bit & 1) != 0) return piece;
  return -1;
}

Rider BrickTissue::rider_at(const Vec3& rest_mm) const {
  // A search over all voxels of the bricks around is fast enough: they are few, and a rider is made once.
  std::array<int, 3> middle{};
  for (int axis = 0; axis < 3; ++axis) middle[static_cast<std::size_t>(axis)] = grid.along(axis, rest_mm[axis]);
  Rider rider;
  double nearest = std::numeric_limits<double>::infinity();
  for (int reach = 0; reach < 4 && rider.piece < 0; ++reach) {
    for (int c = middle[2] - reach; c <= middle[2] + reach; ++c)
      for (int b = middle[1] - reach; b <= middle[1] + reach; ++b)
        for (int a = middle[0] - reach; a <= middle[0] + reach; ++a) {
          if (a < 0 || b < 0 || c < 0 || a >= grid.bricks_along(0) || b >= grid.bricks_along(1) ||
              c >= grid.bricks_along(2))
            continue;
          for (const int piece : pieces_of[grid.brick(a, b, c)])
            for (int bit = 0; bit < kVoxels; ++bit) {
              if ((voxels_of[static_cast<std::size_t>(piece)] >> bit & 1) == 0) continue;
              const double distance = (grid.voxel_mm({a, b, c}, bit) - rest_mm).squaredNorm();
              if (!(distance < nearest)) continue;
              nearest = distance;
              rider.piece = piece;
            }
        }
  }
  return rider.piece < 0 ? rider : rider_on(rider.piece, rest_mm);
}

Rider BrickTissue::rider_on(int piece, const Vec3& rest_mm) const {
  const std::array<int, 3> place = grid.place_of(brick_of[static_cast<std::size_t>(piece)]);
  const Vec3 share = (rest_mm - grid.low_mm(place)).cwiseQuotient(grid.size_mm(place));
  Rider rider;
  rider.piece = piece;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) weight *= (corner >> axis & 1) != 0 ? share[axis] : 1.0 - share[axis];
    rider.weights[static_cast<std::size_t>(corner)] = static_cast<float>(weight);
  }
  return rider;
}

BrickTissue make_tissue(BrickGrid grid, const std::vector<BrickMaterial>& materials,
                        const std::vector<Voxels>& voxels) {
  BrickTissue tissue;
  tissue.grid = std::move(grid);
  const BrickGrid& g = tissue.grid;
  tissue.pieces_of.resize(g.brick_count());
  add_node(tissue, {});
  tissue.is_held[0] = 1;
  const std::size_t corners = static_cast<std::size_t>(g.bricks_along(0) + 1) *
                              static_cast<std::size_t>(g.bricks_along(1) + 1) *
                              static_cast<std::size_t>(g.bricks_along(2) + 1);
  std::vector<std::int32_t> node_at(corners, -1);
  for (std::size_t brick = 0; brick < g.brick_count(); ++brick) {
    const std::array<int, 3> place = g.place_of(brick);
    for (Voxels left = voxels[brick]; left != 0;) {
      const Voxels part = first_connected(left);
      left &= ~part;
      const int piece = add_piece(tissue, brick);
      tissue.pieces_of[brick].push_back(piece);
      Octet& octet = tissue.octets[static_cast<std::size_t>(piece) / kLanes];
      const Vec3 size = g.size_mm(place);
      const BrickMaterial& material = materials[brick];
      for (int axis = 0; axis < 3; ++axis) {
        set_lane(octet.inverse_size[static_cast<std::size_t>(axis)], piece, static_cast<float>(1.0 / size[axis]));
        set_lane(octet.fibre_axis[static_cast<std::size_t>(axis)], piece, static_cast<float>(material.fibre[axis]));
      }
      set_lane(octet.c1, piece, material.c1_kpa);
      set_lane(octet.c2, piece, material.c2_kpa);
      set_lane(octet.lambda, piece, material.lambda_kpa);
      set_lane(octet.fibre, piece, material.fibre_kpa);
      for (int corner = 0; corner < 8; ++corner) {
        const std::array<int, 3> at{place[0] + (corner & 1), place[1] + (corner >> 1 & 1), place[2] + (corner >> 2)};
        std::int32_t& node = node_at[g.corner(at[0], at[1], at[2])];
        if (node < 0) {
          const Vec3 p = g.low_mm(at);
          node =
              add_node(tissue, {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0.0F});
        }
        octet.node[static_cast<std::size_t>(corner)][static_cast<std::size_t>(piece) % kLanes] = node;
      }
      set_voxels(tissue, piece, part);
    }
  }
  for (int k = 0; k <= g.bricks_along(2); ++k)
    for (int j = 0; j <= g.bricks_along(1); ++j)
      for (int i = 0; i <= g.bricks_along(0); ++i) share_corner(tissue, i, j, k);
  return tissue;
}

void remove_voxels(BrickTissue& tissue, const std::vector<std::pair<int, Voxels>>& gone) {
  std::vector<std::array<int, 3>> corners;
  for (const auto& [piece, voxels] : gone) {
    const auto p = static_cast<std::size_t>(piece);
    const std::size_t brick = tissue.brick_of[p];
    Voxels left = tissue.voxels_of[p] & ~voxels;
    const Voxels first = left == 0 ? 0 : first_connected(left);
    left &= ~first;
    while (left != 0) {
      const Voxels part = first_connected(left);
      left &= ~part;
      const int added = add_piece(tissue, brick);
      copy_state(tissue, piece, added);
      set_voxels(tissue, added, part);
      tissue.pieces_of[brick].push_back(added);
    }
    set_voxels(tissue, piece, first);
    if (first == 0) std::erase(tissue.pieces_of[brick], piece);
    const std::array<int, 3> place = tissue.grid.place_of(brick);
    for (int corner = 0; corner < 8; ++corner)
      corners.push_back({place[0] + (corner & 1), place[1] + (corner >> 1 & 1), place[2] + (corner >> 2)});
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  for (const auto& [i, j, k] : corners) share_corner(tissue, i, j, k);
}

void shrink(BrickTissue& tissue, int piece, float share) {
  const auto p = static_cast<std::size_t>(piece);
  const Vec3 size = tissue.grid.size_mm(tissue.grid.place_of(tissue.brick_of[p]));
  for (std::size_t axis = 0; axis < 3; ++axis)
    set_lane(tissue.octets[p / kLanes].inverse_size[axis], piece,
             1.0F / (share * static_cast<float>(size[static_cast<Eigen::Index>(axis)])));
  set_voxels(tissue, piece, tissue.voxels_of[p]);
}

std::size_t remove_loose(BrickTissue& tissue) {
  DisjointSets sets(tissue.position.size());
  const auto node_of = [&](int piece, int corner) { return static_cast<std::size_t>(tissue.node(piece, corner)); };
  const auto pieces = static_cast<int>(tissue.piece_count());
  for (int p = 0; p < pieces; ++p) {
    if (tissue.voxels_of[static_cast<std::size_t>(p)] == 0) continue;
    for (int c = 1; c < 8; ++c) sets.join(node_of(p, 0), node_of(p, c));
  }
  std::vector<std::uint8_t> hangs(tissue.position.size(), 0);
  for (std::size_t n = 1; n < hangs.size(); ++n)
    if (tissue.is_held[n] != 0) hangs[sets.root(n)] = 1;
  std::size_t count = 0;
  std::vector<std::pair<int, Voxels>> loose;
  for (int p = 0; p < pieces; ++p) {
    const Voxels voxels = tissue.voxels_of[static_cast<std::size_t>(p)];
    if (voxels == 0 || hangs[sets.root(node_of(p, 0))] != 0) continue;
    count += static_cast<std::size_t>(std::popcount(voxels));
    loose.emplace_back(p, voxels);
  }
  if (!loose.empty()) remove_voxels(tissue, loose);
  return count;
}

}  // namespace incise::second_bench
