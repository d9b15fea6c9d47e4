#pragma once

#include <array>
#include <vector>

namespace incise {

/// Divides the part of a tet on one side of a border into tets. The border crosses each edge at most once. Two tets
/// that share a face divide it in the same way if both give the face's corners in the same order.
/// @param own, others  the tet's corners on that side, and beyond the border.
/// @param cut          cut(a, b) returns the corner at which the border crosses the edge from a to b.
/// @param add          add(tet) receives each tet, four corners.
template <class Corner, class Cut, class Add>
void clip_tet(const std::vector<Corner>& own, const std::vector<Corner>& others, const Cut& cut, const Add& add) {
  const auto add_prism = [&](const std::array<Corner, 3>& a, const std::array<Corner, 3>& b) {
    add(std::array{a[0], a[1], a[2], b[0]});
    add(std::array{a[1], a[2], b[0], b[1]});
    add(std::array{a[2], b[0], b[1], b[2]});
  };
  const auto between = [&](std::size_t o, std::size_t k) { return cut(own[o], others[k]); };
  switch (own.size()) {
    case 1:
      add(std::array{own[0], between(0, 0), between(0, 1), between(0, 2)});
      break;
    case 2:
      add_prism({own[0], between(0, 0), between(0, 1)}, {own[1], between(1, 0), between(1, 1)});
      break;
    case 3:
      add_prism({own[0], own[1], own[2]}, {between(0, 0), between(1, 0), between(2, 0)});
      break;
    case 4:
      add(std::array{own[0], own[1], own[2], own[3]});
      break;
    default:
      break;
  }
}

}  // namespace incise
