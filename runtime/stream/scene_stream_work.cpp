// What the threads do, or step() in their place: they plan, read, decode and fill.
#include <algorithm>
#include <chrono>
#include <utility>

#include "runtime/base/clock.h"
#include "runtime/base/floating_point_mode.h"
#include "runtime/stream/scene_stream.h"

namespace voyager {
namespace {

constexpr uint32_t kMostChunksARead = 64;
// Times what a plan held the lock.
constexpr int kPlanRest = 3, kRestInTime = 12;

// Chunk by chunk it would fail as well: a source that stalls, and a file that is gone.
bool is_of_source(const Error& error) {
  return error.code() == ErrorCode::io_transient || error.code() == ErrorCode::file_not_found;
}

}  // namespace

void SceneStream::run() {
  constexpr double kFrame = 1e-3;  // seconds that one holds the pool
  const FloatingPointMode mode;
  for (;;) {
    uint64_t seen = 0;
    {
      const std::lock_guard small(small_mutex_);
      if (stopping_) return;
      seen = signals_;
    }
    if (team_.help()) continue;
    bool links_wait = false;
    double wait = 0;
    {
      Lock lock(mutex_);
      links_wait = !commit_between_frames(lock);
      if (step(lock)) continue;
      links_wait = links_wait || is_far_ahead();
      wait = next_due();
    }
    if (links_wait) wait = wait < 0 ? kFrame : std::min(wait, kFrame);
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
  // What is dropped in filling may be the last that a plan had to wait for.
  const bool done = plan_if_asked(&lock) || order_if_told() || retry_due() || fill_some(lock) ||
                    read_some(lock) || plan_if_asked(&lock);
  note_changes();
  if (done) {
    publish();
    signal();
  }
  return done;
}

// lock: let go while chunks are looked at; null for those who hold the pool, too.
bool SceneStream::plan_if_asked(Lock* lock) {
  std::vector<Viewer> viewers;
  if (planning_ || linking_) return false;
  if (residency_.left_out() && (waits_ != 0 || residency_.is_quiet()))
    ask_for_plan(PlanAsked::in_time);
  PlanAsked when;
  {
    const std::lock_guard small(small_mutex_);
    if (asked_ == PlanAsked::no || rests(next_plan())) return false;
    when = std::exchange(asked_, PlanAsked::no);
    for (const auto& [who, of] : lookers_)
      viewers.insert(viewers.end(), of.viewers.begin(), of.viewers.end());
  }
  looks_.begin(std::move(viewers));
  const auto look = std::chrono::steady_clock::now();
  auto looked = look;
  if (lock != nullptr) {
    looked = look_at_likely(*lock);
    plan_waits_ = true;
    linked_.wait(*lock, [&] { return !linking_; });
    plan_waits_ = planning_ = false;
    if (lost_) return false;
  }
  const auto begin = std::chrono::steady_clock::now();
  const bool in_haste = waits_ == 0 && (when != PlanAsked::in_time || !residency_.is_quiet());
  residency_.plan(looks_, linker_.lacks_room_for_cut(), in_haste);
  // Those that nobody wants any more.
  std::erase_if(coming_, [&](const auto& coming) { return !residency_.is_coming(coming.first); });
  const auto end = std::chrono::steady_clock::now();
  // And as long as it looked, so that no thread does nothing else.
  next_plan_ = end + kPlanRest * (end - begin) + (looked - look);
  next_plan_in_time_ = end + kRestInTime * (end - begin);
  return true;
}

// The lock and small_mutex_ are held, and a plan is asked for.
SceneStream::TimePoint SceneStream::next_plan() const {
  if (asked_ == PlanAsked::at_once) return {};
  if (asked_ == PlanAsked::soon || residency_.is_quiet()) return next_plan_;
  return std::max(next_plan_, next_plan_in_time_);
}

// Others wait for a plan: it must not take all of their time, however many chunks a scene has.
bool SceneStream::rests(TimePoint until) const {
  return desc_.readers != 0 && std::chrono::steady_clock::now() < until;
}

// As long as a frame of somebody's has told nothing, nothing is hidden.
bool SceneStream::order_if_told() {
  if (linking_ || rests(next_plan_)) return false;
  ShownChunks all;
  {
    const std::lock_guard small(small_mutex_);
    if (!std::exchange(told_, false)) return false;
    for (const auto& [who, of] : lookers_) {
      // Nothing, or of a pool of another size.
      if (of.shown.size() != residency_.slots()) {
        all.clear();
        break;
      }
      all.resize(of.shown.size());
      std::transform(of.shown.begin(), of.shown.end(), all.begin(), all.begin(),
                     [](Shown a, Shown b) { return std::max(a, b); });
    }
  }
  const auto begin = std::chrono::steady_clock::now();
  residency_.set_shown(std::move(all));
  const auto end = std::chrono::steady_clock::now();
  next_plan_ = end + kPlanRest * (end - begin);
  return true;
}

// So that less is left to do for a plan, for which others wait. From then on planning_ is true.
// Returns when it had looked.
SceneStream::TimePoint SceneStream::look_at_likely(Lock& lock) {
  const std::vector<uint32_t> likely = residency_.needed();
  planning_ = true;
  lock.unlock();
  std::exception_ptr failure;
  try {
    for (const uint32_t chunk : likely) {
      const ChunkRange children = graph_.children(chunk);
      looks_.at(chunk);
      for (uint32_t child = children.first; child < children.last; ++child) looks_.at(child);
    }
  } catch (...) {
    failure = std::current_exception();
  }
  const auto looked = std::chrono::steady_clock::now();
  lock.lock();
  if (!failure) return looked;
  planning_ = false;
  std::rethrow_exception(failure);
}

bool SceneStream::retry_due() {
  const std::vector<uint32_t> due = failures_.take_due(now());
  for (const uint32_t chunk : due) residency_.retry(chunk);
  if (due.empty()) return false;
  ask_for_plan(PlanAsked::soon);
  return true;
}

// Some at once: threads that take turns at the lock for each chunk wait for one another longer than
// they work.
bool SceneStream::fill_some(Lock& lock) {
  std::vector<StagedChunk*> some;
  while (some.size() < kMostAtOnce && !ready_.empty()) {
    const uint32_t chunk = ready_.front();
    if (!residency_.keep(chunk)) {
      forget(chunk);
      ready_.pop_front();
      continue;
    }
    StagedChunk* const staged = put(chunk);
    if (staged == nullptr) break;
    ready_.pop_front();
    some.push_back(staged);
  }
  if (some.empty()) return false;
  fill(some, lock);
  return true;
}

// Null: no slot is free.
StagedChunk* SceneStream::put(uint32_t chunk) {
  const uint32_t slot = residency_.take_slot(chunk);
  if (slot == Residency::kNoSlot) return nullptr;
  Coming& coming = coming_.at(chunk);
  staged_bytes_ -= coming.stored_bytes;
  coming.stored_bytes = 0;
  coming.chunk.put(slot, residency_.blocks(chunk));
  return &coming.chunk;
}

// The lock is let go meanwhile: no one else knows of the slots.
void SceneStream::fill(const std::vector<StagedChunk*>& some, Lock& lock) {
  ++filling_;
  lock.unlock();
  std::exception_ptr failure;
  try {
    pool_.fill(some);
  } catch (...) {
    failure = std::current_exception();
  }
  for (StagedChunk* staged : some) staged->drop_content();
  lock.lock();
  --filling_;
  filled_.notify_all();
  for (const StagedChunk* staged : some)
    if (failure)
      fail(staged->chunk, failure);  // of which nothing is left then
    else
      residency_.filled(staged->chunk);
  note_changes();
}

// The lock is let go meanwhile. No bytes where it fails.
std::vector<std::byte> SceneStream::read(ChunkRange range, std::optional<Error>& failure,
                                         Lock& lock) {
  std::vector<std::byte> bytes;
  ++reads_in_flight_;
  lock.unlock();
  const Stopwatch watch;
  try {
    bytes = file_->read_stored(range.first, range.last);
  } catch (const Error& error) {
    failure = error;
  } catch (const std::exception& error) {
    failure.emplace(ErrorCode::io_transient, file_->name() + ": " + error.what());
  }
  const double seconds = 1e-3 * watch.milliseconds();
  lock.lock();
  --reads_in_flight_;
  pace_reads(seconds);
  ++reads_;
  bytes_read_ += bytes.size();
  if (!failure)
    failures_.source_answered();
  else if (is_of_source(*failure))
    failures_.source_failed(*failure, now());
  return bytes;
}

// Where reads wait for answers, more in flight bring more until they take all of the bandwidth.
// Then each takes longer, and what a viewer sees next comes behind all of them.
void SceneStream::pace_reads(double seconds) {
  constexpr double kQuick = 0.35, kSlow = 0.7;
  constexpr unsigned kLeast = 2;
  if (file_->source().reads_at_once() <= 1) return;
  if (seconds < kQuick) reads_allowed_ = std::min(reads_allowed_ + 1, most_reads_);
  if (seconds > kSlow) reads_allowed_ = std::max(reads_allowed_ - 1, std::min(kLeast, most_reads_));
}

// Chunks that wait to be linked were asked for by an earlier plan, and come before what a viewer
// sees now. So few may wait, but twice what a commit may link.
bool SceneStream::is_far_ahead() const {
  constexpr size_t kFar = 512;
  if (desc_.readers == 0 || residency_.to_arrive() < kFar) return false;
  const size_t linked = std::max(enough_between_frames(), most_for_frame(now() - last_frame_));
  return residency_.to_arrive() >= 2 * linked;
}

bool SceneStream::read_some(Lock& lock) {
  if (reads_in_flight_ >= reads_allowed_ || is_far_ahead()) return false;
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
  while (range.first < range.last && generation_ == generation) {
    if (!bytes.empty()) {
      const ChunkRange some{range.first, std::min(range.first + kMostAtOnce, range.last)};
      const uint64_t end = chunks[range.last - 1].offset + chunks[range.last - 1].bytes;
      stage(some, std::span(bytes).last(end - chunks[some.first].offset), lock);
      range.first = some.last;
      continue;
    }
    std::optional<Error> failure;
    const std::vector<std::byte> own = read({range.first, range.first + 1}, failure, lock);
    if (failure) return fail_range(range, *failure, generation);
    if (generation_ != generation) return;
    stage({range.first, range.first + 1}, own, lock);
    ++range.first;
  }
}

StagedChunk SceneStream::decode(uint32_t chunk, std::span<const std::byte> stored) const {
  StagedChunk staged = stage_chunk(file_->decode(chunk, stored), chunk, tiers_, file_->name());
  if (staged.record_blocks() > records_.most_blocks(chunk)) refuse_records(staged, file_->name());
  return staged;
}

// stored: of the range, and what comes behind. The lock is let go while chunks are decoded.
void SceneStream::stage(ChunkRange range, std::span<const std::byte> stored, Lock& lock) {
  struct Decoded {
    StagedChunk staged;
    std::exception_ptr failure;
  };
  const auto& chunks = file_->chunks();
  std::vector<Decoded> decoded(range.last - range.first);
  const uint64_t generation = generation_;
  lock.unlock();
  for (uint32_t chunk = range.first; chunk < range.last; ++chunk) {
    team_.help();
    Decoded& of = decoded[chunk - range.first];
    try {
      const uint64_t at = chunks[chunk].offset - chunks[range.first].offset;
      of.staged = decode(chunk, stored.subspan(at, chunks[chunk].bytes));
    } catch (...) {
      of.failure = std::current_exception();
    }
  }
  lock.lock();
  if (generation_ != generation) return;
  std::vector<StagedChunk*> some;
  for (uint32_t chunk = range.first; chunk < range.last; ++chunk) {
    Decoded& of = decoded[chunk - range.first];
    if (of.failure)
      fail(chunk, of.failure);
    else if (StagedChunk* const staged = add_coming(chunk, std::move(of.staged)))
      some.push_back(staged);
  }
  if (!some.empty()) fill(some, lock);
}

// Where it has its turn and a slot: then it is to be filled at once, by the thread that has just
// decoded it. Null: it waits, or nobody wants it.
StagedChunk* SceneStream::add_coming(uint32_t chunk, StagedChunk&& staged) {
  const bool wanted = residency_.read(chunk, staged.record_blocks());
  if (residency_.overfull()) ask_for_plan(PlanAsked::soon);
  if (!wanted) return nullptr;
  const uint64_t bytes = file_->chunks().bytes(chunk);
  coming_[chunk] = {std::move(staged), bytes};
  staged_bytes_ += bytes;
  StagedChunk* const has_slot = ready_.empty() ? put(chunk) : nullptr;
  if (has_slot == nullptr) ready_.push_back(chunk);
  return has_slot;
}

void SceneStream::fail(uint32_t chunk, const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    fail(chunk, error);
  }
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
  ask_for_plan(PlanAsked::soon);
}

void SceneStream::ask_for_plan(PlanAsked when) {
  const std::lock_guard small(small_mutex_);
  asked_ = std::max(asked_, when);
}

void SceneStream::forget(uint32_t chunk) {
  const auto found = coming_.find(chunk);
  if (found == coming_.end()) return;
  staged_bytes_ -= found->second.stored_bytes;
  coming_.erase(found);
}

}  // namespace voyager
