#pragma once
// Chunks that could not be had: when to try again, and what to say of it.
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runtime/base/error.h"

namespace voyager {

// A read that failed for what may pass is tried again, later each time: a disk or a server may
// come back. So is a chunk that was damaged, once: it may have been on its way only. What a file
// says of itself stays wrong, and what is gone stays gone.
class Failures {
 public:
  static constexpr double kFirstWait = 0.1, kLongestWait = 10;  // seconds
  static constexpr unsigned kPatience = 5;                      // times

  // now: seconds, on a clock that never goes back.
  void add(uint32_t chunk, const Error& error, double now);
  // It came after all.
  void remove(uint32_t chunk) { failed_.erase(chunk); }
  // Chunks to try again now; they are not named twice.
  std::vector<uint32_t> take_due(double now);
  // Seconds until one is due; negative: none is.
  double next_due(double now) const;

  uint64_t count() const { return count_; }
  // Whether it is no use to wait for the chunk: it is not tried again, or was in vain often.
  bool is_hopeless(uint32_t chunk) const;
  // Throws what kept the chunk from coming; it has failed.
  [[noreturn]] void rethrow(uint32_t chunk) const;
  // Of causes that were not told yet: each once, however many chunks it costs.
  std::vector<std::string> take_messages();

 private:
  struct Failed {
    ErrorCode code;
    std::string message;
    unsigned times = 0;
    double due = -1;  // negative: never, or now on its way
    bool again = false;
  };

  std::map<uint32_t, Failed> failed_;
  std::set<std::string> told_;
  std::vector<std::string> messages_;
  uint64_t count_ = 0;
};

}  // namespace voyager
