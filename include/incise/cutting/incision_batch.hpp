#pragma once

#include <incise/cutting/incision.hpp>

#include <functional>
#include <span>
#include <string>

namespace incise {

/// An incision of a batch.
struct IncisionJob {
  IncisionSettings settings;
  ToolPath path;
};

/// A job with its stretched tissue, which several tasks may share.
struct IncisionTask {
  const TissueModel* model = nullptr;      ///< outlives the call
  const TissueState* stretched = nullptr;  ///< outlives the call
  IncisionJob job;
};

/// Result of a job.
struct IncisionJobResult {
  IncisionResult incision;  ///< NotConverged if there is a problem; Cancelled and empty if the job did not begin
  std::string
      problem;  ///< why the job could not run (InvalidArgument of simulate_incision); empty: it ran
};

/// Receives the result of each task when the task ends, cancelled ones included. Called from any thread, one call at a
/// time. An exception from it ends the batch, and Workers rethrows it.
using IncisionTaken = std::function<void(std::size_t task, IncisionJobResult result)>;

/// Simulates several incisions side by side, each on one thread, at most as many at a time as `workers` has threads.
/// Each result is bit for bit that of simulate_incision. A job that cannot run does not affect the others. When the
/// monitor cancels, running incisions end as Cancelled, and finished results remain complete. Each running incision
/// holds its own workspace. Keeps no results: passes each to `take` when its incision ends.
void simulate_incisions(std::span<const IncisionTask> tasks, Workers& workers, Monitor& monitor,
                        const IncisionTaken& take);

}  // namespace incise
