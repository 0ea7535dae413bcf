#include "runtime/base/team.h"

#include <utility>

namespace voyager {

Team::Session::Session(Team& team) : team_(team) {
  const std::lock_guard lock(team_.mutex_);
  team_.open_ = true;
  ++team_.session_;
  team_.helpers_ = 0;
}

Team::Session::~Session() {
  {
    const std::lock_guard lock(team_.mutex_);
    team_.open_ = false;
  }
  team_.begun_.notify_all();
}

void Team::loop(size_t n, const std::function<void(unsigned, size_t)>& body) {
  {
    const std::lock_guard lock(mutex_);
    body_ = &body;
    n_ = n;
    next_ = 0;
    ++loop_;
  }
  if (n > kGrain) begun_.notify_all();
  work(0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return busy_ == 0; });
  body_ = nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::work(unsigned lane) {
  for (;;) {
    const size_t first = next_.fetch_add(kGrain);
    if (first >= n_) return;
    try {
      for (size_t i = first; i < std::min(first + kGrain, n_); ++i) (*body_)(lane, i);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      next_ = n_;
    }
  }
}

bool Team::help() {
  if (!open_) return false;
  std::unique_lock lock(mutex_);
  if (!open_ || helpers_ + 1 >= lanes_) return false;
  const unsigned lane = ++helpers_;
  const uint64_t session = session_;
  uint64_t last = 0;
  while (open_ && session_ == session) {
    if (body_ == nullptr || last == loop_) {
      begun_.wait(lock);
      continue;
    }
    last = loop_;
    ++busy_;
    lock.unlock();
    work(lane);
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
  return true;
}

}  // namespace voyager
