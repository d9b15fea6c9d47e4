#include <incise/geometry/thinning.hpp>

#include <array>
#include <numeric>

namespace incise {
namespace {

/// The eight neighbours, once round:
///   3 2 1
///   4 . 0
///   5 6 7
using Neighbours = std::array<int, 8>;
constexpr std::array<std::array<int, 2>, 8> kSteps{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

Neighbours neighbours(const Raster& raster, int i, int j) {
  Neighbours n{};
  for (std::size_t k = 0; k < 8; ++k) {
    n[k] = raster.at_or(i + kSteps[k][0], j + kSteps[k][1], 0) != 0 ? 1 : 0;
  }
  return n;
}

int count(const Neighbours& n) {
  return std::accumulate(n.begin(), n.end(), 0);
}

/// Number of changes from 0 to 1, once round.
int rises(const Neighbours& n) {
  int sum = 0;
  for (std::size_t k = 0; k < 8; ++k) sum += n[k] == 0 && n[(k + 1) % 8] == 1 ? 1 : 0;
  return sum;
}

/// Whether the pixel can be removed without connecting or separating anything: Yokoi's connectivity number for
/// eight-connected sets is 1.
bool is_simple(const Neighbours& n) {
  int number = 0;
  for (std::size_t k = 0; k < 8; k += 2) number += (1 - n[k]) - (1 - n[k]) * (1 - n[k + 1]) * (1 - n[(k + 2) % 8]);
  return number == 1;
}

/// One of the two half passes of Zhang and Suen: the first strips the south-east, the second the north-west. Returns
/// whether a pixel was removed. Of pixels that were chosen together, each is removed only if it is still superfluous
/// then; otherwise a square of 2 x 2 would vanish. Pixels with two neighbours, which the source also strips, stay;
/// otherwise a slanting line two pixels wide would shrink from its ends.
bool strip(Raster& raster, bool is_first) {
  std::vector<std::array<int, 2>> doomed;
  for (int j = 0; j < raster.height; ++j) {
    for (int i = 0; i < raster.width; ++i) {
      if (raster.at(i, j) == 0) continue;
      const Neighbours n = neighbours(raster, i, j);
      const int filled = count(n);
      if (filled < 3 || filled > 6 || rises(n) != 1) continue;
      const int east = n[0];
      const int north = n[2];
      const int west = n[4];
      const int south = n[6];
      const bool goes = is_first ? north * east * south == 0 && east * south * west == 0
                                 : north * east * west == 0 && north * south * west == 0;
      if (goes) doomed.push_back({i, j});
    }
  }
  bool has_changed = false;
  for (const auto& [i, j] : doomed) {
    const Neighbours n = neighbours(raster, i, j);
    if (count(n) < 2 || !is_simple(n)) continue;
    raster.at(i, j) = 0;
    has_changed = true;
  }
  return has_changed;
}

/// Removes the corners of staircases, one after the other, which have neighbours at two sides; an end has one at most
/// and stays. Returns whether a pixel was removed.
bool cut_corners(Raster& raster) {
  bool has_changed = false;
  for (int j = 0; j < raster.height; ++j) {
    for (int i = 0; i < raster.width; ++i) {
      if (raster.at(i, j) == 0) continue;
      const Neighbours n = neighbours(raster, i, j);
      if (n[0] + n[2] + n[4] + n[6] < 2 || !is_simple(n)) continue;
      raster.at(i, j) = 0;
      has_changed = true;
    }
  }
  return has_changed;
}

}  // namespace

Raster thinned(Raster raster) {
  bool has_changed = true;
  while (has_changed) {  // terminates, as does the next loop: every pass but the last removes a pixel
    const bool first = strip(raster, true);
    const bool second = strip(raster, false);
    has_changed = first || second;
  }
  while (cut_corners(raster)) continue;
  return raster;
}

}  // namespace incise
