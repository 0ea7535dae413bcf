#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace voyager::http {

// Bounds on what a server may cost. The module opens URLs with the defaults, or as
// VOYAGER_HTTP_TIMEOUT says; tests have others.
struct Options {
  size_t connections = 12;  // to one URL at once; further reads wait for one of them
  // Without a byte for so long, a connection is dropped: while it is made, and after.
  std::chrono::milliseconds stall_time{10'000};
  // Of one read with all its tries: so long, and what the bytes that come take at the slowest rate.
  std::chrono::milliseconds deadline{30'000};
  uint64_t slowest_rate = 4096;               // bytes a second
  int tries = 5;                              // of one read, where failures may pass
  std::chrono::milliseconds first_wait{100};  // before the second try, then doubled
  int redirects = 5;

  std::chrono::milliseconds time_for(uint64_t bytes) const {
    return std::chrono::milliseconds(1000 * bytes / slowest_rate);
  }
};

// The variable that users set, in seconds: stall_time, and a third of deadline.
inline constexpr const char* kTimeoutVariable = "VOYAGER_HTTP_TIMEOUT";
// Throws Error(invalid_argument) where it is no whole number from 1 to 3600.
Options options_of_environment();
// How long a silent server is waited for, and how to change it: for messages.
std::string time_text(const Options& options);

}  // namespace voyager::http
