#include "http/source.h"

#include <algorithm>
#include <cstring>
#include <random>

#include "runtime/base/error.h"
#include "runtime/base/url.h"

namespace voyager::http {
namespace {

constexpr uint64_t kFirstBytes = 65536;  // a .voy's header and, of small ones, its tables

}  // namespace

// The tries of one read.
class Source::Tries {
 public:
  Tries(const Options& options, Pool& pool)
      : options_(options), pool_(pool), end_(Clock::now() + options.deadline) {}

  // Asks for the range once more, or throws what cannot be helped. `transfer` has range, into
  // and known; true when all of the range has come. False: try again with what is left of it.
  bool get(Transfer& transfer) {
    transfer.deadline = end_;
    transfer.got = 0;
    transfer.version.reset();
    try {
      pool_.take(end_)->get(transfer);
      return true;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::io_transient) throw;
      end_ += options_.time_for(transfer.got);
      wait(error, transfer.retry_after);
      return false;
    }
  }

 private:
  void wait(const Error& error, std::chrono::milliseconds wish) {
    ++done_;
    const std::chrono::milliseconds pause = std::max(wish, jittered(next_));
    if (done_ >= options_.tries || Clock::now() + pause >= end_)
      throw Error(ErrorCode::io_transient, error.what() + std::string("; ") +
                                               std::to_string(done_) +
                                               (done_ == 1 ? " try" : " tries"));
    next_ *= 2;
    pool_.wait(pause);
  }

  // Half of it to all of it, so that those who failed together do not come back together.
  static std::chrono::milliseconds jittered(std::chrono::milliseconds time) {
    thread_local std::minstd_rand random{std::random_device{}()};
    return time / 2 + time * static_cast<int>(random() % 1024) / 2048;
  }

  const Options& options_;
  Pool& pool_;
  Clock::time_point end_;  // should nothing more come
  int done_ = 0;
  std::chrono::milliseconds next_ = options_.first_wait;
};

Source::Source(const std::string& url, const Options& options)
    : name_(shown_path(url)), options_(options), pool_(url, name_, options) {
  read_first_bytes();
}

void Source::read_first_bytes() {
  first_bytes_.resize(kFirstBytes);
  Transfer transfer{{0, kFirstBytes - 1}, first_bytes_};
  for (Tries tries(options_, pool_); !tries.get(transfer);) {
  }
  version_ = *transfer.version;
  first_bytes_.resize(transfer.got);
}

void Source::read(uint64_t offset, std::span<std::byte> into) const {
  check_range(*this, offset, into.size());
  if (!into.empty() && offset < first_bytes_.size()) {
    const size_t count = std::min<size_t>(first_bytes_.size() - offset, into.size());
    std::memcpy(into.data(), first_bytes_.data() + offset, count);
    offset += count;
    into = into.subspan(count);
  }
  Tries tries(options_, pool_);
  while (!into.empty()) {
    Transfer transfer{{offset, offset + into.size() - 1}, into, &version_};
    const bool done = tries.get(transfer);
    offset += transfer.got;
    into = into.subspan(transfer.got);
    if (done) break;
  }
}

}  // namespace voyager::http
