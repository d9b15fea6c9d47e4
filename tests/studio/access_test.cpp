#include <incise/studio/access.hpp>

#include <gtest/gtest.h>

#include <set>

namespace incise::studio {
namespace {

constexpr std::string_view kToken = "0123456789abcdef0123456789abcdef";

/// A call as the studio's own page makes it.
RequestInfo own_call() {
  return {"POST",       "/api/call/state", "127.0.0.1:8123", kToken, "application/json", "http://127.0.0.1:8123",
          "same-origin"};
}

unsigned status_of(const RequestInfo& request) {
  const auto refusal = refusal_of(request, kToken);
  if (!refusal) return 200;
  EXPECT_FALSE(refusal->why.empty());
  EXPECT_EQ(refusal->why.find(kToken), std::string::npos) << "a refusal gives the token away";
  return refusal->status;
}

TEST(Access, AnswersTheStudiosOwnPage) {
  EXPECT_EQ(status_of(own_call()), 200U);
  RequestInfo through_tunnel = own_call();
  through_tunnel.host = "localhost:9000";
  through_tunnel.origin = "http://localhost:9000";
  EXPECT_EQ(status_of(through_tunnel), 200U);
  EXPECT_EQ(status_of({"GET", "/", "localhost", "", "", "", "none"}), 200U);
}

TEST(Access, RefusesAnotherHost) {
  for (const char* host : {"", "evil.example", "127.0.0.1.evil.example", "localhost.evil.example:80", "127.0.0.1:80:80",
                           "127.0.0.1:", "127.0.0.1:1x", "[::1]:80", "127.0.0.2", "LOCALHOST.", "user@127.0.0.1"}) {
    RequestInfo request = own_call();
    request.host = host;
    request.origin = "";
    EXPECT_EQ(status_of(request), 403U) << host;
    EXPECT_EQ(status_of({"GET", "/", host, "", "", "", ""}), 403U) << host;
  }
}

TEST(Access, RefusesACallWithoutTheToken) {
  for (const char* token : {"", "0", "0123456789abcdef0123456789abcdee", "0123456789abcdef0123456789abcdef0"}) {
    RequestInfo request = own_call();
    request.token = token;
    EXPECT_EQ(status_of(request), 401U) << token;
  }
  EXPECT_EQ(status_of({"GET", "/api/events", "localhost", "", "", "", ""}), 401U);
  EXPECT_EQ(status_of({"GET", "/api/blob/0", "localhost", "", "", "", ""}), 401U);
}

TEST(Access, RefusesAForeignPageEvenWithTheToken) {
  for (const char* origin :
       {"http://evil.example", "null", "https://127.0.0.1:8123", "http://127.0.0.1:8124", "http://localhost:8123"}) {
    RequestInfo request = own_call();
    request.origin = origin;
    EXPECT_EQ(status_of(request), 403U) << origin;
  }
  for (const char* site : {"cross-site", "same-site"}) {
    RequestInfo request = own_call();
    request.fetch_site = site;
    EXPECT_EQ(status_of(request), 403U) << site;
  }
}

TEST(Access, TakesOnlyJson) {
  for (const char* type :
       {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data", "application/jsonp"}) {
    RequestInfo request = own_call();
    request.content_type = type;
    EXPECT_EQ(status_of(request), 415U) << type;
  }
  RequestInfo with_charset = own_call();
  with_charset.content_type = "application/json; charset=utf-8";
  EXPECT_EQ(status_of(with_charset), 200U);
}

TEST(Access, KnowsTwoMethods) {
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "HEAD", "TRACE", "CONNECT", "get", ""}) {
    RequestInfo request = own_call();
    request.method = method;
    EXPECT_EQ(status_of(request), 405U) << method;
  }
  EXPECT_EQ(status_of({"POST", "/", "localhost", kToken, "application/json", "", ""}), 405U);
}

TEST(Access, NoTokenIsGivenTwice) {
  std::set<std::string> tokens;
  for (int k = 0; k < 100; ++k) {
    tokens.insert(new_token());
    EXPECT_EQ(tokens.rbegin()->size(), 32U);
  }
  EXPECT_EQ(tokens.size(), 100U);
}

}  // namespace
}  // namespace incise::studio
