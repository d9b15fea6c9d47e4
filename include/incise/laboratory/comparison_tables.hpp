#pragma once

#include <incise/io/table_io.hpp>

#include <nlohmann/json.hpp>

namespace incise::laboratory {

/// One row for each incision, as in the paper's Table II.
[[nodiscard]] TextTable result_table(const nlohmann::ordered_json& comparison);

/// One row for each test of a comparison, the pooled ones labelled as such.
[[nodiscard]] TextTable test_table(const nlohmann::ordered_json& comparison);

}  // namespace incise::laboratory
