#include "console.hpp"

#include "standard_streams.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>

#include <unistd.h>

namespace incise::cli {
namespace {

// A signal handler may access only a flag of this type.
volatile std::sig_atomic_t g_is_interrupted = 0;

void on_interrupt(int) {
  if (g_is_interrupted != 0) _exit(130);
  g_is_interrupted = 1;
}

std::string time_text(double seconds) {
  return seconds < 60.0 ? fmt::format("{:.0f} s", seconds)
                        : fmt::format("{} min {:02} s", static_cast<int>(seconds) / 60, static_cast<int>(seconds) % 60);
}

}  // namespace

Console::Console(Level level) : level_(level), is_terminal_(::isatty(STDERR_FILENO) == 1) {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit is then a failed write, and reported as one
#endif
}

Console::~Console() { clear_bar(); }

void Console::clear_bar() {
  if (has_bar_) say("\r\033[K");
  has_bar_ = false;
}

void Console::message(Severity severity, std::string_view text) {
  if (level_ == Level::Quiet && severity != Severity::Warning) return;
  if (level_ != Level::Verbose && severity == Severity::Detail) return;
  clear_bar();
  say(fmt::format("{}{}\n", severity == Severity::Warning ? "warning: " : "", text));
}

void Console::progress(std::string_view stage, double fraction) {
  if (level_ == Level::Quiet) return;
  const auto now = std::chrono::steady_clock::now();
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
    last_shown_ = now;
    time_left_ = TimeLeft{};
  }
  time_left_.note(std::chrono::duration<double>(now - stage_start_).count(), fraction);
  const double since_shown = std::chrono::duration<double>(now - last_shown_).count();
  if (since_shown < (is_terminal_ ? 0.1 : 5.0)) return;
  last_shown_ = now;
  constexpr double kShownAsWhole = 0.995;  // "100 %" has no time left
  const std::string left = time_left_.seconds() && fraction < kShownAsWhole ? ", " + time_text(*time_left_.seconds()) + " left" : "";
  if (is_terminal_) {
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(fraction * kWidth);
    say(fmt::format("\r\033[K{:<12} [{:#<{}}{:.<{}}] {:3.0f} %{}", stage, "", filled, "", kWidth - filled, 100.0 * fraction, left));
    std::fflush(stderr);
    has_bar_ = true;
  } else {
    say(fmt::format("{}: {:.0f} %{}\n", stage, 100.0 * fraction, left));
  }
}

bool Console::is_cancelled() const { return g_is_interrupted != 0; }

}  // namespace incise::cli
