#include "mechanics/blas.hpp"
#include "mechanics/factor_status.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/solvers.hpp>

#include <cholmod.h>
#include <fmt/format.h>

#include <algorithm>

namespace incise {

bool is_positive_definite(int cholmod_status) {
  INCISE_REQUIRE(cholmod_status != CHOLMOD_OUT_OF_MEMORY, "not enough memory for the factor");
  INCISE_REQUIRE(cholmod_status >= CHOLMOD_OK,  // above: warnings of a pivot that is negative or too small
                 fmt::format("CHOLMOD could not factor the matrix (status {})", cholmod_status));
  return cholmod_status == CHOLMOD_OK;
}

struct SparseCholesky::Data {
  std::shared_ptr<const BlockPattern> pattern;
  cholmod_common common{};
  cholmod_sparse* lower = nullptr;  ///< 3N x 3N, lower triangle by columns
  cholmod_factor* factor = nullptr;
  std::vector<std::int64_t> source;  ///< per nonzero of `lower`: its index in BlockMatrix::values
  bool is_factored = false;
  mutable cholmod_dense* solution = nullptr;  // work space of solve, kept between calls
  mutable cholmod_dense* work_y = nullptr;
  mutable cholmod_dense* work_e = nullptr;

  ~Data() {
    cholmod_l_free_dense(&solution, &common);
    cholmod_l_free_dense(&work_y, &common);
    cholmod_l_free_dense(&work_e, &common);
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_free_sparse(&lower, &common);
    cholmod_l_finish(&common);
  }

  /// Column (v, a) of the lower triangle is row (v, a) of the symmetric matrix from the diagonal on.
  void list_nonzeros() {
    const std::size_t n = 3 * pattern->rows();
    std::vector<SuiteSparse_long> starts{0};
    std::vector<SuiteSparse_long> rows;
    for (std::size_t v = 0; v < pattern->rows(); ++v) {
      for (std::size_t a = 0; a < 3; ++a) {
        for (auto slot = pattern->diagonal[v]; slot < pattern->row_start[v + 1]; ++slot) {
          const auto w = static_cast<std::size_t>(pattern->column[static_cast<std::size_t>(slot)]);
          for (std::size_t b = w == v ? a : 0; b < 3; ++b) {
            rows.push_back(static_cast<SuiteSparse_long>(3 * w + b));
            source.push_back(9 * static_cast<std::int64_t>(slot) + static_cast<std::int64_t>(3 * a + b));
          }
        }
        starts.push_back(static_cast<SuiteSparse_long>(rows.size()));
      }
    }
    lower = cholmod_l_allocate_sparse(n, n, rows.size(), 1, 1, -1, CHOLMOD_REAL, &common);
    INCISE_REQUIRE(lower != nullptr, "not enough memory for the matrix");
    std::copy(starts.begin(), starts.end(), static_cast<SuiteSparse_long*>(lower->p));
    std::copy(rows.begin(), rows.end(), static_cast<SuiteSparse_long*>(lower->i));
    std::fill_n(static_cast<double*>(lower->x), rows.size(), 0.0);
  }
};

SparseCholesky::SparseCholesky(std::shared_ptr<const BlockPattern> pattern) : data_(std::make_unique<Data>()) {
  INCISE_REQUIRE(pattern != nullptr && pattern->rows() > 0, "expected a pattern with at least one row");
  hold_blas_to_one_thread();
  Data& d = *data_;
  d.pattern = std::move(pattern);
  cholmod_l_start(&d.common);
  d.common.print = 0;
  d.common.supernodal = CHOLMOD_SUPERNODAL;
  d.common.nmethods = 1;
  d.common.method[0].ordering = CHOLMOD_METIS;  // a third fewer nonzeros than AMD on these meshes
  d.list_nonzeros();
  d.factor = cholmod_l_analyze(d.lower, &d.common);
  INCISE_REQUIRE(d.factor != nullptr, fmt::format("CHOLMOD could not analyse the matrix (status {})", d.common.status));
}
SparseCholesky::~SparseCholesky() = default;

bool SparseCholesky::factor(const BlockMatrix& matrix) {
  Data& d = *data_;
  INCISE_REQUIRE(matrix.pattern == d.pattern, "expected a matrix of the pattern that was analysed");
  hold_blas_to_one_thread();
  auto* values = static_cast<double*>(d.lower->x);
  for (std::size_t i = 0; i < d.source.size(); ++i) values[i] = matrix.values[static_cast<std::size_t>(d.source[i])];
  d.is_factored = false;  // whatever happens, the last factor is gone
  cholmod_l_factorize(d.lower, d.factor, &d.common);
  d.is_factored = is_positive_definite(d.common.status);
  return d.is_factored;
}

void SparseCholesky::solve(std::span<const Vec3> b, std::span<Vec3> x) const {
  Data& d = *data_;
  INCISE_REQUIRE(d.is_factored, "expected a successful factor() before solve()");
  const std::size_t count = d.pattern->rows();
  INCISE_REQUIRE(b.size() == count && x.size() == count,
                 fmt::format("expected vectors of {} vertices, found {} and {}", count, b.size(), x.size()));
  hold_blas_to_one_thread();
  cholmod_dense* right = cholmod_l_allocate_dense(3 * count, 1, 3 * count, CHOLMOD_REAL, &d.common);
  INCISE_REQUIRE(right != nullptr, "not enough memory for a vector");
  for (std::size_t v = 0; v < count; ++v) std::copy_n(b[v].data(), 3, static_cast<double*>(right->x) + 3 * v);
  const int done =
      cholmod_l_solve2(CHOLMOD_A, d.factor, right, nullptr, &d.solution, nullptr, &d.work_y, &d.work_e, &d.common);
  cholmod_l_free_dense(&right, &d.common);
  INCISE_REQUIRE(done == 1, fmt::format("CHOLMOD could not solve (status {})", d.common.status));
  const auto* result = static_cast<const double*>(d.solution->x);
  for (std::size_t v = 0; v < count; ++v) x[v] = Eigen::Map<const Vec3>(result + 3 * v);
}

}  // namespace incise
