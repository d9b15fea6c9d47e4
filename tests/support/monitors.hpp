#pragma once

#include <incise/core/monitor.hpp>

#include <atomic>
#include <string>
#include <vector>

namespace incise::testing {

/// Records every message and progress report; stops on request.
class RecordingMonitor : public Monitor {
 public:
  void message(Severity severity, std::string_view text) override {
    severities.push_back(severity);
    messages.emplace_back(text);
    if (severity == Severity::Warning) warnings.emplace_back(text);
  }
  void progress(std::string_view stage, double fraction) override {
    stages.emplace_back(stage);
    fractions.push_back(fraction);
  }
  [[nodiscard]] bool is_cancelled() const override { return stop; }

  std::vector<Severity> severities;
  std::vector<std::string> messages, warnings, stages;
  std::vector<double> fractions;
  bool stop = false;
};

/// Requests a stop after so many progress reports; by default at once.
class StopAfter : public Monitor {
 public:
  explicit StopAfter(int steps = 0) : left_(steps) {}
  void progress(std::string_view, double) override { --left_; }
  [[nodiscard]] bool is_cancelled() const override { return left_ <= 0; }

 private:
  std::atomic<int> left_;
};

}  // namespace incise::testing
