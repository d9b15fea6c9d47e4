#pragma once

#include <incise/core/monitor.hpp>

#include <string>
#include <vector>

namespace incise::testing {

/// Keeps what it is told; stops on request.
class RecordingMonitor : public Monitor {
 public:
  void message(Severity severity, std::string_view text) override {
    severities.push_back(severity);
    messages.emplace_back(text);
  }
  void progress(std::string_view /*stage*/, double fraction) override { fractions.push_back(fraction); }
  [[nodiscard]] bool is_cancelled() const override { return stop; }

  std::vector<Severity> severities;
  std::vector<std::string> messages;
  std::vector<double> fractions;
  bool stop = false;
};

}  // namespace incise::testing
