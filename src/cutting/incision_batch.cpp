#include <incise/core/batch_monitor.hpp>
#include <incise/core/error.hpp>
#include <incise/cutting/incision_batch.hpp>

#include <mutex>

namespace incise {
namespace {

IncisionJobResult run_job(const TissueModel& model, const TissueState& stretched, const IncisionJob& job,
                          Monitor& monitor) {
  IncisionJobResult result;
  if (monitor.is_cancelled()) {
    result.incision.outcome = Outcome::Cancelled;
    return result;
  }
  Workers alone(1);
  try {
    result.incision = simulate_incision(model, stretched, job.path, job.settings, alone, monitor);
  } catch (const InvalidArgument& problem) {
    result.problem = problem.text();
  }
  return result;
}

}  // namespace

void simulate_incisions(std::span<const IncisionTask> tasks, Workers& workers, Monitor& monitor,
                        const IncisionTaken& take) {
  BatchProgress progress(tasks.size(), "cutting", monitor);
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

}  // namespace incise
