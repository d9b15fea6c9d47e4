#include "calls.hpp"
#include "problem_json.hpp"

#include <incise/core/error.hpp>
#include <incise/core/time_left.hpp>
#include <incise/storage/case_edit.hpp>
#include <incise/studio/worker.hpp>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <iostream>

namespace incise::studio {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kProgressS = 0.1;  // between two lines of progress

volatile std::sig_atomic_t g_must_stop = 0;
void on_stop(int) {
  g_must_stop = 1;
}

/// The connection to the server: standard output as it was when the worker began.
class Answers {
 public:
  Answers() : out_(::dup(STDOUT_FILENO)) { ::dup2(STDERR_FILENO, STDOUT_FILENO); }
  ~Answers() { ::close(out_); }
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  void of_call(const Json& id) { id_ = id; }
  void send(const char* kind, Json content) {
    const std::string line =
        Json{{"id", id_}, {kind, std::move(content)}}.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    for (std::size_t done = 0; done < line.size();) {
      const ssize_t written = ::write(out_, line.data() + done, line.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) {  // the server has ended: a cut leaves its checkpoint
        g_must_stop = 1;
        return;
      }
      done += static_cast<std::size_t>(written);
    }
  }

 private:
  int out_;
  Json id_;
};

class WorkerMonitor : public Monitor {
 public:
  explicit WorkerMonitor(Answers& answers) : answers_(answers) {}

  void message(Severity severity, std::string_view text) override {
    if (severity == Severity::Detail) return;
    answers_.send("message", {{"severity", severity == Severity::Warning ? "warning" : "notice"}, {"text", text}});
  }
  void progress(std::string_view stage, double fraction) override {
    const auto now = std::chrono::steady_clock::now();
    const auto since = [now](auto then) { return std::chrono::duration<double>(now - then).count(); };
    if (stage != stage_) part_.clear();
    if (stage != stage_ || fraction < fraction_) {  // the next stage, or the next cut
      stage_ = stage;
      stage_start_ = now;
      time_left_ = TimeLeft{};
    } else if (since(last_sent_) < kProgressS) {
      return;
    }
    fraction_ = fraction;
    time_left_.note(since(stage_start_), fraction);
    last_sent_ = now;
    const std::optional<double> left = time_left_.seconds();
    answers_.send(
        "progress",
        {{"stage", stage}, {"part", part_}, {"fraction", fraction}, {"left_s", left ? Json(*left) : Json(nullptr)}});
  }
  [[nodiscard]] bool is_cancelled() const override { return g_must_stop != 0; }
  /// Sets the part of a call that consists of several similar ones. @param part  empty: the call as a whole.
  void set_part(const std::string& part) { part_ = part; }

 private:
  Answers& answers_;
  std::string part_;
  std::string stage_;
  double fraction_ = 0.0;
  std::chrono::steady_clock::time_point stage_start_, last_sent_;
  TimeLeft time_left_;
};

void answer(Calls& calls, Answers& answers, const std::string& line) {
  try {
    const Json asked = Json::parse(line);
    answers.of_call(asked.at("id"));
    answers.send("result", calls.make(asked.at("call"), asked.at("case").get<std::string>(), asked.at("with")));
  } catch (const Cancelled& stopped) {
    answers.send("stopped", stopped.what());
  } catch (const StaleRevision& error) {
    answers.send("stale", problem_json(error.problem(), error.what()));
  } catch (const CaseError& error) {
    answers.send("problem", problem_json(error.problem(), error.what()));
  } catch (const std::exception& error) {
    answers.send("problem", problem_json({}, error.what()));
  }
}

}  // namespace

int run_worker(const std::filesystem::path& blobs) {
  ::prctl(PR_SET_PDEATHSIG, SIGINT);
  struct sigaction stop {};
  stop.sa_handler = on_stop;
  stop.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &stop, nullptr);
  ::sigaction(SIGTERM, &stop, nullptr);
  sigset_t listened;
  ::sigemptyset(&listened);
  ::sigaddset(&listened, SIGINT);
  ::sigprocmask(SIG_UNBLOCK, &listened, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  Answers answers;
  WorkerMonitor monitor(answers);
  Calls calls(blobs, monitor,
              {[&](const std::string& part) { monitor.set_part(part); },
               [&](const Json& moment) { answers.send("moment", moment); }});
  for (std::string line; std::getline(std::cin, line);) {
    monitor.set_part("");
    answer(calls, answers, line);
    g_must_stop = 0;  // not earlier: a stop may arrive together with its call
  }
  return 0;
}

}  // namespace incise::studio
