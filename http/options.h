#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace voyager::http {

// Bounds on what a server may cost. The module opens URLs with the defaults; tests have others.
struct Options {
  size_t connections = 8;  // to one URL at once; further reads wait for one of them
  std::chrono::milliseconds connect_time{10'000};
  // A connection below so many bytes a second for so long is dropped.
  uint64_t slowest_rate = 4096;
  std::chrono::seconds stall_time{10};
  // Of one read with all its tries, beside its bytes at the slowest rate.
  std::chrono::milliseconds deadline{30'000};
  int tries = 5;                              // of one read, where failures may pass
  std::chrono::milliseconds first_wait{100};  // before the second try, then doubled
  int redirects = 5;
};

}  // namespace voyager::http
