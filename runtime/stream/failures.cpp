#include "runtime/stream/failures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace voyager {
namespace {

// A message without its numbers: offsets and counts differ where the cause is the same.
std::string cause_of(const std::string& message) {
  std::string cause;
  std::copy_if(message.begin(), message.end(), std::back_inserter(cause),
               [](char c) { return c < '0' || c > '9'; });
  return cause;
}

// What a disk, a server or a host may mend.
bool may_pass(ErrorCode code) {
  return code == ErrorCode::io_transient || code == ErrorCode::timeout;
}

}  // namespace

void Failures::add(uint32_t chunk, const Error& error, double now) {
  ++count_;
  Failed& failed = failed_[chunk];
  failed.code = error.code();
  failed.message = error.what();
  ++failed.times;
  failed.again =
      may_pass(error.code()) || (error.code() == ErrorCode::damaged_chunk && failed.times == 1);
  failed.last = now;
  if (failed.due >= 0) due_.erase({failed.due, chunk});
  failed.due = failed.again ? now + wait_after(failed.times) : -1;
  if (failed.again) due_.emplace(failed.due, chunk);
  tell(failed.message);
}

void Failures::remove(uint32_t chunk) {
  const auto found = failed_.find(chunk);
  if (found == failed_.end()) return;
  due_.erase({found->second.due, chunk});
  failed_.erase(found);
}

void Failures::forget_chunks() {
  failed_.clear();
  due_.clear();
}

void Failures::tell(const std::string& message) {
  if (told_.insert(cause_of(message)).second) messages_.push_back(message);
}

double Failures::wait_after(unsigned times) {
  return std::min(kLongestWait,
                  kFirstWait * std::ldexp(1.0, static_cast<int>(std::min(times - 1, 16u))));
}

void Failures::source_failed(const Error& error, double now) {
  source_code_ = error.code();
  source_message_ = error.what();
  // Reads that were in flight together fail together.
  if (!source_may_be_read(now)) return;
  // Long ago, and nothing was read since: not in a row.
  constexpr double kForgotten = 6 * kLongestWait;
  if (now - source_failed_ > kForgotten) source_failures_ = 0;
  source_failed_ = now;
  ++source_failures_;
  source_due_ = now + wait_after(source_failures_);
}

void Failures::source_answered() {
  // What goes wrong after that is news.
  if (source_is_down()) told_.clear();
  source_failures_ = 0;
  source_due_ = 0;
}

std::vector<uint32_t> Failures::take_due(double now) {
  std::vector<uint32_t> due;
  while (!due_.empty() && due_.begin()->first <= now) {
    const uint32_t chunk = due_.begin()->second;
    due_.erase(due_.begin());
    failed_.at(chunk).due = -1;
    due.push_back(chunk);
  }
  return due;
}

double Failures::next_due(double now) const {
  double next = -1;
  if (!due_.empty()) next = std::max(0.0, due_.begin()->first - now);
  if (source_may_be_read(now)) return next;
  return next < 0 ? source_due_ - now : std::min(next, source_due_ - now);
}

bool Failures::is_hopeless(uint32_t chunk, double since) const {
  const auto found = failed_.find(chunk);
  if (found == failed_.end()) return false;
  const Failed& failed = found->second;
  // One that is due again, or on its way, was not tried in vain since.
  return !failed.again || (failed.times >= kPatience && (failed.last >= since || failed.due >= 0));
}

void Failures::rethrow(uint32_t chunk) const {
  const auto found = failed_.find(chunk);
  if (found == failed_.end())
    throw Error(ErrorCode::internal, "chunk " + std::to_string(chunk) + ": failed for no reason");
  throw Error(found->second.code, found->second.message);
}

std::vector<std::string> Failures::take_messages() {
  return std::exchange(messages_, {});
}

}  // namespace voyager
