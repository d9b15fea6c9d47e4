#include "page_files.hpp"
#include "problem_json.hpp"
#include "worker_process.hpp"

#include <incise/core/error.hpp>
#include <incise/core/sha256.hpp>
#include <incise/core/version.hpp>
#include <incise/io/text_encoding.hpp>
#include <incise/studio/access.hpp>
#include <incise/studio/file_ids.hpp>
#include <incise/studio/server.hpp>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <deque>
#include <list>
#include <optional>
#include <set>

namespace incise::studio {
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace fs = std::filesystem;
using Tcp = asio::ip::tcp;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::uint64_t kLargestBody = 4U << 20;
constexpr std::uint32_t kLargestHeader = 8U << 10;
constexpr int kMostConnections = 64;
constexpr std::chrono::seconds kSilence{30};    // after which a silent connection is closed
constexpr std::chrono::seconds kFirstSilence(5);  // the same before its first request
constexpr std::chrono::seconds kHeartbeat{15};  // of the stream of events
constexpr std::size_t kMostEvents = 1000;       // greatest number that waits for a reader; older ones are dropped

using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr std::string_view kTemporaryName = "incise-studio-";

/// Folders `incise-studio-PID-…` left by servers that were killed: their process no longer exists.
void remove_abandoned_folders(const fs::path& where) {
  std::error_code failed;
  for (fs::directory_iterator entry(where, failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(kTemporaryName)) continue;
    const int pid = std::atoi(name.c_str() + kTemporaryName.size());
    std::error_code ignored;
    if (pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH) fs::remove_all(entry->path(), ignored);
  }
}

/// The folder for the arrays of results: made for this process alone, and removed with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const fs::path where = fs::temp_directory_path();
    remove_abandoned_folders(where);
    std::string pattern = (where / fmt::format("{}{}-XXXXXX", kTemporaryName, ::getpid())).string();
    if (::mkdtemp(pattern.data()) == nullptr) throw DataError(pattern, "", "no new folder", "room for temporary files");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string_view media_type(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  return "text/javascript; charset=utf-8";
}

std::string bytes_from_hex(const std::string& digits) {
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return bytes;
}

/// The page's permissions: run its own modules and its one import map, and send requests to this server.
std::string content_policy() {
  const EmbeddedFile* page = find_embedded(page::files(), "index.html");
  INCISE_REQUIRE(page != nullptr, "expected the page");
  constexpr std::string_view begin = "<script type=\"importmap\">";
  const std::size_t at = page->content.find(begin) + begin.size();
  const std::string_view map = page->content.substr(at, page->content.find("</script>", at) - at);
  return fmt::format(
      "default-src 'none'; script-src 'self' 'sha256-{}'; style-src 'self'; img-src 'self' blob: data:; "
      "connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
      base64(bytes_from_hex(sha256_of_text(map))));
}

template <class Body>
void protect(http::response<Body>& response, const std::string& policy) {
  response.set(http::field::server, "incise");
  response.set("Content-Security-Policy", policy);
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set(http::field::cache_control, "no-store");
}

std::string_view text_of(boost::string_view text) {
  return {text.data(), text.size()};
}

bool is_blob_name(std::string_view name) {
  return name.size() == 32 && name.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// A browser window that listens to events.
struct Listener {
  explicit Listener(asio::io_context& io) : has_event(io) {}
  std::deque<std::string> events;
  asio::steady_timer has_event;
};

class Server {
 public:
  Server(asio::io_context& io, const ServerSettings& settings)
      : io_(io),
        token_(new_token()),
        files_(settings.roots, new_token()),
        policy_(content_policy()),
        desk_(io, worker_command(settings), [this](const auto& kind, auto content) { notify(kind, content); }),
        runner_(io, worker_command(settings), [this](const auto& kind, auto content) { notify(kind, content); }),
        acceptor_(io) {
    if (!settings.case_file.empty()) case_file_ = files_.path_of(files_.id_of(settings.case_file), "case").string();
    boost::system::error_code failed;
    const Tcp::endpoint here(asio::ip::address_v4::loopback(), settings.port);
    acceptor_.open(here.protocol());
    acceptor_.set_option(Tcp::acceptor::reuse_address(true));
    acceptor_.bind(here, failed);
    if (!failed) acceptor_.listen(asio::socket_base::max_listen_connections, failed);
    if (failed)
      throw CaseError("command line", "--port", fmt::format("{} ({})", settings.port, system_reason(failed)),
                      "a free port");
    asio::co_spawn(io_, accept(), asio::detached);
  }

  [[nodiscard]] std::string address() const {
    return fmt::format("http://127.0.0.1:{}/#token={}", acceptor_.local_endpoint().port(), token_);
  }

 private:
  [[nodiscard]] std::vector<std::string> worker_command(const ServerSettings& settings) const {
    std::vector<std::string> command = settings.worker;
    command.push_back(blobs_.path().string());
    return command;
  }

  asio::awaitable<void> accept() {
    for (;;) {
      boost::system::error_code failed;
      Tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(asio::use_awaitable, failed));
      if (failed == asio::error::operation_aborted) co_return;
      if (failed) {  // no file descriptors left, for example: there may be some later
        asio::steady_timer pause(io_, std::chrono::milliseconds(100));
        co_await pause.async_wait(asio::use_awaitable);
        continue;
      }
      if (connections_ >= kMostConnections) continue;  // closes it
      ++connections_;
      boost::system::error_code ignored;
      socket.set_option(Tcp::no_delay(true), ignored);  // a header is sent at once, not with the next part
      asio::co_spawn(io_, converse(beast::tcp_stream(std::move(socket))),
                     [this](std::exception_ptr) { --connections_; });
    }
  }

  /// Answers the requests of a connection, one after the other. Any failure ends the connection.
  asio::awaitable<void> converse(beast::tcp_stream stream) {
    beast::flat_buffer buffer;
    bool is_first = true;
    for (bool is_kept = true; is_kept;) {
      http::request_parser<http::string_body> parser;
      parser.body_limit(kLargestBody);
      parser.header_limit(kLargestHeader);
      stream.expires_after(is_first ? kFirstSilence : kSilence);
      is_first = false;
      boost::system::error_code failed;
      co_await http::async_read_header(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, failed));
      if (failed == http::error::end_of_stream || failed == beast::error::timeout) co_return;
      std::optional<Response> refused;
      if (failed) {
        refused = failed == http::error::body_limit ? too_large() : plain(400, "Malformed request.", false);
      } else if (const auto refusal = refusal_of(info_of(parser.get()), token_)) {  // before its body is read
        refused = plain(refusal->status, refusal->why, false);
      } else {
        co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, failed));
        if (failed == http::error::body_limit) refused = too_large();
      }
      if (refused) {
        co_await send(stream, std::move(*refused));
        co_await drain(stream);
      }
      if (failed || refused) co_return;
      stream.expires_never();  // a run may take an hour
      const Request request = parser.release();
      is_kept = request.keep_alive();
      co_await answer(stream, request);
    }
  }

  /// Reads and drops what is still arriving: a connection closed with unread bytes is reset, and its other end may lose
  /// the answer.
  asio::awaitable<void> drain(beast::tcp_stream& stream) {
    std::string dropped(65536, '\0');
    const asio::mutable_buffer room = asio::buffer(dropped);
    boost::system::error_code failed;
    stream.expires_after(kFirstSilence);
    while (!failed) co_await stream.async_read_some(room, asio::redirect_error(asio::use_awaitable, failed));
  }

  static RequestInfo info_of(const Request& request) {
    return {text_of(request.method_string()),
            text_of(request.target()),
            request.count(http::field::host) == 1 ? text_of(request[http::field::host]) : std::string_view(),
            text_of(request["X-Incise-Token"]),
            text_of(request[http::field::content_type]),
            text_of(request[http::field::origin]),
            text_of(request["Sec-Fetch-Site"])};
  }

  asio::awaitable<void> answer(beast::tcp_stream& stream, const Request& request) {
    const std::string_view target = text_of(request.target());
    const bool is_kept = request.keep_alive();
    // g++ 12 destroys some temporaries of an expression with co_await twice: each has a name here.
    if (target.starts_with("/api/call/") && request.method() == http::verb::post) {
      std::string name(target.substr(10));
      Response answered = co_await call(std::move(name), request.body(), is_kept);
      co_await send(stream, std::move(answered));
    } else if (target.starts_with("/api/blob/") && request.method() == http::verb::get) {
      std::string name(target.substr(10));
      co_await send_blob(stream, std::move(name), is_kept);
    } else if (target == "/api/events" && request.method() == http::verb::get) {
      co_await send_events(stream);
    } else {
      Response answered = page(target, is_kept);
      co_await send(stream, std::move(answered));
    }
  }

  template <class Body>
  asio::awaitable<void> send(beast::tcp_stream& stream, http::response<Body> response) {
    protect(response, policy_);
    http::serializer<false, Body> serializer(response);
    boost::system::error_code failed;
    while (!failed && !serializer.is_done()) {
      stream.expires_after(kSilence);  // if the reader is silent
      co_await http::async_write_some(stream, serializer, asio::redirect_error(asio::use_awaitable, failed));
    }
    if (failed || !response.keep_alive()) {
      boost::system::error_code ignored;
      stream.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    }
  }

  static Response made(unsigned status, std::string_view type, std::string content, bool is_kept) {
    Response response(static_cast<http::status>(status), 11);
    response.set(http::field::content_type, boost::string_view(type.data(), type.size()));
    response.keep_alive(is_kept);
    response.body() = std::move(content);
    response.prepare_payload();
    return response;
  }
  static Response json(unsigned status, const Json& content, bool is_kept) {
    return made(status, "application/json", json_line(content), is_kept);
  }
  static Response too_large() {
    return plain(413, fmt::format("A request is at most {} MB.", kLargestBody >> 20), false);
  }
  static Response plain(unsigned status, const std::string& message, bool is_kept) {
    return json(status, {{"message", message}}, is_kept);
  }

  static Response page(std::string_view target, bool is_kept) {
    const std::string_view path = target.substr(0, target.find('?'));
    const std::string_view name = path == "/" ? "index.html" : path.starts_with("/page/") ? path.substr(6) : "";
    const EmbeddedFile* file = find_embedded(page::files(), name);
    if (file == nullptr) return plain(404, "There is no such page.", is_kept);
    return made(200, media_type(name), std::string(file->content), is_kept);
  }

  asio::awaitable<void> send_blob(beast::tcp_stream& stream, std::string name, bool is_kept) {
    http::response<http::file_body> response;
    boost::system::error_code failed;
    if (is_blob_name(name)) {
      http::file_body::value_type file;
      file.open((blobs_.path() / name).c_str(), beast::file_mode::scan, failed);
      if (!failed) response.body() = std::move(file);
    }
    if (!response.body().is_open()) {
      Response missing = plain(404, "There is no such array, or a newer one has replaced it.", is_kept);
      co_await send(stream, std::move(missing));
      co_return;
    }
    response.result(http::status::ok);
    response.version(11);
    response.set(http::field::content_type, "application/octet-stream");
    response.keep_alive(is_kept);
    response.prepare_payload();
    co_await send(stream, std::move(response));
  }

  asio::awaitable<void> send_events(beast::tcp_stream& stream) {
    http::response<http::empty_body> response(http::status::ok, 11);
    response.set(http::field::content_type, "text/event-stream");
    response.keep_alive(false);
    protect(response, policy_);
    http::response_serializer<http::empty_body> serializer(response);
    boost::system::error_code failed;
    co_await http::async_write_header(stream, serializer, asio::redirect_error(asio::use_awaitable, failed));
    const auto listener = listeners_.emplace(listeners_.end(), io_);
    const Json now = co_await state();
    listener->events.push_back(event_text("state", now));
    while (!failed) {
      std::string text;
      while (!listener->events.empty()) {
        text += listener->events.front();
        listener->events.pop_front();
      }
      if (text.empty()) text = ": here\n\n";
      stream.expires_after(kSilence);
      co_await asio::async_write(stream, asio::buffer(text), asio::redirect_error(asio::use_awaitable, failed));
      if (failed || !listener->events.empty()) continue;
      listener->has_event.expires_after(kHeartbeat);
      boost::system::error_code woken;
      co_await listener->has_event.async_wait(asio::redirect_error(asio::use_awaitable, woken));
    }
    listeners_.erase(listener);
  }

  static std::string event_text(const std::string& kind, const Json& content) {
    return fmt::format("event: {}\ndata: {}\n\n", kind, json_line(content));
  }

  void notify(const std::string& kind, const Json& content) {
    for (Listener& listener : listeners_) {
      listener.events.push_back(event_text(kind, content));
      if (listener.events.size() > kMostEvents) listener.events.pop_front();
      listener.has_event.cancel();
    }
  }

  [[nodiscard]] Json running_json() const {
    Json list = Json::array();
    for (const WorkerProcess* worker : {&desk_, &runner_}) {
      for (const RunningCall& one : worker->running())
        list.push_back({{"call", one.call}, {"stage", one.stage}, {"fraction", one.fraction}, {"left_s", one.left_s}});
    }
    return list;
  }

  asio::awaitable<Json> state() {
    Json json{{"version", fmt::format("{} ({})", version(), source_commit())}, {"case", nullptr}};
    if (!case_file_.empty() && shown_case_.is_null()) {
      std::string name = "case";
      Json nothing = Json::object();
      CallOutcome shown = co_await outcome_of(std::move(name), std::move(nothing));
      if (shown.kind == CallOutcome::Kind::Result)
        shown_case_ = std::move(shown.content);
      else if (shown.content.is_object())
        json["case_problem"] = std::move(shown.content);
      else
        json["case_problem"]["message"] = std::move(shown.content);
    }
    json["case"] = shown_case_;  // as last read: computing it now may take long
    json["running"] = running_json();
    co_return json;
  }

  [[nodiscard]] std::string path_of(const Json& id, const std::string& field) const {
    if (!id.is_string()) throw CaseError("request", field, "no text", "the id of a file");
    return files_.path_of(id.get<std::string>(), field).string();
  }

  /// Returns the case file of a call `open`: within the roots, wherever links lead.
  [[nodiscard]] std::string case_file_at(const Json& arguments) {
    const fs::path named = arguments.value("file", std::string());
    if (named.empty()) throw CaseError("request", "file", "nothing", "the id of a file");
    const fs::path file = fs::is_directory(named) ? named / "case.yaml" : named;
    return files_.path_of(files_.id_of(file), "file").string();
  }

  /// Replaces the ids of files in a call by their paths.
  void translate_files(Json& arguments) const {
    for (const char* name :
         {"file", "folder", "scan", "labels", "mesh", "surface", "camera", "color", "depth", "intrinsics"}) {
      if (arguments.contains(name) && !arguments.at(name).is_null())
        arguments[name] = path_of(arguments.at(name), name);
    }
    if (!arguments.contains("files")) return;
    if (!arguments.at("files").is_object()) throw CaseError("request", "files", "no object", "keys and ids of files");
    for (auto& [key, id] : arguments.at("files").items()) id = path_of(id, key);
  }

  /// Returns the arguments of a call; null: not JSON, or nested so deep that it would exhaust the stack.
  static Json parsed(const std::string& body) {
    constexpr int kDeepest = 32;
    bool is_too_deep = false;
    const auto look = [&](int depth, Json::parse_event_t, Json&) {
      is_too_deep = is_too_deep || depth > kDeepest;
      return !is_too_deep;
    };
    Json json = Json::parse(body.empty() ? "{}" : body, look, false);
    return is_too_deep ? Json() : json;
  }

  asio::awaitable<Response> call(std::string name, std::string body, bool is_kept) {
    Json arguments = parsed(body);
    if (!arguments.is_object()) co_return plain(400, "The arguments of a call must be a JSON object.", is_kept);
    Json problem;
    try {
      if (name == "files") {
        if (arguments.contains("folder")) static_cast<void>(path_of(arguments.at("folder"), "folder"));
        co_return json(200, files_.list(arguments.value("folder", std::string())), is_kept);
      }
      if (name == "stop") co_return json(200, stop(arguments), is_kept);
      translate_files(arguments);
      if (name == "open") arguments["file"] = case_file_at(arguments);
    } catch (const CaseError& error) {
      problem = problem_json(error.problem(), error.what());
    } catch (const std::exception& error) {
      problem = problem_json({}, error.what());
    }
    if (!problem.is_null()) co_return json(422, {{"problem", problem}}, is_kept);
    if (name == "state") {
      const Json now = co_await state();
      co_return json(200, now, is_kept);
    }
    co_return co_await call_worker(name, std::move(arguments), is_kept);
  }

  Json stop(const Json& arguments) {
    const bool is_run =
        arguments.contains("call") && arguments.at("call").is_string() && is_of_a_run(arguments.at("call"));
    (is_run ? runner_ : desk_).stop();
    return Json::object();
  }

  /// Whether a call of the desk writes into the case's output folder, which only one process may do at a time.
  static bool makes_output(const std::string& name) {
    static const std::set<std::string> names{"body", "stretch", "plan", "virtual_cloud", "register"};
    return names.contains(name);
  }
  /// Whether a call belongs to the other worker: such calls compute what a run does, or use its results.
  static bool is_of_a_run(const std::string& name) { return name == "run" || name == "lay"; }

  static CallOutcome refused_during_a_run() {
    return {CallOutcome::Kind::Problem, problem_json({}, "A run is under way. Wait for its end, or stop it.")};
  }

  /// Makes a call; a failure on the way to a worker is an outcome, too.
  asio::awaitable<CallOutcome> outcome_of(std::string name, Json arguments) {
    const bool is_run = is_of_a_run(name), is_counted = makes_output(name);
    if ((is_counted || is_run) && !runner_.running().empty()) co_return refused_during_a_run();
    asio::steady_timer pause(io_);
    while (is_run && desk_makes_output_ > 0) {
      pause.expires_after(std::chrono::milliseconds(50));
      co_await pause.async_wait(asio::use_awaitable);
    }
    WorkerProcess& worker = is_run ? runner_ : desk_;
    CallOutcome outcome;
    std::string file = case_file_;
    if (is_counted) ++desk_makes_output_;
    try {
      outcome = co_await worker.call(std::move(name), std::move(file), std::move(arguments));
    } catch (const std::exception& error) {
      outcome.content = std::string("The call could not be made: ") + error.what();
    }
    if (is_counted) --desk_makes_output_;
    co_return outcome;
  }

  asio::awaitable<Response> call_worker(std::string name, Json arguments, bool is_kept) {
    const bool is_run = is_of_a_run(name);
    const bool opens = name == "open" || name == "create" || name == "demo";
    if (is_run) asio::co_spawn(io_, notify_of_state(), asio::detached);
    CallOutcome outcome = co_await outcome_of(std::move(name), std::move(arguments));
    if (is_run) asio::co_spawn(io_, notify_of_state(), asio::detached);
    switch (outcome.kind) {
      case CallOutcome::Kind::Problem:
        co_return json(422, {{"problem", std::move(outcome.content)}}, is_kept);
      case CallOutcome::Kind::Stale:
        co_return json(409, {{"problem", std::move(outcome.content)}}, is_kept);
      case CallOutcome::Kind::Stopped:
        co_return plain(499, outcome.content.get<std::string>(), is_kept);
      case CallOutcome::Kind::Crashed:
        co_return plain(500, outcome.content.get<std::string>(), is_kept);
      case CallOutcome::Kind::Result:
        break;
    }
    if (outcome.content.contains("cloud"))
      outcome.content["file"] = files_.id_of(outcome.content.at("cloud").get<std::string>());
    if (opens) case_file_ = outcome.content.at("file").get<std::string>();
    if (outcome.content.contains("revision") && outcome.content.at("file") == case_file_) {
      shown_case_ = outcome.content;
      asio::co_spawn(io_, notify_of_state(), asio::detached);
    }
    co_return json(200, outcome.content, is_kept);
  }

  asio::awaitable<void> notify_of_state() {
    const Json now = co_await state();
    notify("state", now);
  }

  asio::io_context& io_;
  const std::string token_;
  TemporaryFolder blobs_;
  FileIds files_;
  const std::string policy_;
  std::string case_file_;
  Json shown_case_;            ///< as last read; null: not yet
  int desk_makes_output_ = 0;  ///< calls of the desk that write into the output folder
  std::list<Listener> listeners_;
  WorkerProcess desk_, runner_;
  Tcp::acceptor acceptor_;
  int connections_ = 0;
};

}  // namespace

void serve(const ServerSettings& settings, const std::function<void(const std::string& address)>& on_ready) {
  asio::io_context io(1);
  Server server(io, settings);
  asio::signal_set ends(io, SIGINT, SIGTERM, SIGHUP);
  ends.async_wait([&io](const boost::system::error_code&, int) { io.stop(); });
  on_ready(server.address());
  io.run();
}

}  // namespace incise::studio
