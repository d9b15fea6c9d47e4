#pragma once

// clang-format off
#include <utility>  // used by awaitable.hpp of Boost 1.74, which does not include it
// clang-format on

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <nlohmann/json.hpp>
#include <sys/types.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace incise::studio {

/// Outcome of a call: the last line of a worker, or the end of the worker.
struct CallOutcome {
  enum class Kind { Result, Problem, Stale, Stopped, Crashed };
  Kind kind = Kind::Crashed;
  nlohmann::ordered_json content;  ///< Result, Problem, Stale (the case has changed): an object; else a sentence
};

/// A running or waiting call, as the call `state` lists it.
struct RunningCall {
  std::string call;
  std::string stage;
  double fraction = 0.0;
  nlohmann::ordered_json left_s;
};

/// A worker as a child process. It is started when first needed, and again after it has ended.
class WorkerProcess {
 public:
  /// @param command  the program and its arguments. @param on_event  called for each line that ends no call, with its
  /// kind (progress, message, moment) and its content, to which the name of its call is added.
  WorkerProcess(boost::asio::io_context& io, std::vector<std::string> command,
                std::function<void(const std::string& kind, nlohmann::ordered_json content)> on_event);
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Makes a call after the earlier calls. Suspends until it has ended.
  boost::asio::awaitable<CallOutcome> call(std::string name, std::string case_file, nlohmann::ordered_json arguments);
  /// Asks the running call to stop.
  void stop();
  /// Returns the calls that have not ended, the running one first.
  [[nodiscard]] std::vector<RunningCall> running() const;

 private:
  struct Child;
  struct Waiting {
    RunningCall shown;
    boost::asio::steady_timer done;
    CallOutcome outcome;
  };
  void start();
  void take_line(const std::string& line);
  void end_all(const std::string& why);
  static boost::asio::awaitable<void> read_lines(WorkerProcess* self, std::shared_ptr<Child> child);
  static boost::asio::awaitable<void> write_lines(std::shared_ptr<Child> child);

  boost::asio::io_context& io_;
  std::vector<std::string> command_;
  std::function<void(const std::string&, nlohmann::ordered_json)> on_event_;
  std::shared_ptr<Child> child_;
  std::map<std::uint64_t, std::shared_ptr<Waiting>> waiting_;
  std::uint64_t next_id_ = 1;
};

}  // namespace incise::studio
