// Against a real server.
#include "tests/http/nginx.h"

#include <atomic>
#include <thread>
#include <vector>

#include "tests/http/http_test.h"

namespace voyager::nginx_test {
namespace {

using namespace test;

class OnNginx : public testing::Test {
 protected:
  void SetUp() override { VOYAGER_NEEDS_NGINX(); }
  const std::string file_ = random_text(2'000'003);
  Nginx nginx_;
};

// A read of `count` bytes in each of `threads` threads, `times` each, at random places.
int wrong_reads(const ByteSource& source, const std::string& file, unsigned threads, int times) {
  std::atomic<int> wrong{0};
  std::vector<std::thread> readers;
  for (unsigned t = 0; t < threads; ++t)
    readers.emplace_back([&, t] {
      std::mt19937 random(t);
      for (int i = 0; i < times; ++i) {
        const size_t offset = random() % file.size();
        const size_t count = std::min<size_t>(random() % 100'000, file.size() - offset);
        try {
          wrong += read(source, offset, count) != file.substr(offset, count);
        } catch (const Error& error) {
          ++wrong;
          ADD_FAILURE() << error.what();
        }
      }
    });
  for (std::thread& reader : readers) reader.join();
  return wrong;
}

TEST_F(OnNginx, ManyThreadsGetTheRightBytesOverFewConnections) {
  nginx_.serve("scene.voy", file_);
  ASSERT_EQ(nginx_.start(), "");
  http::Options options = quick();
  options.connections = 3;
  const http::Source source(nginx_.url("scene.voy"), options);
  EXPECT_EQ(source.size(), file_.size());
  EXPECT_EQ(source.name(), nginx_.url("scene.voy"));
  EXPECT_EQ(wrong_reads(source, file_, 8, 25), 0);
  const auto requests = nginx_.requests(150);
  EXPECT_GT(requests.size(), 150u);
  EXPECT_LE(different_first_words(requests), 3u);
}

TEST_F(OnNginx, OneThreadNeedsOneConnection) {
  nginx_.serve("scene.voy", file_);
  ASSERT_EQ(nginx_.start(), "");
  const http::Source source(nginx_.url("scene.voy"), quick());
  EXPECT_EQ(wrong_reads(source, file_, 1, 40), 0);
  EXPECT_EQ(different_first_words(nginx_.requests(30)), 1u);
}

TEST_F(OnNginx, EdgesOfTheFileAreWhatTheyAre) {
  const std::string small = random_text(100, 2), just = random_text(65536, 3);
  nginx_.serve("large", file_);
  nginx_.serve("small", small);
  nginx_.serve("just", just);
  nginx_.serve("empty", "");
  ASSERT_EQ(nginx_.start(), "");
  for (const auto& [name, bytes] : {std::pair<const char*, std::string>{"large", file_},
                                    {"small", small},
                                    {"just", just},
                                    {"empty", ""}}) {
    const http::Source source(nginx_.url(name), quick());
    ASSERT_EQ(source.size(), bytes.size()) << name;
    EXPECT_EQ(read(source, 0, bytes.size()), bytes) << name;
    EXPECT_EQ(read(source, bytes.size(), 0), "") << name;
    const size_t last = std::max<size_t>(bytes.size(), 1) - 1;
    EXPECT_EQ(read(source, last, bytes.size() - last), bytes.substr(last)) << name;
    expect_error(ErrorCode::refused_input, "expected 2", [&] { read(source, last, 2); });
  }
}

TEST_F(OnNginx, TheFirstBytesNeedNoFurtherRequest) {
  nginx_.serve("scene.voy", file_);
  ASSERT_EQ(nginx_.start(), "");
  const http::Source source(nginx_.url("scene.voy"), quick());
  EXPECT_EQ(read(source, 0, 64) + read(source, 64, 60'000), file_.substr(0, 60'064));
  EXPECT_EQ(read(source, 65'000, 1'000), file_.substr(65'000, 1'000));
  EXPECT_EQ(read(source, 150'000, 10), file_.substr(150'000, 10));
  EXPECT_EQ(nginx_.requests(3).size(), 3u);
}

TEST_F(OnNginx, MissingAndForbiddenFilesAreToldApart) {
  nginx_.serve("secret", file_);
  ASSERT_EQ(nginx_.start("location /secret { deny all; }"), "");
  expect_error(ErrorCode::file_not_found, nginx_.url("none") + ": bytes 0-65535: found status 404",
               [&] { http::Source(nginx_.url("none"), quick()); });
  expect_error(ErrorCode::io, "found status 403",
               [&] { http::Source(nginx_.url("secret"), quick()); });
  EXPECT_EQ(nginx_.requests(2).size(), 2u) << "neither is asked for again";
}

TEST_F(OnNginx, AFileReplacedWhileOpenIsNamed) {
  nginx_.serve("scene.voy", file_, 100);
  ASSERT_EQ(nginx_.start(), "");
  const http::Source source(nginx_.url("scene.voy"), quick());
  EXPECT_EQ(read(source, 70'000, 1'000), file_.substr(70'000, 1'000));
  nginx_.serve("scene.voy", random_text(file_.size(), 7));  // only its date tells
  const auto later = [&] { read(source, 70'000, 1'000); };
  expect_error(ErrorCode::io, "the file was replaced while open", later);
  nginx_.serve("scene.voy", random_text(50'000, 7));  // nor has it such bytes
  expect_error(ErrorCode::io, "the file was replaced while open", later);
  nginx_.serve("scene.voy", "");
  expect_error(ErrorCode::io, "the file was replaced while open", later);
  nginx_.serve("scene.voy", file_, 50);
  expect_error(ErrorCode::io, "found ETag", later);
}

TEST_F(OnNginx, WithoutAnETagTheDateTells) {
  nginx_.serve("scene.voy", file_, 100);
  ASSERT_EQ(nginx_.start("etag off;"), "");
  const http::Source source(nginx_.url("scene.voy"), quick());
  EXPECT_EQ(read(source, 70'000, 1'000), file_.substr(70'000, 1'000));
  nginx_.serve("scene.voy", random_text(file_.size(), 7));
  expect_error(ErrorCode::io, "found Last-Modified", [&] { read(source, 70'000, 1'000); });
}

TEST_F(OnNginx, ASlowConnectionIsNoFailureAndSeveralAreFaster) {
  nginx_.serve("scene.voy", file_);
  ASSERT_EQ(nginx_.start("limit_rate 400k;"), "");
  const http::Source source(nginx_.url("scene.voy"), quick());
  const Timer timer;
  std::vector<std::thread> readers;
  for (size_t i = 1; i <= 4; ++i)
    readers.emplace_back([&, i] {
      EXPECT_EQ(read(source, i * 400'000, 400'000), file_.substr(i * 400'000, 400'000));
    });
  for (std::thread& reader : readers) reader.join();
  EXPECT_GT(timer.elapsed(), 400ms);
  EXPECT_LT(timer.elapsed(), 2500ms) << "one after the other they take 4 s";
}

TEST_F(OnNginx, ARestartInMidFlightIsBridged) {
  nginx_.serve("scene.voy", file_);
  ASSERT_EQ(nginx_.start("limit_rate 3m;"), "");
  http::Options options = quick();
  options.tries = 10;
  options.first_wait = 50ms;
  const http::Source source(nginx_.url("scene.voy"), options);
  std::string got;
  std::thread reader([&] { got = read(source, 100'000, 1'900'000); });
  std::this_thread::sleep_for(200ms);
  nginx_.stop();
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(nginx_.restart(), "");
  reader.join();
  EXPECT_TRUE(got == file_.substr(100'000, 1'900'000));
}

TEST_F(OnNginx, AServerThatStaysAwayIsTransient) {
  nginx_.serve("scene.voy", file_);
  ASSERT_EQ(nginx_.start(), "");
  const http::Source source(nginx_.url("scene.voy"), quick());
  nginx_.stop();
  expect_error(ErrorCode::io_transient, "4 tries", [&] { read(source, 100'000, 10); });
  ASSERT_EQ(nginx_.restart(), "");
  EXPECT_EQ(read(source, 100'000, 10), file_.substr(100'000, 10));
}

TEST_F(OnNginx, CompressionIsNotAskedFor) {
  nginx_.serve("scene.txt", std::string(300'000, 'a'));
  ASSERT_EQ(nginx_.start("gzip on; gzip_types *; gzip_min_length 1; gzip_proxied any;"), "");
  const http::Source source(nginx_.url("scene.txt"), quick());
  EXPECT_EQ(read(source, 200'000, 100'000), std::string(100'000, 'a'));
}

}  // namespace
}  // namespace voyager::nginx_test
