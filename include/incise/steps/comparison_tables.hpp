#pragma once

#include <incise/io/table_io.hpp>
#include <incise/steps/cut_steps.hpp>

namespace incise::steps {

/// Returns a table with one row for each incision, as in the paper's Table II.
[[nodiscard]] TextTable result_table(const CutComparison& comparison);

/// Returns a table with one row for each test of a comparison. Pooled tests are labelled as such.
[[nodiscard]] TextTable test_table(const CutComparison& comparison);

}  // namespace incise::steps
