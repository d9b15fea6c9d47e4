#include "mechanics/single_pcg.hpp"

#include "mechanics/kernels/kernels.hpp"
#include "mechanics/large_pages.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

constexpr std::size_t kAggregatesPerChunk = 4;
constexpr std::size_t kCoarseRowsPerChunk = 192;
constexpr std::size_t kLoadBeyondEnd = 4;

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

SinglePcg::SinglePcg(std::shared_ptr<const BlockPattern> pattern, const CoarseSpace& coarse)
    : pattern_(std::move(pattern)), vertex_(coarse.aggregates().vertices), start_(coarse.aggregates().start) {
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
  values_ = zeros_in_large_pages<float>(9 * column_.size() + kLoadBeyondEnd);
  inverse_diagonal_.assign(12 * count, 0.0F);
  for (std::vector<float>* vector : {&arm_, &is_free_, &x_, &r_, &z_, &p_, &q_}) vector->assign(4 * count, 0.0F);
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

void SinglePcg::update(const BlockMatrix& matrix, std::span<const Mat3> inverse_diagonal, const CoarseSpace& coarse,
                       bool has_new_coarse, Workers& workers) {
  for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto first = static_cast<std::size_t>(start_[begin]);
    const auto last = static_cast<std::size_t>(start_[end]);
    float* to = values_.data() + 9 * static_cast<std::size_t>(row_start_[first]);
    for (auto slot = row_start_[first]; slot < row_start_[last]; ++slot, to += 9) {
      const double* from = matrix.block(source_slot_[static_cast<std::size_t>(slot)]);
      for (int k = 0; k < 9; ++k) to[k] = static_cast<float>(from[k]);
    }
    for (std::size_t i = first; i < last; ++i) {
      const auto v = static_cast<std::size_t>(vertex_[i]);
      for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t k = 0; k < 3; ++k) {
          inverse_diagonal_[12 * i + 4 * column + k] =
              static_cast<float>(inverse_diagonal[v](static_cast<int>(k), static_cast<int>(column)));
        }
      }
      for (std::size_t k = 0; k < 3; ++k) is_free_[4 * i + k] = static_cast<float>(coarse.is_free(v)[static_cast<int>(k)]);
    }
  });
  if (!has_new_coarse) return;
  const std::span<const double> inverse = coarse.inverse();
  coarse_.resize(inverse.size());
  workers.for_each(inverse.size(), 65536, [&](std::size_t i) { coarse_[i] = static_cast<float>(inverse[i]); });
}

/// r = b, x = p = q = 0.
void SinglePcg::load(std::span<const Vec3> b, Workers& workers) {
  for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto first = static_cast<std::size_t>(start_[begin]);
    const auto last = static_cast<std::size_t>(start_[end]);
    for (std::vector<float>* vector : {&x_, &p_, &q_}) std::fill(vector->data() + 4 * first, vector->data() + 4 * last, 0.0F);
    for (std::size_t i = first; i < last; ++i) {
      const Vec3& from = b[static_cast<std::size_t>(vertex_[i])];
      for (std::size_t k = 0; k < 3; ++k) r_[4 * i + k] = static_cast<float>(from[static_cast<int>(k)]);
    }
  });
}

/// x += alpha p, r -= alpha q, z = D⁻¹ r and Pᵀ r.
void SinglePcg::move(float alpha, Workers& workers) {
  const PcgVectors vectors{x_.data(), r_.data(), z_.data(), p_.data(), q_.data(), inverse_diagonal_.data(), arm_.data(), is_free_.data()};
  for_aggregates(workers, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    double rr = 0.0;
    double rz = 0.0;
    for (std::size_t a = begin; a < end; ++a) {
      kernels().move_four(vectors, alpha, static_cast<std::size_t>(start_[a]), static_cast<std::size_t>(start_[a + 1]),
                          restricted_.data() + 6 * a, &rr, &rz);
    }
    partial_rr_[chunk] = rr;
    partial_rz_[chunk] = rz;
  });
}

/// The coarse part of M r; returns r · M r.
double SinglePcg::precondition(Workers& workers) {
  const std::size_t n = motion_.size();
  workers.for_chunks(n, kCoarseRowsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    kernels().multiply_dense_rows(coarse_.data(), n, restricted_.data(), motion_.data(), begin, end);
  });
  double product = sum_of(partial_rz_);
  for (std::size_t i = 0; i < n; ++i) product += static_cast<double>(restricted_[i]) * static_cast<double>(motion_[i]);
  return product;
}

/// q = A p; returns p · q.
double SinglePcg::multiply(Workers& workers) {
  const BlockRows<float> rows{row_start_.data(), column_.data(), values_.data()};
  for_aggregates(workers, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    partial_pq_[chunk] = kernels().multiply_four(rows, p_.data(), q_.data(), static_cast<std::size_t>(start_[begin]),
                                                 static_cast<std::size_t>(start_[end]));
  });
  return sum_of(partial_pq_);
}

/// p = z + P y + beta p.
void SinglePcg::turn(float beta, Workers& workers) {
  const PcgVectors vectors{x_.data(), r_.data(), z_.data(), p_.data(), q_.data(), inverse_diagonal_.data(), arm_.data(), is_free_.data()};
  for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      kernels().turn_four(vectors, beta, motion_.data() + 6 * a, static_cast<std::size_t>(start_[a]),
                          static_cast<std::size_t>(start_[a + 1]));
    }
  });
}

PcgReport SinglePcg::solve(std::span<const Vec3> b, std::span<Vec3> x, const PcgSettings& settings, Workers& workers) {
  load(b, workers);
  move(0.0F, workers);
  PcgReport report;
  report.residual_mn = std::sqrt(sum_of(partial_rr_));
  const double reference = settings.reference_mn > 0.0 ? settings.reference_mn : report.residual_mn;
  const double target = settings.relative_tolerance * std::max(reference, settings.floor_mn);
  double rz_before = 0.0;
  while (!(report.residual_mn <= target) && report.iterations < settings.max_iterations) {
    const double rz = precondition(workers);
    turn(report.iterations == 0 ? 0.0F : static_cast<float>(rz / rz_before), workers);
    const double pq = multiply(workers);
    if (!(pq > 0.0) || !std::isfinite(rz)) {  // x is the last good iterate
      report.is_indefinite = true;
      break;
    }
    move(static_cast<float>(rz / pq), workers);
    rz_before = rz;
    ++report.iterations;
    report.residual_mn = std::sqrt(sum_of(partial_rr_));
  }
  report.converged = report.residual_mn <= target;
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    const auto v = static_cast<std::size_t>(vertex_[i]);
    x[v] = Vec3(x_[4 * i], x_[4 * i + 1], x_[4 * i + 2]);
  }
  return report;
}

}  // namespace incise
