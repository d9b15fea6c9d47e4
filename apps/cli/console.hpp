#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/time_left.hpp>

#include <chrono>
#include <string>

namespace incise::cli {

/// Shows messages and progress on standard error: on a terminal a bar with the time left, otherwise a plain line every
/// few seconds.
/// Ctrl-C asks the computation to stop; a second Ctrl-C ends the program at once.
class Console : public Monitor {
 public:
  enum class Level { Quiet, Normal, Verbose };
  explicit Console(Level level);
  ~Console() override;

  void message(Severity severity, std::string_view text) override;
  void progress(std::string_view stage, double fraction) override;
  [[nodiscard]] bool is_cancelled() const override;

 private:
  void clear_bar();
  Level level_;
  bool is_terminal_;
  bool has_bar_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point stage_start_;
  TimeLeft time_left_;  ///< of the stage
  std::chrono::steady_clock::time_point last_shown_;
};

}  // namespace incise::cli
