#pragma once

#include <string_view>

namespace incise {

enum class Severity { Detail, Notice, Warning };

/// Receives messages and progress of a long computation, and says whether it should stop. The default discards
/// everything and never stops. The library itself never prints.
/// A computation calls its monitor only from the thread that called the computation, except `is_cancelled`, which any
/// of its threads may call.
class Monitor {
 public:
  virtual ~Monitor() = default;
  virtual void message(Severity, std::string_view /*text*/) {}
  /// @param stage     short present-tense name: "cutting", "meshing".
  /// @param fraction  done so far, in [0, 1]; never decreases within a stage.
  virtual void progress(std::string_view /*stage*/, double /*fraction*/) {}
  [[nodiscard]] virtual bool is_cancelled() const { return false; }
};

/// Monitor of a computation inside another one: stops when the outer monitor asks to, and discards messages and
/// progress. The outer monitor must outlive this object.
class StopOnly : public Monitor {
 public:
  explicit StopOnly(const Monitor& outer) : outer_(outer) {}
  [[nodiscard]] bool is_cancelled() const override { return outer_.is_cancelled(); }

 private:
  const Monitor& outer_;
};

/// Throws Cancelled naming `stage` if the monitor asks to stop; for computations without a partial result.
void throw_if_cancelled(const Monitor& monitor, std::string_view stage);

}  // namespace incise
