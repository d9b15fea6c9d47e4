#include "mechanics/single_pcg.hpp"

#include "mechanics/kernels/kernels.hpp"
#include "mechanics/large_pages.hpp"
#include "mechanics/pcg_iteration.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace incise {
namespace {

constexpr std::uint8_t kRowChanged = 1;
constexpr std::uint8_t kScaleChanged = 2;

/// Returns the power of two at or above the square root; 1 for a row of zeros.
float scale_for(double largest_on_diagonal) {
  if (!(largest_on_diagonal > 0.0)) return 1.0F;
  int exponent = 0;
  const double fraction = std::frexp(std::sqrt(largest_on_diagonal), &exponent);  // in [1/2, 1)
  return std::ldexp(1.0F, fraction == 0.5 ? exponent - 1 : exponent);
}

}  // namespace

SinglePcg::SinglePcg(std::shared_ptr<const BlockPattern> pattern, const CoarseSpace& coarse)
    : pattern_(std::move(pattern)),
      vertex_(coarse.aggregates().vertices),
      start_(coarse.aggregates().start),
      is_coarse_dense_(coarse.is_dense()) {
  const std::size_t count = pattern_->rows();
  std::vector<std::int32_t> own(count);
  for (std::size_t i = 0; i < count; ++i) own[static_cast<std::size_t>(vertex_[i])] = static_cast<std::int32_t>(i);
  row_start_.push_back(0);
  std::vector<std::pair<std::int32_t, std::int32_t>> row;  // own column, slot of the pattern
  for (std::size_t i = 0; i < count; ++i) {
    const auto v = static_cast<std::size_t>(vertex_[i]);
    row.clear();
    for (auto slot = pattern_->row_start[v]; slot < pattern_->row_start[v + 1]; ++slot) {
      const auto column = static_cast<std::size_t>(pattern_->column[static_cast<std::size_t>(slot)]);
      row.emplace_back(own[column], slot);
    }
    std::sort(row.begin(), row.end());
    for (const auto& [column, slot] : row) {
      column_.push_back(column);
      source_slot_.push_back(slot);
    }
    row_start_.push_back(static_cast<std::int32_t>(column_.size()));
  }
  values_ = zeros_in_large_pages<std::int16_t>(9 * column_.size() + kBeyondBlocks);
  scale_.assign(count, 0.0F);
  is_stale_.assign(count, 1);
  is_too_large_.assign(count, 0);
  left_.assign(9 * count + kBeyondBlocks, 0.0F);
  inverse_diagonal_.assign(12 * count, 0.0F);
  for (std::vector<float>* vector : {&arm_, &is_free_, &x_, &r_, &z_, &p_, &q_, &scaled_p_})
    vector->assign(4 * count, 0.0F);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& arm = coarse.arm(static_cast<std::size_t>(vertex_[i]));
    for (std::size_t k = 0; k < 3; ++k) arm_[4 * i + k] = static_cast<float>(arm[static_cast<int>(k)]);
  }
  restricted_.assign(coarse.size(), 0.0F);
  motion_.assign(coarse.size(), 0.0F);
  partial_rr_.resize(Workers::chunk_count(start_.size() - 1, kAggregatesPerChunk));
  partial_rz_.resize(partial_rr_.size());
  partial_pq_.resize(partial_rr_.size());
}

template <class Body>
void SinglePcg::for_aggregates(Workers& workers, const Body& body) const {
  workers.for_chunks(start_.size() - 1, kAggregatesPerChunk, body);
}

/// Updates the scales of the changed rows and flags the rows to round again: the changed ones, and all that share a
/// block with a row whose scale changed.
void SinglePcg::rescale(const BlockMatrix& matrix, std::span<const std::uint8_t> changed_rows, Workers& workers) {
  std::fill(is_stale_.begin(), is_stale_.end(), std::uint8_t{0});
  std::atomic<bool> has_new_scale = false;
  for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::size_t>(start_[begin]); i < static_cast<std::size_t>(start_[end]); ++i) {
      const auto v = static_cast<std::size_t>(vertex_[i]);
      if (!changed_rows.empty() && changed_rows[v] == 0) continue;
      const double* diagonal = matrix.block(pattern_->diagonal[v]);
      const float scale = scale_for(std::max({diagonal[0], diagonal[4], diagonal[8]}));
      is_stale_[i] = scale == scale_[i] ? kRowChanged : kScaleChanged;
      if (scale != scale_[i]) has_new_scale = true;
      scale_[i] = scale;
    }
  });
  if (!has_new_scale) return;
  for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::size_t>(start_[begin]); i < static_cast<std::size_t>(start_[end]); ++i) {
      if (is_stale_[i] != 0) continue;
      const auto row = std::span(column_).subspan(static_cast<std::size_t>(row_start_[i]),
                                                  static_cast<std::size_t>(row_start_[i + 1] - row_start_[i]));
      const bool has_rescaled = std::any_of(row.begin(), row.end(), [&](std::int32_t j) {
        return is_stale_[static_cast<std::size_t>(j)] == kScaleChanged;
      });
      if (has_rescaled) is_stale_[i] = kRowChanged;
    }
  });
}

