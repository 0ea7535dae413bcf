// What the threads do, or step() in their place: they plan, read, decode and fill.
#include <algorithm>
#include <chrono>

#include "runtime/base/floating_point_mode.h"
#include "runtime/stream/scene_stream.h"

namespace voyager {
namespace {

constexpr uint32_t kMostChunksARead = 64;
constexpr int kPlanRest = 3;  // after a plan, times what it took

// Chunk by chunk it would fail as well: a source that stalls, and a file that is gone.
bool is_of_source(const Error& error) {
  return error.code() == ErrorCode::io_transient || error.code() == ErrorCode::file_not_found;
}

}  // namespace

void SceneStream::run() {
  const FloatingPointMode mode;
  for (;;) {
    uint64_t seen = 0;
    {
      const std::lock_guard small(small_mutex_);
      if (stopping_) return;
      seen = signals_;
    }
    double wait = 0;
    {
      Lock lock(mutex_);
      if (step(lock)) continue;
      wait = next_due();
    }
    std::unique_lock small(small_mutex_);
    const auto woken = [&] { return stopping_ || signals_ != seen; };
    if (wait < 0)
      wake_.wait(small, woken);
    else
      wake_.wait_for(small, std::chrono::duration<double>(wait), woken);
  }
}

bool SceneStream::step() {
  Lock lock(mutex_);
  return step(lock);
}

bool SceneStream::step(Lock& lock) {
  if (lost_) return rebuild_if_due(lock);
  try {
    return work(lock);
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    lose(std::current_exception());
    return false;
  }
}

bool SceneStream::work(Lock& lock) {
  const bool done = plan_if_asked() || retry_due() || fill_one(lock) || read_some(lock);
  commit_due_ = residency_.has_changes();
  if (done) {
    publish();
    signal();
  }
  return done;
}

bool SceneStream::plan_if_asked() {
  std::vector<Viewer> viewers;
  // Threads that read must not all be planning, however many chunks a scene has.
  const auto now = std::chrono::steady_clock::now();
  if (desc_.readers != 0 && now < next_plan_) return false;
  {
    const std::lock_guard small(small_mutex_);
    if (!look_again_) return false;
    look_again_ = false;
    for (const auto& [who, of] : viewers_) viewers.insert(viewers.end(), of.begin(), of.end());
  }
  residency_.plan(viewers);
  // Those that nobody wants any more.
  std::erase_if(coming_, [&](const auto& coming) { return !residency_.is_coming(coming.first); });
  const auto end = std::chrono::steady_clock::now();
  next_plan_ = end + kPlanRest * (end - now);
  return true;
}

bool SceneStream::retry_due() {
  const std::vector<uint32_t> due = failures_.take_due(now());
  for (const uint32_t chunk : due) residency_.retry(chunk);
  if (due.empty()) return false;
  look_again();
  return true;
}

// The lock is let go while the slot is filled: no one else knows of it.
bool SceneStream::fill_one(Lock& lock) {
  while (!ready_.empty() && !residency_.keep(ready_.front())) {
    forget(ready_.front());
    ready_.pop_front();
  }
  if (ready_.empty()) return false;
  const uint32_t chunk = ready_.front(), slot = residency_.take_slot(chunk);
  if (slot == Residency::kNoSlot) return false;
  ready_.pop_front();
  Coming& coming = coming_.at(chunk);
  staged_bytes_ -= coming.stored_bytes;
  coming.stored_bytes = 0;
  coming.chunk.links.slot = slot;
  coming.chunk.links.blocks = residency_.blocks(chunk);
  ++filling_;
  lock.unlock();
  std::exception_ptr failure;
  try {
    pool_.fill(slot, coming.chunk);
  } catch (...) {
    failure = std::current_exception();
  }
  coming.chunk.content = {};
  coming.chunk.records = {};
  lock.lock();
  --filling_;
  filled_.notify_all();
  if (!failure) {
    residency_.filled(chunk);
    return true;
  }
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    fail(chunk, error);
  }
  return true;
}

