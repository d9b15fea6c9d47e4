#pragma once

#include <array>
#include <vector>

namespace incise {

/// The part of a tet on one side of a border that crosses each edge once, in tets. Two tets that share a face divide it
/// alike where both give its corners in one order.
/// @param own, others  its corners on that side, and beyond the border. @param cut  cut(a, b): where the border crosses
/// the edge from a to b. @param add  is given the tets.
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