/// Rounds one row and adds its rounding errors, made symmetric, to the diagonal block: where neighbours move alike, no
/// energy is lost or created, so soft modes of a body keep their stiffness. @returns whether all numbers are within the
/// bound of a positive semi-definite matrix.
bool SinglePcg::round_row(const BlockMatrix& matrix, std::size_t row) {
  bool is_small = true;
  std::array<float, 9> left{};
  std::int16_t* to = values_.data() + 9 * static_cast<std::size_t>(row_start_[row]);
  for (auto slot = row_start_[row]; slot < row_start_[row + 1]; ++slot, to += 9) {
    const auto column = static_cast<std::size_t>(column_[static_cast<std::size_t>(slot)]);
    const float factor = kWholeOne / (scale_[row] * scale_[column]);
    const double* block = matrix.block(source_slot_[static_cast<std::size_t>(slot)]);
    is_small = kernels().round_block(block, factor, scale_[column] / scale_[row], to, left.data()) && is_small;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) left_[9 * row + 3 * i + j] = 0.5F * (left[3 * i + j] + left[3 * j + i]);
  }
  return is_small;
}

void SinglePcg::update(const BlockMatrix& matrix, std::span<const Mat3> inverse_diagonal, const CoarseSpace& coarse,
                       bool has_new_coarse, std::span<const std::uint8_t> changed_rows, Workers& workers) {
  rescale(matrix, changed_rows, workers);
  for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::size_t>(start_[begin]); i < static_cast<std::size_t>(start_[end]); ++i) {
      if (is_stale_[i] == 0) continue;
      is_too_large_[i] = round_row(matrix, i) ? 0 : 1;
      const auto v = static_cast<std::size_t>(vertex_[i]);
      for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t k = 0; k < 3; ++k) {
          inverse_diagonal_[12 * i + 4 * column + k] =
              static_cast<float>(inverse_diagonal[v](static_cast<int>(k), static_cast<int>(column)));
        }
      }
      for (std::size_t k = 0; k < 3; ++k)
        is_free_[4 * i + k] = static_cast<float>(coarse.is_free(v)[static_cast<int>(k)]);
    }
  });
  if (!has_new_coarse) return;
  has_last_ = false;
  if (!is_coarse_dense_) {
    cycle_ = rounded(coarse.cycle());
    return;
  }
  const std::span<const double> inverse = coarse.inverse();
  coarse_.resize(inverse.size());
  workers.for_each(inverse.size(), 65536, [&](std::size_t i) { coarse_[i] = static_cast<float>(inverse[i]); });
}

PcgVectors SinglePcg::vectors() {
  return {x_.data(),   r_.data(),       z_.data(),        p_.data(),     q_.data(),   inverse_diagonal_.data(),
          arm_.data(), is_free_.data(), scaled_p_.data(), scale_.data(), left_.data()};
}

/// Sets r = b and x = q = 0; p = 0, or the last solution on the axes that are free now; and s p.
void SinglePcg::load(std::span<const Vec3> b, bool keeps_last, Workers& workers) {
  for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto first = static_cast<std::size_t>(start_[begin]);
    const auto last = static_cast<std::size_t>(start_[end]);
    for (std::size_t k = 4 * first; k < 4 * last; ++k) {
      p_[k] = keeps_last ? is_free_[k] * x_[k] : 0.0F;
      scaled_p_[k] = scale_[k / 4] * p_[k];
      x_[k] = q_[k] = 0.0F;
    }
    for (std::size_t i = first; i < last; ++i) {
      const Vec3& from = b[static_cast<std::size_t>(vertex_[i])];
      for (std::size_t k = 0; k < 3; ++k) r_[4 * i + k] = static_cast<float>(from[static_cast<int>(k)]);
    }
  });
}

