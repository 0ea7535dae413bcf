#pragma once
// What tests of the HTTP source share.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>

#include "http/source.h"
#include "runtime/base/error.h"

namespace voyager::test {

using namespace std::chrono_literals;

// The machine's own settings do not reach these tests.
struct PlainEnvironment {
  PlainEnvironment() {
    for (const char* name :
         {"http_proxy", "https_proxy", "HTTPS_PROXY", "all_proxy", "ALL_PROXY", "no_proxy",
          "NO_PROXY", "CURL_CA_BUNDLE", "SSL_CERT_FILE", "SSL_CERT_DIR", "VOYAGER_HTTP_TIMEOUT"})
      ::unsetenv(name);
  }
};
inline const PlainEnvironment plain_environment;

// Quick to give up, for tests that wait for it.
inline http::Options quick() {
  http::Options options;
  options.stall_time = 3s;
  options.deadline = 15s;
  options.tries = 4;
  options.first_wait = 10ms;
  return options;
}

// The same, where a stall is what the test is about.
inline http::Options impatient() {
  http::Options options = quick();
  options.stall_time = 400ms;
  options.deadline = 3s;
  return options;
}

inline std::string random_text(size_t count, uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::string text(count, '\0');
  for (char& c : text) c = static_cast<char>(random());
  return text;
}

inline std::string read(const ByteSource& source, uint64_t offset, size_t count) {
  std::string into(count, '\0');
  source.read(offset, std::as_writable_bytes(std::span(into)));
  return into;
}

// Runs `act`, which must throw: with `code`, and a message that has `words`.
template <class Act>
void expect_error(ErrorCode code, const std::string& words, const Act& act) {
  try {
    act();
    ADD_FAILURE() << "no error, expected one with: " << words;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
        << error.what() << "\nexpected in it: " << words;
  }
}

class Timer {
 public:
  std::chrono::milliseconds elapsed() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(http::Clock::now() - start_);
  }

 private:
  http::Clock::time_point start_ = http::Clock::now();
};

}  // namespace voyager::test
