#pragma once

#include <incise/core/monitor.hpp>

#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

namespace incise {

/// Combined progress of jobs that run side by side: the mean of their fractions. Any thread may call `note`, but only
/// calls from the thread that created this object reach the outer monitor, as Monitor requires. The outer monitor must
/// outlive this object.
class BatchProgress {
 public:
  /// @param jobs   number of jobs.
  /// @param stage  name that is reported to the outer monitor, such as "cutting".
  BatchProgress(std::size_t jobs, std::string stage, Monitor& outer);

  /// Records the progress of one job.
  /// @param fraction  done so far of this job, in [0, 1], never less than before.
  void note(std::size_t job, double fraction);
  [[nodiscard]] bool is_cancelled() const { return outer_.is_cancelled(); }

 private:
  std::vector<std::atomic<double>> fractions_;
  std::string stage_;
  Monitor& outer_;
  std::thread::id caller_ = std::this_thread::get_id();
};

/// Monitor of one job: passes its progress to the batch and discards its messages.
class JobMonitor : public Monitor {
 public:
  JobMonitor(BatchProgress& batch, std::size_t job) : batch_(batch), job_(job) {}
  void progress(std::string_view, double fraction) override { batch_.note(job_, fraction); }
  [[nodiscard]] bool is_cancelled() const override { return batch_.is_cancelled(); }

 private:
  BatchProgress& batch_;
  std::size_t job_;
};

}  // namespace incise