/// Returns the factor by which p, the last solution, lowers the energy most: p · b / p · A p; 0 if p is useless.
double SinglePcg::share_of_last(Workers& workers) {
  const double pq = multiply(workers);
  for_aggregates(workers, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (auto k = 4 * static_cast<std::size_t>(start_[begin]); k < 4 * static_cast<std::size_t>(start_[end]); ++k)
      sum += static_cast<double>(p_[k]) * static_cast<double>(r_[k]);
    partial_rr_[chunk] = sum;
  });
  const double share = sum_of(partial_rr_) / pq;
  return pq > 0.0 && std::isfinite(share) ? share : 0.0;
}

/// x += alpha p, r -= alpha q, z = D⁻¹ r and Pᵀ r.
void SinglePcg::move(float alpha, Workers& workers) {
  const PcgVectors v = vectors();
  for_aggregates(workers, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    double rr = 0.0;
    double rz = 0.0;
    for (std::size_t a = begin; a < end; ++a) {
      kernels().move_four(v, alpha, static_cast<std::size_t>(start_[a]), static_cast<std::size_t>(start_[a + 1]),
                          restricted_.data() + 6 * a, &rr, &rz);
    }
    partial_rr_[chunk] = rr;
    partial_rz_[chunk] = rz;
  });
}

/// Computes the coarse part of M⁻¹ r; returns r · M⁻¹ r.
double SinglePcg::precondition(Workers& workers) {
  const std::size_t n = motion_.size();
  if (is_coarse_dense_) {
    workers.for_chunks(n, kCoarseRowsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      kernels().multiply_dense_rows(coarse_.data(), n, restricted_.data(), motion_.data(), begin, end);
    });
  } else {
    cycle_.apply(restricted_, motion_, workers);
  }
  double product = sum_of(partial_rz_);
  for (std::size_t i = 0; i < n; ++i) product += static_cast<double>(restricted_[i]) * static_cast<double>(motion_[i]);
  return product;
}

/// q = A p; returns p · q.
double SinglePcg::multiply(Workers& workers) {
  const BlockRows<std::int16_t> rows{row_start_.data(), column_.data(), values_.data()};
  const PcgVectors v = vectors();
  for_aggregates(workers, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    partial_pq_[chunk] = kernels().multiply_whole(rows, v, static_cast<std::size_t>(start_[begin]),
                                                  static_cast<std::size_t>(start_[end]));
  });
  return sum_of(partial_pq_);
}

/// p = z + P y + beta p.
void SinglePcg::turn(float beta, Workers& workers) {
  const PcgVectors v = vectors();
  for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      kernels().turn_four(v, beta, motion_.data() + 6 * a, static_cast<std::size_t>(start_[a]),
                          static_cast<std::size_t>(start_[a + 1]));
    }
  });
}

PcgReport SinglePcg::solve(std::span<const Vec3> b, std::span<Vec3> x, const PcgSettings& settings, Workers& workers) {
  if (std::ranges::any_of(is_too_large_, [](std::uint8_t flag) { return flag != 0; })) {
    std::fill(x.begin(), x.end(), Vec3::Zero());
    PcgReport report;
    report.is_indefinite = true;
    return report;
  }
  const bool keeps_last = settings.starts_from_last && has_last_;
  load(b, keeps_last, workers);
  const double start = keeps_last ? share_of_last(workers) : 0.0;
  struct Sweeps {
    SinglePcg& pcg;
    Workers& workers;
    double move(double alpha) {
      pcg.move(static_cast<float>(alpha), workers);
      return std::sqrt(sum_of(pcg.partial_rr_));
    }
    double precondition() { return pcg.precondition(workers); }
    void turn(double beta) { pcg.turn(static_cast<float>(beta), workers); }
    double multiply() { return pcg.multiply(workers); }
  } sweeps{*this, workers};
  const PcgReport report = iterate(sweeps, settings, start);
  has_last_ = report.converged;
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    const auto v = static_cast<std::size_t>(vertex_[i]);
    x[v] = Vec3(x_[4 * i], x_[4 * i + 1], x_[4 * i + 2]);
  }
  return report;
}

}  // namespace incise
