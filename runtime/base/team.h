#pragma once
// Loops of one thread that others, which have work of their own, take part in when they come by.
// It starts no threads, and nobody waits for one that does not come.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>

namespace voyager {

class Team {
 public:
  // lanes: how many threads take part at once, with the one whose loops they are.
  explicit Team(unsigned lanes) : lanes_(std::max(lanes, 1u)) {}
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  unsigned lanes() const { return lanes_; }
  // How many have come to the last session.
  unsigned helpers() const { return helpers_; }

  // As long as one is open, others may take part in what its thread loops over. One at a time.
  class Session {
   public:
    explicit Session(Team& team);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

   private:
    Team& team_;
  };

  // body(lane, i) for each i in [0, n), once, in any order, those of one lane one after another.
  // Lane 0 is the caller's. Throws what a body threw, when none runs any more; some may then not
  // have been run.
  void loop(size_t n, const std::function<void(unsigned lane, size_t i)>& body);

  // Takes part until the session ends. False: none is open, or all its lanes are taken; to find
  // that none is open costs next to nothing.
  bool help();

 private:
  // Indices that a thread takes at once; each takes some microseconds.
  static constexpr size_t kGrain = 4;

  void work(unsigned lane);

  const unsigned lanes_;
  std::mutex mutex_;
  std::condition_variable begun_, done_;
  std::atomic<bool> open_{false};     // changed under mutex_
  uint64_t session_ = 0, loop_ = 0;   // how many there have been
  std::atomic<unsigned> helpers_{0};  // of the session; changed under mutex_
  unsigned busy_ = 0;                 // of them, those that run bodies
  // Of the loop: set by its thread alone, while nobody is busy.
  const std::function<void(unsigned, size_t)>* body_ = nullptr;
  size_t n_ = 0;
  std::atomic<size_t> next_{0};
  std::exception_ptr failure_;
};

}  // namespace voyager
