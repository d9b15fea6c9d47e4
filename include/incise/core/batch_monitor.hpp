#pragma once

#include <incise/core/monitor.hpp>

#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

namespace incise {

/// The progress of computations that go side by side, as one. Any thread may note; only the thread that made this
/// object tells the outer monitor, as a Monitor is promised. The outer monitor has to outlive it.
class BatchProgress {
 public:
  /// @param stage  the stage that the outer monitor is given: "cutting".
  BatchProgress(std::size_t jobs, std::string stage, Monitor& outer);

  /// @param fraction  of this job, in [0, 1], never less than before.
  void note(std::size_t job, double fraction);
  [[nodiscard]] bool is_cancelled() const { return outer_.is_cancelled(); }

 private:
  std::vector<std::atomic<double>> fractions_;
  std::string stage_;
  Monitor& outer_;
  std::thread::id caller_ = std::this_thread::get_id();
};

/// What one of them is given for a monitor: its progress counts, its messages it keeps to itself.
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
