#pragma once

#include <cstddef>
#include <vector>

namespace incise {

/// One line of samples in an exact Euclidean distance transform, which treats one axis after the other. Source:
/// Felzenszwalb and Huttenlocher, Theory of Computing 8 (2012).
class DistanceLine {
 public:
  std::vector<double> values;  ///< squared distance found so far, per sample; +infinity: none
  std::vector<double> result;  ///< the same with this line's direction included

  /// Sets result[q] = min over p of (spacing (q - p))² + values[p]: the lower envelope of a parabola on each sample.
  /// @param spacing  of the samples, > 0. O(samples).
  void transform(double spacing = 1.0);

 private:
  std::vector<std::size_t> apexes_;  // samples whose parabolas form the lower envelope
  std::vector<double> starts_;       // coordinate from which each of them is the lowest
};

}  // namespace incise
