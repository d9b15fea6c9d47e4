#pragma once

#include <incise/procedure/incision.hpp>

#include <span>
#include <string>
#include <vector>

namespace incise {

/// One of several incisions into the same stretched tissue.
struct IncisionJob {
  IncisionSettings settings;
  ToolPath path;
};

/// What came of a job.
struct IncisionJobResult {
  IncisionResult incision;  ///< NotConverged when there is a problem; Cancelled and empty when it was not begun
  std::string problem;      ///< why the job could not be carried out (settings or a path that cannot be used); empty: it was
};

/// Simulates incisions side by side over one model and one stretched state, each on one thread: as many at a time as `workers` has threads.
/// Each result has the bits that simulate_incision gives; one that cannot be carried out does not touch the others.
/// When the monitor asks to stop, incisions under way end as Cancelled where they are, those that have ended are whole.
/// Each incision under way holds a workspace of its own, and each result its final state and frames.
/// @returns one result per job, in their order.
[[nodiscard]] std::vector<IncisionJobResult> simulate_incisions(const TissueModel& model, const TissueState& stretched,
                                                                std::span<const IncisionJob> jobs, Workers& workers, Monitor& monitor);

}  // namespace incise