// The lock is let go meanwhile. No bytes where it fails.
std::vector<std::byte> SceneStream::read(ChunkRange range, std::optional<Error>& failure,
                                         Lock& lock) {
  std::vector<std::byte> bytes;
  lock.unlock();
  try {
    bytes = file_->read_stored(range.first, range.last);
  } catch (const Error& error) {
    failure = error;
  } catch (const std::exception& error) {
    failure.emplace(ErrorCode::io_transient, file_->name() + ": " + error.what());
  }
  lock.lock();
  ++reads_;
  bytes_read_ += bytes.size();
  if (!failure)
    failures_.source_answered();
  else if (is_of_source(*failure))
    failures_.source_failed(*failure, now());
  return bytes;
}

bool SceneStream::read_some(Lock& lock) {
  if (staged_bytes_ >= desc_.staged_bytes || !failures_.source_may_be_read(now())) return false;
  const ChunkRange range = residency_.take_requests(kMostChunksARead, desc_.read_bytes);
  if (range.empty()) return false;
  const uint64_t generation = generation_;
  std::optional<Error> failure;
  const std::vector<std::byte> bytes = read(range, failure, lock);
  if (failure && (is_of_source(*failure) || range.last - range.first == 1))
    fail_range(range, *failure, generation);
  else
    stage_range(range, bytes, generation, lock);
  return true;
}

void SceneStream::fail_range(ChunkRange range, const Error& error, uint64_t generation) {
  for (uint32_t chunk = range.first; chunk < range.last && generation_ == generation; ++chunk)
    fail(chunk, error);
}

// No bytes: they could not be had at once, and which of the chunks can be had is found one by one,
// in the order of the file: where one cannot, those behind it are beyond its end, or of a file that
// was replaced.
void SceneStream::stage_range(ChunkRange range, const std::vector<std::byte>& bytes,
                              uint64_t generation, Lock& lock) {
  const auto& chunks = file_->chunks();
  for (uint32_t chunk = range.first; chunk < range.last && generation_ == generation; ++chunk) {
    if (!bytes.empty()) {
      const uint64_t at = chunks[chunk].offset - chunks[range.first].offset;
      stage(chunk, std::span(bytes).subspan(at, chunks[chunk].bytes), lock);
      continue;
    }
    std::optional<Error> failure;
    const std::vector<std::byte> own = read({chunk, chunk + 1}, failure, lock);
    if (failure) return fail_range({chunk, range.last}, *failure, generation);
    stage(chunk, own, lock);
  }
}

StagedChunk SceneStream::decode(uint32_t chunk, std::span<const std::byte> stored) const {
  StagedChunk staged = stage_chunk(file_->decode(chunk, stored), chunk, tiers_, file_->name());
  if (staged.record_blocks() > records_.most_blocks(chunk)) refuse_records(staged, file_->name());
  return staged;
}

// The lock is let go while the chunk is decoded.
void SceneStream::stage(uint32_t chunk, std::span<const std::byte> stored, Lock& lock) {
  StagedChunk staged;
  std::exception_ptr failure;
  const uint64_t generation = generation_;
  lock.unlock();
  try {
    staged = decode(chunk, stored);
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  if (generation_ != generation) return;
  if (failure) {
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      fail(chunk, error);
    }
    return;
  }
  const bool wanted = residency_.read(chunk, staged.record_blocks());
  if (residency_.overfull()) look_again();
  if (!wanted) return;
  const uint64_t bytes = file_->chunks()[chunk].bytes;
  coming_[chunk] = {std::move(staged), bytes};
  staged_bytes_ += bytes;
  ready_.push_back(chunk);
}

void SceneStream::fail(uint32_t chunk, const std::exception& error) {
  forget(chunk);
  residency_.failed(chunk);
  const auto* ours = dynamic_cast<const Error*>(&error);
  const Error other(ErrorCode::io_transient,
                    file_->name() + ": chunk " + std::to_string(chunk) + ": " + error.what());
  add_failure(chunk, ours != nullptr ? *ours : other);
}

// What hangs from the chunk is no longer to be had either: that takes another plan.
void SceneStream::add_failure(uint32_t chunk, const Error& error) {
  failures_.add(chunk, error, now());
  look_again();
}

void SceneStream::look_again() {
  const std::lock_guard small(small_mutex_);
  look_again_ = true;
}

void SceneStream::forget(uint32_t chunk) {
  const auto found = coming_.find(chunk);
  if (found == coming_.end()) return;
  staged_bytes_ -= found->second.stored_bytes;
  coming_.erase(found);
}

}  // namespace voyager
