#pragma once
// The connections to one URL, and the end of all waiting for them.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "http/connection.h"

namespace voyager::http {

class Pool {
 public:
  // Goes back when it dies, so not after the Pool.
  class Lease {
   public:
    Lease(Pool& pool, Connection& connection) : pool_(pool), connection_(connection) {}
    ~Lease() { pool_.give_back(connection_); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Connection* operator->() const { return &connection_; }

   private:
    Pool& pool_;
    Connection& connection_;
  };

  Pool(std::string url, std::string name, const Options& options)
      : url_(std::move(url)), name_(std::move(name)), options_(options) {}

  // All are thread-safe.
  // The connection used last, so that few stay open where few are used. Waits for one until
  // `deadline`, then throws Error(io_transient); after cancel() Error(io).
  Lease take(Clock::time_point deadline);
  // Sleeps; after cancel(), also a later one, throws Error(io).
  void wait(std::chrono::milliseconds time);
  // Ends take(), wait() and the requests in flight, for good.
  void cancel() noexcept;

 private:
  void give_back(Connection& connection) noexcept;
  void refuse_cancelled() const;

  const std::string url_, name_;
  const Options options_;
  std::atomic<bool> cancelled_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::unique_ptr<Connection>> all_;
  std::vector<Connection*> spare_;
};

}  // namespace voyager::http
