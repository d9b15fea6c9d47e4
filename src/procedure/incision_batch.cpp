#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/procedure/incision_batch.hpp>

#include <atomic>
#include <mutex>
#include <numeric>
#include <thread>

namespace incise {
namespace {

/// The progress of all jobs together. Any thread may note, only the caller's tells the monitor, as a Monitor is promised.
class BatchProgress {
 public:
  BatchProgress(std::size_t jobs, Monitor& monitor) : fractions_(jobs), monitor_(monitor) {}

  void note(std::size_t job, double fraction) {
    fractions_[job] = fraction;
    if (std::this_thread::get_id() != caller_) return;
    const double done = std::accumulate(fractions_.begin(), fractions_.end(), 0.0);
    monitor_.progress("cutting", done / static_cast<double>(fractions_.size()));
  }
  [[nodiscard]] bool is_cancelled() const { return monitor_.is_cancelled(); }

 private:
  std::vector<std::atomic<double>> fractions_;
  Monitor& monitor_;
  std::thread::id caller_ = std::this_thread::get_id();
};

/// What one job is given for a monitor.
class JobMonitor : public Monitor {
 public:
  JobMonitor(BatchProgress& batch, std::size_t job) : batch_(batch), job_(job) {}
  void progress(std::string_view, double fraction) override { batch_.note(job_, fraction); }
  [[nodiscard]] bool is_cancelled() const override { return batch_.is_cancelled(); }

 private:
  BatchProgress& batch_;
  std::size_t job_;
};

IncisionJobResult run_job(const TissueModel& model, const TissueState& stretched, const IncisionJob& job, Monitor& monitor) {
  IncisionJobResult result;
  if (monitor.is_cancelled()) {
    result.incision.outcome = Outcome::Cancelled;
    return result;
  }
  Workers alone(1);
  try {
    result.incision = simulate_incision(model, stretched, job.path, job.settings, alone, monitor);
  } catch (const InvalidArgument& problem) {
    result.problem = without_function_name(problem);
  }
  return result;
}

}  // namespace

void simulate_incisions(std::span<const IncisionTask> tasks, Workers& workers, Monitor& monitor, const IncisionTaken& take) {
  BatchProgress progress(tasks.size(), monitor);
  std::mutex taking;
  workers.for_each(tasks.size(), 1, [&](std::size_t i) {
    JobMonitor own(progress, i);
    IncisionJobResult result = run_job(*tasks[i].model, *tasks[i].stretched, tasks[i].job, own);
    {
      const std::lock_guard one_at_a_time(taking);
      take(i, std::move(result));
    }
    progress.note(i, 1.0);
  });
  if (!tasks.empty() && !monitor.is_cancelled()) monitor.progress("cutting", 1.0);
}

std::vector<IncisionJobResult> simulate_incisions(const TissueModel& model, const TissueState& stretched,
                                                  std::span<const IncisionJob> jobs, Workers& workers, Monitor& monitor) {
  std::vector<IncisionTask> tasks;
  for (const IncisionJob& job : jobs) tasks.push_back({&model, &stretched, job});
  std::vector<IncisionJobResult> results(jobs.size());
  simulate_incisions(tasks, workers, monitor, [&results](std::size_t i, IncisionJobResult result) { results[i] = std::move(result); });
  return results;
}

}  // namespace incise
