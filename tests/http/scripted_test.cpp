// What no real server can be brought to do.
#include "tests/support/scripted_server.h"

#include "tests/http/http_test.h"

namespace voyager::scripted_test {
namespace {

using namespace test;

const std::string& file() {
  static const std::string text = random_text(200'000);
  return text;
}

ScriptedReply sound(const ScriptedRequest& request, const std::string& headers = "") {
  return {part_of(file(), request, headers)};
}

// A server that opens soundly, then answers `second`, then soundly again.
ScriptedServer::Script once(const std::function<ScriptedReply(const ScriptedRequest&)>& second) {
  return [second](const ScriptedRequest& request) {
    return request.number == 1 ? second(request) : sound(request);
  };
}

// The same, but `later` is all that comes after the opening.
ScriptedServer::Script always(const std::function<ScriptedReply(const ScriptedRequest&)>& later) {
  return [later](const ScriptedRequest& request) {
    return request.number == 0 ? sound(request) : later(request);
  };
}

void expect_bridged(const ScriptedServer& server, const http::Options& options = quick()) {
  const http::Source source(server.url(), options);
  EXPECT_TRUE(read(source, 80'000, 50'000) == file().substr(80'000, 50'000));
}

void expect_refused(const ScriptedServer& server, ErrorCode code, const std::string& words) {
  const http::Source source(server.url(), quick());
  expect_error(code, words, [&] { read(source, 80'000, 50'000); });
}

TEST(Scripted, BusyServersAreAskedAgain) {
  for (const int status : {408, 425, 429, 500, 502, 503, 504}) {
    ScriptedServer server(once(
        [&](const ScriptedRequest&) { return ScriptedReply{http_reply(status, "", "busy")}; }));
    expect_bridged(server);
    EXPECT_EQ(server.requests(), 3) << status;
  }
}

TEST(Scripted, AServerThatStaysBusyIsTransientAndNamed) {
  ScriptedServer server(
      always([](const ScriptedRequest&) { return ScriptedReply{http_reply(503, "", "busy")}; }));
  expect_refused(server, ErrorCode::io_transient, "found status 503");
  EXPECT_EQ(server.requests(), 1 + 4);
}

TEST(Scripted, RetryAfterIsHonoured) {
  ScriptedServer server(once([](const ScriptedRequest&) {
    return ScriptedReply{http_reply(503, "Retry-After: 1\r\n", "busy")};
  }));
  const Timer timer;
  expect_bridged(server);
  EXPECT_GE(timer.elapsed(), 990ms);
}

TEST(Scripted, ARetryAfterBeyondTheDeadlineIsNotWaitedFor) {
  ScriptedServer server(always([](const ScriptedRequest&) {
    return ScriptedReply{http_reply(429, "Retry-After: 3600\r\n", "busy")};
  }));
  const Timer timer;
  expect_refused(server, ErrorCode::io_transient, "found status 429");
  EXPECT_LT(timer.elapsed(), 1s);
}

TEST(Scripted, WhatWillNotPassIsNotAskedForAgain) {
  const std::pair<int, ErrorCode> cases[] = {{400, ErrorCode::refused_input},
                                             {401, ErrorCode::io},
                                             {403, ErrorCode::io},
                                             {404, ErrorCode::file_not_found},
                                             {410, ErrorCode::file_not_found},
                                             {416, ErrorCode::refused_input},
                                             {204, ErrorCode::refused_input},
                                             {304, ErrorCode::refused_input},
                                             {501, ErrorCode::refused_input}};
  for (const auto& [status, code] : cases) {
    ScriptedServer server(always([number = status](const ScriptedRequest&) {
      return ScriptedReply{http_reply(number, "", number == 204 || number == 304 ? "" : "no")};
    }));
    expect_refused(server, code, "status " + std::to_string(status));
    EXPECT_EQ(server.requests(), 2) << status;
  }
}

TEST(Scripted, ABodyThatEndsEarlyIsGoneOnWithWhereItEnded) {
  uint64_t resumed = 0;
  ScriptedServer server([&](const ScriptedRequest& request) {
    if (request.number == 2) resumed = request.first;
    ScriptedReply reply = sound(request);
    if (request.number != 1) return reply;
    return ScriptedReply{reply.bytes.substr(0, reply.bytes.size() - 20'000), true};
  });
  expect_bridged(server);
  EXPECT_EQ(resumed, 110'000u);
}

TEST(Scripted, AServerThatAlwaysHangsUpIsTransient) {
  ScriptedServer server(always([](const ScriptedRequest&) { return ScriptedReply{"", true}; }));
  expect_refused(server, ErrorCode::io_transient, "tries");
}

TEST(Scripted, StallsAreBridged) {
  for (const size_t bytes : {size_t{0}, size_t{20}, size_t{10'000}}) {
    ScriptedServer server(once([&](const ScriptedRequest& request) {
      return ScriptedReply{sound(request).bytes.substr(0, bytes), false, true};
    }));
    const Timer timer;
    expect_bridged(server, impatient());
    EXPECT_LT(timer.elapsed(), 3s) << bytes;
  }
}

TEST(Scripted, TheDeadlineEndsAReadThatNeverStalls) {
  http::Options options = quick();
  options.deadline = 500ms;
  options.tries = 1000;
  options.first_wait = 1ms;
  ScriptedServer server(
      always([](const ScriptedRequest&) { return ScriptedReply{http_reply(503, "", "")}; }));
  const http::Source source(server.url(), options);
  const Timer timer;
  expect_error(ErrorCode::io_transient, "status 503", [&] { read(source, 80'000, 100); });
  EXPECT_LT(timer.elapsed(), 1500ms);
}

TEST(Scripted, RangesThatAreIgnoredAreNamed) {
  const auto whole = [](const ScriptedRequest&) {
    return ScriptedReply{http_reply(200, "", file())};
  };
  ScriptedServer server(whole);
  expect_error(ErrorCode::refused_input, "the server ignores Range requests",
               [&] { http::Source(server.url(), quick()); });
  ScriptedServer later(always(whole));
  expect_refused(later, ErrorCode::refused_input, "the server ignores Range requests");
}

TEST(Scripted, AServerWithoutRangesServesASmallFile) {
  const std::string small = random_text(5'000);
  ScriptedServer server(
      [&](const ScriptedRequest&) { return ScriptedReply{http_reply(200, "", small)}; });
  const http::Source source(server.url(), quick());
  EXPECT_EQ(source.size(), small.size());
  EXPECT_EQ(read(source, 10, 4'000), small.substr(10, 4'000));
}

TEST(Scripted, WrongContentRangesAreRefused) {
  for (const char* range :
       {"bytes 80001-130000/200000", "bytes 80000-129998/200000", "bytes 80000-130000/200000",
        "bytes 0-49999/200000", "bytes 80000-129999/*", "bytes */200000", "bytes 9-2/200000",
        "80000", "bytes 80000-129999/99999999999999999999999", "bytes=80000-129999/200000",
        "pages 80000-129999/200000", "", "\x01\xff\x02"}) {
    ScriptedServer server(always([&](const ScriptedRequest&) {
      return ScriptedReply{http_reply(206, "Content-Range: " + std::string(range) + "\r\n",
                                      file().substr(80'000, 50'000))};
    }));
    expect_refused(server, ErrorCode::refused_input, "bytes 80000-129999: found");
    EXPECT_EQ(server.requests(), 2) << range;
  }
}

TEST(Scripted, AnotherLengthThanTheRangesIsRefused) {
  for (const int difference : {-1, 1}) {
    ScriptedServer server(always([&](const ScriptedRequest&) {
      return ScriptedReply{http_reply(206, "Content-Range: bytes 80000-129999/200000\r\n",
                                      random_text(static_cast<size_t>(50'000 + difference)))};
    }));
    expect_refused(server, ErrorCode::refused_input, "expected 50000");
  }
}

TEST(Scripted, MoreBytesThanAnnouncedAreRefused) {
  ScriptedServer server(always([](const ScriptedRequest&) {
    return ScriptedReply{
        "HTTP/1.1 206 Scripted\r\nContent-Range: bytes 80000-129999/200000\r\n"
        "Transfer-Encoding: chunked\r\n\r\n10000\r\n" +
        std::string(65'536, 'x') + "\r\n0\r\n\r\n"};
  }));
  expect_refused(server, ErrorCode::refused_input, "more bytes than were announced");
}

TEST(Scripted, FewerBytesThanAnnouncedAreTransient) {
  ScriptedServer server(always([](const ScriptedRequest& request) {
    return ScriptedReply{"HTTP/1.1 206 Scripted\r\nContent-Range: bytes " +
                         std::to_string(request.first) +
                         "-129999/200000\r\nTransfer-Encoding: chunked\r\n\r\n"
                         "5\r\nabcde\r\n0\r\n\r\n"};
  }));
  expect_refused(server, ErrorCode::io_transient, "after 5 bytes");
}

TEST(Scripted, GarbageIsRefused) {
  for (const std::string& garbage :
       {std::string("garbage\r\n\r\n"), std::string("\0\0\0\0\0\0\0\0\r\n\r\n", 12),
        random_text(1'000), std::string("HTTP/1.1 \r\n\r\n"),
        std::string("HTTP/1.1 9999 no\r\n\r\n"),
        std::string("HTTP/1.1 206\r\nContent-Length: -5\r\n\r\n"),
        std::string("HTTP/7.3 206 no\r\n\r\n")}) {
    ScriptedServer server(always([&](const ScriptedRequest&) {
      return ScriptedReply{garbage, true};
    }));
    const http::Source source(server.url(), quick());
    const Timer timer;
    expect_error(ErrorCode::refused_input, "bytes 80000-129999: found",
                 [&] { read(source, 80'000, 50'000); });
    EXPECT_LT(timer.elapsed(), 2s) << garbage.substr(0, 20);
  }
}

// libcurl itself reads freed memory at the second such line.
TEST(Scripted, FoldedHeaderLinesAreRefused) {
  ScriptedServer server(always([](const ScriptedRequest&) {
    return ScriptedReply{
        "HTTP/1.1 206 yes\r\nContent-Range: bytes\r\n  80000-\r\n\t129999/\r\n"
        " 200000\r\nContent-Length: 50000\r\n\r\n",
        true};
  }));
  const http::Source source(server.url(), quick());
  expect_error(ErrorCode::refused_input, "begins with a space",
               [&] { read(source, 80'000, 50'000); });
}

TEST(Scripted, HeadersWithoutEndMeetTheDeadline) {
  ScriptedServer server(always([](const ScriptedRequest&) {
    std::string head = "HTTP/1.1 206 Scripted\r\n";
    for (int i = 0; i < 20'000; ++i)
      head += "X-" + std::to_string(i) + ": filler filler filler\r\n";
    return ScriptedReply{head, false, true};
  }));
  const http::Source source(server.url(), impatient());
  const Timer timer;
  EXPECT_THROW(read(source, 80'000, 50'000), Error);
  EXPECT_LT(timer.elapsed(), 4s);
}

TEST(Scripted, CompressedAnswersAreRefused) {
  ScriptedServer server(always(
      [](const ScriptedRequest& request) { return sound(request, "Content-Encoding: gzip\r\n"); }));
  expect_refused(server, ErrorCode::refused_input, "the Content-Encoding gzip");
}

TEST(Scripted, TwoVersionsNeverMix) {
  // Cut off amid a read, and gone on with in another version: no byte of it may pass.
  ScriptedServer server([](const ScriptedRequest& request) {
    const std::string tag = request.number < 2 ? "ETag: \"one\"\r\n" : "ETag: \"two\"\r\n";
    ScriptedReply reply = sound(request, tag);
    if (request.number == 1) return ScriptedReply{reply.bytes.substr(0, 30'000), true};
    return reply;
  });
  expect_refused(server, ErrorCode::io,
                 "found ETag \"two\", expected \"one\": the file was replaced while open");
}

TEST(Scripted, AVersionThatIsNoLongerNamedIsRefused) {
  ScriptedServer server([](const ScriptedRequest& request) {
    return sound(request, request.number == 0 ? "ETag: \"one\"\r\n" : "");
  });
  expect_refused(server, ErrorCode::io, "found ETag none");
}

TEST(Scripted, RedirectsAreFollowedAndCounted) {
  ScriptedServer server([](const ScriptedRequest& request) {
    if (request.text.starts_with("GET /scene.voy "))
      return ScriptedReply{http_reply(302, "Location: /there\r\n", "over there")};
    if (request.text.starts_with("GET /round"))
      return ScriptedReply{http_reply(301, "Location: /round\r\n", "")};
    return sound(request);
  });
  expect_bridged(server);
  EXPECT_EQ(server.requests(), 4);
  expect_error(ErrorCode::refused_input, "redirects",
               [&] { http::Source(server.url("/round"), quick()); });
  EXPECT_EQ(server.requests(), 4 + 6);
}

// The URL that the user gave is sound: nothing that the server says makes it bad usage.
TEST(Scripted, ARedirectionToAMalformedUrlIsRefused) {
  for (const char* place : {"http://a b/", "http://[::1/", "http://x:99999999/"}) {
    ScriptedServer server([&](const ScriptedRequest&) {
      return ScriptedReply{http_reply(302, "Location: " + std::string(place) + "\r\n", "")};
    });
    expect_error(ErrorCode::refused_input, "expected these bytes",
                 [&] { http::Source(server.url(), quick()); });
  }
}

TEST(Scripted, RedirectsOutOfHttpAreRefused) {
  for (const char* place :
       {"file:///etc/hostname", "ftp://127.0.0.1/x", "gopher://127.0.0.1:1/x"}) {
    ScriptedServer server([&](const ScriptedRequest&) {
      return ScriptedReply{http_reply(302, "Location: " + std::string(place) + "\r\n", "")};
    });
    expect_error(ErrorCode::refused_input, "Protocol",
                 [&] { http::Source(server.url(), quick()); });
  }
}

TEST(Scripted, SecretsOfTheUrlAreSentAndNotShown) {
  std::string seen;
  ScriptedServer server([&](const ScriptedRequest& request) {
    seen = request.text;
    return ScriptedReply{http_reply(404, "", "")};
  });
  const std::string url =
      "http://anna:secret@127.0.0.1:" + std::to_string(server.port()) + "/scene.voy?key=hidden";
  try {
    const http::Source source(url, quick());
    ADD_FAILURE();
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find("secret"), std::string::npos) << what;
    EXPECT_EQ(what.find("hidden"), std::string::npos) << what;
    EXPECT_EQ(what.find(server.url()), 0u) << what;
  }
  EXPECT_NE(seen.find("GET /scene.voy?key=hidden "), std::string::npos) << seen;
  EXPECT_NE(seen.find("Authorization: Basic YW5uYTpzZWNyZXQ="), std::string::npos) << seen;
}

TEST(Scripted, CancellingEndsStalledReadsAndThoseThatWaitForThem) {
  http::Options options = quick();
  options.stall_time = 60s;
  options.deadline = 60s;
  options.connections = 2;
  ScriptedServer server(always([](const ScriptedRequest&) {
    return ScriptedReply{"HTTP/1.1 206", false, true};
  }));
  const http::Source source(server.url(), options);
  std::vector<std::thread> readers;
  for (int i = 0; i < 5; ++i)
    readers.emplace_back(
        [&] { expect_error(ErrorCode::io, "cancelled", [&] { read(source, 80'000, 10); }); });
  while (server.requests() < 3) std::this_thread::sleep_for(1ms);
  const Timer timer;
  source.cancel();
  for (std::thread& reader : readers) reader.join();
  EXPECT_LT(timer.elapsed(), 300ms);
  expect_error(ErrorCode::io, "cancelled", [&] { read(source, 80'000, 10); });
  EXPECT_EQ(read(source, 0, 10), file().substr(0, 10)) << "what is here needs no server";
}

TEST(Scripted, CancellingEndsTheWaitForANextTry) {
  http::Options options;
  ScriptedServer server(always([](const ScriptedRequest&) {
    return ScriptedReply{http_reply(503, "Retry-After: 20\r\n", "")};
  }));
  const http::Source source(server.url(), options);
  std::thread reader(
      [&] { expect_error(ErrorCode::io, "cancelled", [&] { read(source, 80'000, 10); }); });
  while (server.requests() < 2) std::this_thread::sleep_for(1ms);
  std::this_thread::sleep_for(20ms);
  const Timer timer;
  source.cancel();
  reader.join();
  EXPECT_LT(timer.elapsed(), 300ms);
}

TEST(Scripted, MoreReadsThanConnectionsWaitTheirTurn) {
  http::Options options = quick();
  options.connections = 1;
  options.deadline = 300ms;
  options.stall_time = 5s;
  ScriptedServer server(always([](const ScriptedRequest&) {
    return ScriptedReply{"HTTP/1.1 206", false, true};
  }));
  const http::Source source(server.url(), options);
  std::thread first([&] { EXPECT_THROW(read(source, 80'000, 10), Error); });
  while (server.requests() < 2) std::this_thread::sleep_for(1ms);
  const Timer timer;
  expect_error(ErrorCode::io_transient, "1 try", [&] { read(source, 80'000, 10); });
  EXPECT_LT(timer.elapsed(), 2s);
  first.join();
}

TEST(Scripted, AProxyIsUsedButForWhatNoProxyNames) {
  std::string asked;
  ScriptedServer proxy([&](const ScriptedRequest& request) {
    asked = request.text.substr(0, request.text.find('\r'));
    return sound(request);
  });
  ::setenv("http_proxy", proxy.url("").c_str(), 1);
  const http::Source source("http://voyager.invalid/scene.voy", quick());
  EXPECT_EQ(read(source, 80'000, 10), file().substr(80'000, 10));
  EXPECT_EQ(asked, "GET http://voyager.invalid/scene.voy HTTP/1.1");
  ScriptedServer direct([](const ScriptedRequest& request) { return sound(request); });
  ::setenv("no_proxy", "127.0.0.1", 1);
  const int before = proxy.requests();
  expect_bridged(direct);
  EXPECT_EQ(proxy.requests(), before);
  ::unsetenv("http_proxy");
  ::unsetenv("no_proxy");
}

}  // namespace
}  // namespace voyager::scripted_test
