#include <incise/core/batch_monitor.hpp>

#include <numeric>

namespace incise {

BatchProgress::BatchProgress(std::size_t jobs, std::string stage, Monitor& outer)
    : fractions_(jobs), stage_(std::move(stage)), outer_(outer) {}

void BatchProgress::note(std::size_t job, double fraction) {
  fractions_[job] = fraction;
  if (std::this_thread::get_id() != caller_) return;
  const double done = std::accumulate(fractions_.begin(), fractions_.end(), 0.0);
  outer_.progress(stage_, done / static_cast<double>(fractions_.size()));
}

}  // namespace incise
