#include "worker_process.hpp"

#include <incise/core/error.hpp>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <deque>

extern char** environ;

namespace incise::studio {
namespace asio = boost::asio;
namespace {

constexpr std::size_t kLongestLine = 256U << 20;
using Json = nlohmann::ordered_json;

struct Pipe {
  int read = -1;
  int write = -1;
};

Pipe new_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(fmt::format("no pipe to a worker: {}", system_reason(errno)));
  return {ends[0], ends[1]};
}

/// The end of a pipe that only the child keeps.
class End {
 public:
  explicit End(int file) : file_(file) {}
  ~End() { ::close(file_); }
  End(const End&) = delete;
  End& operator=(const End&) = delete;

 private:
  int file_;
};

pid_t spawn(const std::vector<std::string>& command, int in, int out) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
  ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);  // sockets: Asio 1.74 leaves them open
  posix_spawnattr_t attributes;  // a process group of its own: Ctrl-C at the terminal is for the server
  sigset_t until_it_listens;     // a stop that arrives before the worker has its handler is delivered later
  ::sigemptyset(&until_it_listens);
  ::sigaddset(&until_it_listens, SIGINT);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setsigmask(&attributes, &until_it_listens);
  pid_t pid = -1;
  const int failed = ::posix_spawn(&pid, arguments[0], &files, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  if (failed != 0) throw Error(fmt::format("no worker could be started: {}", system_reason(failed)));
  return pid;
}

std::string end_of(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) return fmt::format("signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  return fmt::format("status {}", WEXITSTATUS(status));
}

}  // namespace

/// The process and the lines on their way to it; shared by the coroutines that read and write.
struct WorkerProcess::Child {
  explicit Child(asio::io_context& io) : in(io), out(io), has_line(io) {}
  pid_t pid = -1;
  asio::posix::stream_descriptor in;   ///< its standard input
  asio::posix::stream_descriptor out;  ///< its standard output
  std::deque<std::string> lines;
  asio::steady_timer has_line;
  bool is_closed = false;
};

WorkerProcess::WorkerProcess(asio::io_context& io, std::vector<std::string> command,
                             std::function<void(const std::string&, Json)> on_event)
    : io_(io), command_(std::move(command)), on_event_(std::move(on_event)) {}

WorkerProcess::~WorkerProcess() {
  if (!child_) return;
  boost::system::error_code ignored;
  child_->in.close(ignored);  // an idle worker ends
  child_->out.close(ignored);
  ::kill(child_->pid, SIGINT);  // a busy worker leaves its checkpoint
  static_cast<void>(end_of(child_->pid));
}

void WorkerProcess::start() {
  const Pipe to = new_pipe();
  auto child = std::make_shared<Child>(io_);
  child->in.assign(to.write);
  const End reads(to.read);
  const Pipe from = new_pipe();
  child->out.assign(from.read);
  const End writes(from.write);
  child->pid = spawn(command_, to.read, from.write);
  child_ = child;
  asio::co_spawn(io_, read_lines(this, child), asio::detached);
  asio::co_spawn(io_, write_lines(child), asio::detached);
}

asio::awaitable<void> WorkerProcess::write_lines(std::shared_ptr<Child> child) {
  boost::system::error_code failed;
  while (!child->is_closed) {
    if (child->lines.empty()) {
      child->has_line.expires_at(asio::steady_timer::time_point::max());
      boost::system::error_code woken;
      co_await child->has_line.async_wait(asio::redirect_error(asio::use_awaitable, woken));
      continue;
    }
    const std::string line = std::move(child->lines.front());
    child->lines.pop_front();
    co_await asio::async_write(child->in, asio::buffer(line), asio::redirect_error(asio::use_awaitable, failed));
    if (failed) co_return;  // the reader notices the end
  }
}

asio::awaitable<void> WorkerProcess::read_lines(WorkerProcess* self, std::shared_ptr<Child> child) {
  std::string buffer;
  for (;;) {
    boost::system::error_code failed;
    const std::size_t size = co_await asio::async_read_until(child->out, asio::dynamic_buffer(buffer, kLongestLine),
                                                             '\n', asio::redirect_error(asio::use_awaitable, failed));
    if (failed == asio::error::operation_aborted) co_return;  // the server ends
    if (failed) break;
    self->take_line(buffer.substr(0, size));
    buffer.erase(0, size);
  }
  child->is_closed = true;
  child->has_line.cancel();
  ::kill(child->pid, SIGKILL);  // it has closed its end, or sends invalid lines
  const std::string end = end_of(child->pid);
  self->child_.reset();
  self->end_all(fmt::format(
      "The computation ended with {}. The case is unchanged; the next call starts a new computation.", end));
}

void WorkerProcess::take_line(const std::string& line) {
  Json said = Json::parse(line, nullptr, false);
  if (!said.is_object() || !said.contains("id") || !said.at("id").is_number_unsigned()) return;
  const auto found = waiting_.find(said.at("id").get<std::uint64_t>());
  if (found == waiting_.end()) return;
  Waiting& of = *found->second;
  using Kind = CallOutcome::Kind;
  for (const auto& [name, kind] : {std::pair{"result", Kind::Result}, std::pair{"problem", Kind::Problem},
                                   std::pair{"stale", Kind::Stale}, std::pair{"stopped", Kind::Stopped}}) {
    if (!said.contains(name)) continue;
    of.outcome = {kind, std::move(said.at(name))};
    of.done.cancel();
    waiting_.erase(found);
    return;
  }
  for (const char* name : {"progress", "message", "moment"}) {
    if (!said.contains(name)) continue;
    Json content = std::move(said.at(name));
    if (name == std::string_view("progress")) {
      of.shown.stage = content.value("stage", "");
      const Json fraction = content.value("fraction", Json(nullptr));
      of.shown.fraction = fraction.is_number() ? fraction.get<double>() : 0.0;
      of.shown.left_s = content.value("left_s", Json(nullptr));
    }
    content["call"] = of.shown.call;
    on_event_(name, std::move(content));
  }
}

void WorkerProcess::end_all(const std::string& why) {
  for (const auto& [id, of] : waiting_) {
    of->outcome = {CallOutcome::Kind::Crashed, why};
    of->done.cancel();
  }
  waiting_.clear();
}

asio::awaitable<CallOutcome> WorkerProcess::call(std::string name, std::string case_file, Json arguments) {
  const std::uint64_t id = next_id_++;
  const Json asked{{"id", id}, {"call", name}, {"case", case_file}, {"with", std::move(arguments)}};
  std::string line = asked.dump() + "\n";
  if (!child_) start();
  const auto of = std::make_shared<Waiting>(Waiting{{name, "", 0.0, nullptr}, asio::steady_timer(io_), {}});
  of->done.expires_at(asio::steady_timer::time_point::max());
  waiting_[id] = of;
  child_->lines.push_back(std::move(line));
  child_->has_line.cancel();
  boost::system::error_code woken;
  while (waiting_.contains(id)) co_await of->done.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  co_return of->outcome;
}

void WorkerProcess::stop() {
  if (child_ && !waiting_.empty()) ::kill(child_->pid, SIGINT);
}

std::vector<RunningCall> WorkerProcess::running() const {
  std::vector<RunningCall> list;
  for (const auto& [id, of] : waiting_) list.push_back(of->shown);
  return list;
}

}  // namespace incise::studio
