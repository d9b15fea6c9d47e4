#include "own_process.hpp"

#include <incise/core/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

extern char** environ;

namespace incise::cli {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(20);
constexpr mode_t kMode = 0644;

/// What the process has for its standard streams.
class Streams {
 public:
  explicit Streams(const OwnProcess& process) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, 1, process.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
    posix_spawn_file_actions_addopen(&actions_, 2, process.log.c_str(), O_WRONLY | O_CREAT | O_APPEND, kMode);
  }
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

pid_t start(const OwnProcess& process) {
  std::vector<std::string> words{"incise"};
  words.insert(words.end(), process.arguments.begin(), process.arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  const int problem = posix_spawn(&child, "/proc/self/exe", Streams(process).get(), nullptr, pointers.data(), environ);
  if (problem == 0) return child;
  throw DataError(process.output, "", fmt::format("that `{}` cannot be started: {}", shell_line(words), std::strerror(problem)),
                  "a process, and files that can be written");
}

int status_of_wait(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

int run_process(const OwnProcess& process, const Monitor& monitor) {
  throw_if_cancelled(monitor, "the study");
  const pid_t child = start(process);
  bool is_asked = false;
  for (int status = 0;; std::this_thread::sleep_for(kBetweenLooks)) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) {
      if (is_asked) throw_if_cancelled(monitor, "the study");
      return status_of_wait(status);
    }
    if (ended < 0 && errno != EINTR) throw DataError(process.output, "", std::strerror(errno), "a process that can be waited for");
    if (!is_asked && monitor.is_cancelled()) {
      kill(child, SIGINT);
      is_asked = true;
    }
  }
}

std::string shell_line(const std::vector<std::string>& arguments) {
  const auto is_plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("-_./,=:+", c) != nullptr; };
  std::string line;
  for (const std::string& word : arguments) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace incise::cli
