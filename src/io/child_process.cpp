#include "io/child_process.hpp"

#include <incise/core/error.hpp>
#include <incise/core/image_library_turn.hpp>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>

namespace incise::io_detail {
namespace {

/// A DataError whose message was composed in the other process.
class RelayedError : public DataError {
 public:
  RelayedError(const std::filesystem::path& file, std::string text) : DataError(file, "", "", ""), text_(std::move(text)) {}
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kBoundsAddressSpace = false;  // a sanitizer reserves terabytes of it
#else
constexpr bool kBoundsAddressSpace = true;
#endif

enum : char { kResult = 'R', kDataError = 'D', kOtherError = 'E' };

/// Returns the address space that this process holds now, bytes; 0 if unknown.
std::uint64_t held_address_space() {
  std::ifstream stream("/proc/self/statm");
  std::uint64_t pages = 0;
  stream >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void limit(int resource, std::uint64_t amount) {
  rlimit bound{};
  if (::getrlimit(static_cast<__rlimit_resource_t>(resource), &bound) != 0) return;
  bound.rlim_cur = std::min<rlim_t>(amount, bound.rlim_max);
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &bound);
}

bool write_all(int to, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(to, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

/// Runs in the copy: writes one byte for how the work ended, then the result or the message.
[[noreturn]] void be_the_child(int to, const ChildLimits& limits, const std::function<std::string()>& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // dies with the waiting process, whose locks it would otherwise keep
  std::signal(SIGINT, SIG_IGN);  // the waiting process handles Ctrl-C
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.processor_s);
  if (kBoundsAddressSpace) limit(RLIMIT_AS, held_address_space() + limits.memory_bytes);
  char kind = kResult;
  std::string answer;
  try {
    answer = work();
  } catch (const DataError& error) {
    kind = kDataError;
    answer = error.what();
  } catch (const std::exception& error) {
    kind = kOtherError;
    answer = error.what();
  } catch (...) {
    kind = kOtherError;
  }
  const bool is_told = write_all(to, &kind, 1) && write_all(to, answer.data(), answer.size());
  ::_exit(is_told ? 0 : 1);
}

std::string read_all(int from) {
  std::string text;
  std::string block(1 << 18, '\0');
  while (true) {
    const ssize_t count = ::read(from, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(block.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

std::string in_child_process(const std::filesystem::path& file, const std::string& what, const ChildLimits& limits,
                             const std::function<std::string()>& work) {
  const ImageLibraryTurn turn;
  int ends[2];
  if (::pipe(ends) != 0) throw DataError(file, "", system_reason(errno), "a process to read it in");
  const pid_t child = ::fork();
  if (child < 0) {
    const int problem = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    throw DataError(file, "", system_reason(problem), "a process to read it in");
  }
  if (child == 0) {
    ::close(ends[0]);
    be_the_child(ends[1], limits, work);
  }
  ::close(ends[1]);
  std::string answer = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const std::string expected = fmt::format("a complete {} file", what);
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const std::string found =
        signal == SIGXCPU || signal == SIGKILL
            ? fmt::format("content on which the image library did not finish within {} s", limits.processor_s)
            : fmt::format("content on which the image library crashed (signal {})", signal);
    throw DataError(file, "content", found, expected, "Is the file damaged?");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty()) {
    throw DataError(file, "content", "content on which the image library finished without a result", expected,
                    "Is the file damaged?");
  }
  const char kind = answer.front();
  answer.erase(0, 1);
  if (kind == kDataError) throw RelayedError(file, answer);
  if (kind == kOtherError) {
    throw DataError(file, "content", answer.empty() ? "an unknown problem" : fmt::format("\"{}\"", answer.substr(0, 160)), expected, "Is the file damaged?");
  }
  return answer;
}

}  // namespace incise::io_detail
