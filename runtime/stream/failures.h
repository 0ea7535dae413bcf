#pragma once
// What could not be had: when to try again, and what to say of it.
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/error.h"

namespace voyager {

// What failed for what may pass is tried again, later each time: a disk or a server may come back,
// and a host may let the frames end that a slot waits for. So is a chunk that was damaged, once: it
// may have been on its way only. What a file says of itself stays wrong, and what is gone stays
// gone.
//
// The source as a whole is left alone for a while where a read failed, longer each time until one
// succeeds: whatever it is that fails, asking for each of a thousand chunks makes it no better.
// After as many times as a chunk is tried it is down, and nobody should wait for it.
class Failures {
 public:
  static constexpr double kFirstWait = 0.1, kLongestWait = 10;  // seconds
  static constexpr unsigned kPatience = 5;                      // times

  // now: seconds, on a clock that never goes back.
  void add(uint32_t chunk, const Error& error, double now);
  // It came after all.
  void remove(uint32_t chunk);
  // Nothing of what is wanted now has been tried.
  void forget_chunks();

  // A read of the source, of whichever chunks.
  void source_failed(const Error& error, double now);
  void source_answered();
  bool source_may_be_read(double now) const { return now >= source_due_; }
  bool source_is_down() const { return source_failures_ >= kPatience; }
  // Chunks to try again now; they are not named twice.
  std::vector<uint32_t> take_due(double now);
  // Seconds until one is due, or the source is; negative: neither will be.
  double next_due(double now) const;

  uint64_t count() const { return count_; }
  // Whether it is no use to wait for the chunk, as somebody has done since then: it is not tried
  // again, or was in vain often, the last time since.
  bool is_hopeless(uint32_t chunk, double since) const;
  // Throws what kept the chunk from coming; it has failed.
  [[noreturn]] void rethrow(uint32_t chunk) const;
  // Throws what the source failed with; it is down.
  [[noreturn]] void rethrow_source() const { throw Error(source_code_, source_message_); }
  // Says what is no failure of a chunk, as a cause like others.
  void tell(const std::string& message);
  // Of causes that were not told yet: each once, however many chunks it costs.
  std::vector<std::string> take_messages();

 private:
  struct Failed {
    ErrorCode code;
    std::string message;
    unsigned times = 0;
    double due = -1;   // negative: never, or now on its way
    double last = -1;  // when it failed
    bool again = false;
  };

  static double wait_after(unsigned times);

  std::map<uint32_t, Failed> failed_;
  std::set<std::pair<double, uint32_t>> due_;  // the same, without negatives, in order
  unsigned source_failures_ = 0;               // reads in a row
  double source_due_ = 0, source_failed_ = 0;
  ErrorCode source_code_{};
  std::string source_message_;
  std::set<std::string> told_;
  std::vector<std::string> messages_;
  uint64_t count_ = 0;
};

}  // namespace voyager
