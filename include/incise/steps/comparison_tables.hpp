#pragma once

#include <incise/io/table_io.hpp>
#include <incise/steps/cut_steps.hpp>

namespace incise::steps {

/// One row for each incision, as in the paper's Table II.
[[nodiscard]] TextTable result_table(const CutComparison& comparison);

/// One row for each test of a comparison, the pooled ones labelled as such.
[[nodiscard]] TextTable test_table(const CutComparison& comparison);

}  // namespace incise::steps
