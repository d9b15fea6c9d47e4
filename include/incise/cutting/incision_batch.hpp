#pragma once

#include <incise/cutting/incision.hpp>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace incise {

/// One of several incisions into the same stretched tissue.
struct IncisionJob {
  IncisionSettings settings;
  ToolPath path;
};

/// One of several incisions, each into its own stretched tissue.
struct IncisionTask {
  const TissueModel* model = nullptr;      ///< outlives the call
  const TissueState* stretched = nullptr;  ///< likewise
  IncisionJob job;
};

/// What came of a job.
struct IncisionJobResult {
  IncisionResult incision;  ///< NotConverged when there is a problem; Cancelled and empty when it was not begun
  std::string
      problem;  ///< why the job could not be carried out (settings or a path that cannot be used); empty: it was
};

/// Simulates incisions side by side over one model and one stretched state, each on one thread: as many at a time as
/// `workers` has threads. Each result has the bits that simulate_incision gives; one that cannot be carried out does
/// not touch the others. When the monitor asks to stop, incisions under way end as Cancelled where they are, those that
/// have ended are whole. Each incision under way holds a workspace of its own, and each result its final state and
/// frames.
/// @returns one result per job, in their order.
[[nodiscard]] std::vector<IncisionJobResult> simulate_incisions(const TissueModel& model, const TissueState& stretched,
                                                                std::span<const IncisionJob> jobs, Workers& workers,
                                                                Monitor& monitor);

/// Is given what came of a task as soon as that has ended, cancelled ones too: by any thread, one call at a time. What
/// it throws ends the whole, as an exception of Workers.
using IncisionTaken = std::function<void(std::size_t task, IncisionJobResult result)>;

/// The same over several tissues, without keeping the results: each is handed to `take` when it ends.
void simulate_incisions(std::span<const IncisionTask> tasks, Workers& workers, Monitor& monitor,
                        const IncisionTaken& take);

}  // namespace incise
