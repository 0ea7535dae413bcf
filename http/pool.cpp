#include "http/pool.h"

#include "runtime/base/error.h"

namespace voyager::http {

void Pool::refuse_cancelled() const {
  if (cancelled_) throw Error(ErrorCode::io, name_ + ": reading was cancelled");
}

Pool::Lease Pool::take(Clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  const auto ready = [&] {
    return cancelled_ || !spare_.empty() || all_.size() < options_.connections;
  };
  if (!changed_.wait_until(lock, deadline, ready))
    throw Error(ErrorCode::io_transient, name_ + ": found all " + std::to_string(all_.size()) +
                                             " connections busy, expected one to become free");
  refuse_cancelled();
  if (spare_.empty()) {
    all_.reserve(options_.connections);
    spare_.reserve(options_.connections);  // so that giving back allocates nothing
    all_.push_back(std::make_unique<Connection>(url_, name_, options_, cancelled_));
    spare_.push_back(all_.back().get());
  }
  Connection* connection = spare_.back();
  spare_.pop_back();
  return Lease(*this, *connection);
}

void Pool::give_back(Connection& connection) noexcept {
  {
    const std::lock_guard lock(mutex_);
    spare_.push_back(&connection);
  }
  changed_.notify_one();
}

void Pool::wait(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, time, [&] { return cancelled_.load(); });
  refuse_cancelled();
}

void Pool::cancel() noexcept {
  const std::lock_guard lock(mutex_);
  cancelled_ = true;
  for (const auto& connection : all_) connection->wake();
  changed_.notify_all();
}

}  // namespace voyager::http
