// Replays the corpus of every reader, then cases mutated from it: the same ones for the same seed, with any compiler. A finding ends the
// program, names reader and case, and leaves the input beside where it was started.
//
//   incise_file_fuzz [--reader NAME] [--cases N] [--seed S] [--corpus FOLDER] [--words FOLDER]

#include "mutations.hpp"
#include "reader.hpp"

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>

namespace {

namespace fs = std::filesystem;
using incise::fuzz::Reader;

// One reading takes milliseconds of processor time and a few megabytes; these say that something is wrong.
constexpr time_t kMostSecondsOfACase = 10;
constexpr rlim_t kMostMemory = rlim_t{1} << 30;  // beside what the program holds when it starts

struct Request {
  std::string reader;
  std::size_t cases = 200;
  std::uint64_t seed = 1;
  fs::path corpus = INCISE_FUZZ_FOLDER "/corpus";
  fs::path words = INCISE_FUZZ_FOLDER "/words";
};

// What is being read, for whoever ends the program.
struct Now {
  char reader[64] = "";
  std::size_t number = 0;
  const std::string* bytes = nullptr;
} now;
const pid_t own_process = ::getpid();

[[noreturn]] void finding(const char* what) {
  std::fprintf(stderr, "finding: %s: case %zu: %s\n", now.reader, now.number, what);
  char name[128];
  std::snprintf(name, sizeof name, "finding_%s_%zu", now.reader, now.number);
  if (std::FILE* file = std::fopen(name, "wb"); file != nullptr && now.bytes != nullptr) {
    std::fwrite(now.bytes->data(), 1, now.bytes->size(), file);
    std::fclose(file);
    std::fprintf(stderr, "its input: %s\n", name);
  }
  ::_exit(1);
}

// A process that the reader started for what may break down breaks down by itself: that is no finding.
void on_signal(int number) {
  if (::getpid() != own_process) {
    std::signal(number, SIG_DFL);
    std::raise(number);
    return;
  }
  finding(number == SIGPROF ? "more than 10 s of processor time" : ::strsignal(number));
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> corpus_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> corpus;
  for (const fs::path& file : files) corpus.push_back(bytes_of(file));
  return corpus;
}

void read(const Reader& reader, const std::string& bytes, std::size_t number) {
  now.number = number;
  now.bytes = &bytes;
  const itimerval span{{0, 0}, {kMostSecondsOfACase, 0}};
  ::setitimer(ITIMER_PROF, &span, nullptr);
  try {
    incise::fuzz::read_bytes(reader, bytes);
  } catch (const std::exception& error) {
    finding(error.what());
  } catch (...) {
    finding("something that is no exception of the library's");
  }
}

std::size_t fuzz(const Reader& reader, const Request& request) {
  std::snprintf(now.reader, sizeof now.reader, "%s", reader.name.c_str());
  const std::vector<std::string> corpus = corpus_of(request.corpus / reader.name);
  if (corpus.empty()) finding("no corpus");
  std::size_t number = 0;
  for (const std::string& bytes : corpus) read(reader, bytes, number++);
  incise::fuzz::Mutations mutations(request.seed, corpus, incise::fuzz::words_in(request.words / (reader.words + ".dict")));
  const auto cases = static_cast<std::size_t>(reader.share * static_cast<double>(request.cases));
  for (std::size_t i = 0; i < cases; ++i) read(reader, mutations.next(), number++);
  return number;
}

Request request_of(int count, char** words) {
  Request request;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string key = words[i];
    if (key == "--reader") request.reader = words[i + 1];
    else if (key == "--cases") request.cases = std::strtoull(words[i + 1], nullptr, 10);
    else if (key == "--seed") request.seed = std::strtoull(words[i + 1], nullptr, 10);
    else if (key == "--corpus") request.corpus = words[i + 1];
    else if (key == "--words") request.words = words[i + 1];
    else {
      std::fprintf(stderr, "%s: expected --reader, --cases, --seed, --corpus or --words\n", words[i]);
      std::exit(2);
    }
  }
  return request;
}

void limit_memory() {
#if !defined(__SANITIZE_ADDRESS__)
  std::ifstream stream("/proc/self/statm");
  rlim_t pages = 0;
  stream >> pages;
  rlimit bound{};
  ::getrlimit(RLIMIT_AS, &bound);
  bound.rlim_cur = std::min(bound.rlim_max, pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + kMostMemory);
  ::setrlimit(RLIMIT_AS, &bound);
#endif
}

}  // namespace

int main(int count, char** words) {
  const Request request = request_of(count, words);
  limit_memory();
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF}) std::signal(number, on_signal);
  std::size_t readings = 0;
  for (const Reader& reader : incise::fuzz::readers()) {
    if (!request.reader.empty() && reader.name != request.reader) continue;
    const std::size_t read = fuzz(reader, request);
    std::printf("%-18s %zu readings\n", reader.name.c_str(), read);
    std::fflush(stdout);
    readings += read;
  }
  std::printf("%zu readings, no finding\n", readings);
  return readings == 0 ? 2 : 0;
}
