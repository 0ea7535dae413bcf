// The threads: what they plan, read, decode and fill; and how all begins.
#include "runtime/stream/scene_stream.h"

#include <algorithm>
#include <chrono>

#include "runtime/base/floating_point_mode.h"

namespace voyager {
namespace {

constexpr uint32_t kMostChunksARead = 64;
constexpr int kPlanRest = 3;  // after a plan, times what it took
// What every view has at once, wherever it looks.
constexpr uint32_t kPinnedShare = 8;  // of the slots, one in so many
constexpr uint32_t kMostPinned = 1024;

ResidencyCounters total(const ResidencyCounters& a, const ResidencyCounters& b) {
  return {a.requested + b.requested, a.arrived + b.arrived, a.evicted + b.evicted, a.late + b.late,
          a.flushed + b.flushed};
}

uint32_t blocks_of(const StagedChunk& staged) {
  return record_blocks(static_cast<uint32_t>(staged.records.size()));
}

[[noreturn]] void refuse_records(const StagedChunk& staged, const std::string& file) {
  throw Error(ErrorCode::damaged_chunk,
              file + ": chunk " + std::to_string(staged.links.chunk) + ": found " +
                  std::to_string(staged.records.size()) +
                  " nodes with children, expected no more than the header and places allow");
}

// Chunk by chunk it would fail as well: a source that stalls, and a file that is gone.
bool is_of_source(const Error& error) {
  return error.code() == ErrorCode::io_transient || error.code() == ErrorCode::file_not_found;
}

}  // namespace

SlotShape SceneStream::slot_shape(const SceneFile& file) {
  SlotShape shape{0, 0};
  for (const ChunkEntry& entry : file.chunks())
    shape = {std::max(shape.nodes, entry.node_count), std::max(shape.records, entry.record_count)};
  return shape;
}

uint32_t SceneStream::top_chunks(const SceneFile& file) {
  const auto& chunks = file.chunks();
  if (chunks.empty()) return 0;
  const uint32_t end = file.tiers().tier_begin[1];
  return static_cast<uint32_t>(
      std::partition_point(chunks.begin(), chunks.end(),
                           [&](const ChunkEntry& entry) { return entry.first_subtree < end; }) -
      chunks.begin());
}

uint32_t SceneStream::pinned_chunks(const SceneFile& file, uint32_t slots) {
  return std::max(top_chunks(file), std::min(kMostPinned, slots / kPinnedShare));
}

SceneStream::SceneStream(std::shared_ptr<const SceneFile> file, const StreamDesc& desc,
                         ChunkPool& pool)
    : file_(std::move(file)),
      desc_(desc),
      tiers_(file_->tiers()),
      graph_(file_->chunks(), tiers_),
      shape_(slot_shape(*file_)),
      records_(*file_),
      pool_(pool),
      pool_bytes_(desc.bytes.of(desc.room)),
      residency_(graph_, file_->chunks(), records_, desc.room, desc.pinned),
      linker_(graph_, shape_) {}

SceneStream::~SceneStream() {
  stop();
}

void SceneStream::stop() {
  {
    const std::lock_guard lock(small_mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  file_->source().cancel();  // a read may wait for a server
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void SceneStream::abandon() noexcept {
  {
    const std::lock_guard lock(small_mutex_);
    abandoned_ = true;
  }
  progress_.notify_all();
  file_->source().cancel();
}

double SceneStream::now() const {
  if (desc_.clock) return desc_.clock();
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Seconds until there may be something to do that no one tells of; negative: never.
double SceneStream::next_due() const {
  if (lost_) return std::max(0.0, rebuild_due_ - now());
  double wait = failures_.next_due(now());
  const std::lock_guard small(small_mutex_);
  if (!look_again_) return wait;
  const auto rest = next_plan_ - std::chrono::steady_clock::now();
  const double plan = std::max(0.0, std::chrono::duration<double>(rest).count());
  return wait < 0 ? plan : std::min(wait, plan);
}

void SceneStream::signal() {
  {
    const std::lock_guard lock(small_mutex_);
    ++signals_;
  }
  wake_.notify_all();
  progress_.notify_all();
}

void SceneStream::read_top(Workers& workers) {
  file_->source().expect(Access::uncached);  // the pool is the cache
  const std::vector<std::byte> stored = file_->read_stored(0, desc_.first);
  const ChunkEntry& last = file_->chunks()[desc_.pinned - 1];
  const auto pinned_bytes =
      static_cast<std::ptrdiff_t>(last.offset + last.bytes - file_->chunks()[0].offset);
  top_.assign(stored.begin(), stored.begin() + pinned_bytes);
  {
    const auto pool = hold_alone();
    const Lock lock(mutex_);
    ++reads_;
    bytes_read_ += stored.size();
    put_first(desc_.first, stored, workers);
  }
  for (unsigned i = 0; i < desc_.readers; ++i) threads_.emplace_back([this] { run(); });
}

// The first chunks, at once: before any frame, and from memory where what was there is lost,
// since a scene without its top would have to wait for it. One that is damaged has failed, but
// for what is pinned.
void SceneStream::put_first(uint32_t count, std::span<const std::byte> stored, Workers& workers) {
  const auto& chunks = file_->chunks();
  std::vector<Coming*> coming(count);
  for (uint32_t chunk = 0; chunk < count; ++chunk) {
    residency_.place(chunk);
    coming[chunk] = &coming_[chunk];
  }
  std::vector<std::optional<Error>> damage(count);
  std::mutex placing;
  workers.for_blocks(count, 16, [&](size_t begin, size_t end) {
    for (auto chunk = static_cast<uint32_t>(begin); chunk < end; ++chunk) {
      const auto bytes =
          stored.subspan(chunks[chunk].offset - chunks[0].offset, chunks[chunk].bytes);
      StagedChunk& staged = coming[chunk]->chunk;
      try {
        staged = decode(chunk, bytes);
        const std::lock_guard lock(placing);
        if (!residency_.place_records(chunk, blocks_of(staged)))
          refuse_records(staged, file_->name());
        staged.links.blocks = residency_.blocks(chunk);
      } catch (const Error& error) {
        if (error.code() != ErrorCode::damaged_chunk || chunk < residency_.pinned()) throw;
        damage[chunk] = error;
        continue;
      }
      staged.links.slot = residency_.slot(chunk);
      pool_.fill(staged.links.slot, staged);
      staged.content = {};
      staged.records = {};
    }
  });
  for (uint32_t chunk = 0; chunk < count; ++chunk)
    if (damage[chunk])
      fail(chunk, *damage[chunk]);
    else
      residency_.filled(chunk);
  commit_all();
  for (uint32_t chunk = 0; chunk < residency_.pinned(); ++chunk)
    if (!residency_.is_resident(chunk)) failures_.rethrow(chunk);
}

void SceneStream::resize(PoolRoom room, uint32_t pinned, Workers& workers) {
  const auto pool = hold_alone();
  pool_.await_frames();
  Lock lock(mutex_);
  filled_.wait(lock, [&] { return filling_ == 0; });
  const PoolRoom room_before = residency_.room();
  const uint32_t pinned_before = residency_.pinned();
  try {
    reset(room, pinned, workers);
  } catch (...) {
    try {
      reset(room_before, pinned_before, workers);
    } catch (...) {
      if (unsound_) unsound_ = std::current_exception();
      lose(std::current_exception());
    }
    throw;
  }
}

// All anew, with what is pinned in it. Where it throws, the pool is as it was, or unsound.
void SceneStream::reset(PoolRoom room, uint32_t pinned, Workers& workers) {
  Residency residency(graph_, file_->chunks(), records_, room, std::min(pinned, desc_.pinned));
  Linker linker(graph_, shape_);
  unsound_ = std::make_exception_ptr(Error(
      ErrorCode::internal,
      file_->name() + ": found memory that was only partly filled again, expected all of it"));
  pool_.resize(room);
  ++generation_;
  counted_ = total(counted_, residency_.counters());
  residency_ = std::move(residency);
  linker_ = std::move(linker);
  coming_.clear();
  ready_.clear();
  failures_.forget_chunks();
  staged_bytes_ = 0;
  pool_bytes_ = desc_.bytes.of(room);
  lost_ = nullptr;
  // No search can go on from what it has.
  changes_.clear();
  version_ += kChangesKept;
  look_again();
  put_first(residency_.pinned(), top_, workers);
  unsound_ = nullptr;
  signal();
}

// From within a catch, or with what one has caught.
void SceneStream::lose(std::exception_ptr what) noexcept {
  constexpr double kRest = 1;  // second: memory may be had again
  lost_ = std::move(what);
  rebuild_due_ = now() + kRest;
  signal();  // whoever rebuilds may be asleep
}

// Both locks are held. As much room as before, and nothing in them but the top.
void SceneStream::rebuild() {
  try {
    Workers workers(1);
    reset(residency_.room(), residency_.pinned(), workers);
  } catch (...) {
    if (unsound_) unsound_ = std::current_exception();
    lose(std::current_exception());
    return;
  }
  try {
    failures_.tell(file_->name() +
                   ": found no memory for chunks that were read; they are dropped and read again");
  } catch (const std::bad_alloc&) {  // all is well, but untold
  }
}

bool SceneStream::rebuild_if_due(Lock& lock) {
  if (now() < rebuild_due_) return false;
  lock.unlock();  // the pool comes first
  {
    const auto pool = hold_alone();
    lock.lock();
    filled_.wait(lock, [&] { return filling_ == 0; });
    if (lost_) rebuild();
  }
  return !lost_;
}

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
  if (blocks_of(staged) > records_.most_blocks(chunk)) refuse_records(staged, file_->name());
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
  const bool wanted = residency_.read(chunk, blocks_of(staged));
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

void SceneStream::publish() {
  StreamCounters now;
  now.chunks = total(counted_, residency_.counters());
  now.slots = residency_.slots();
  now.reads = reads_;
  now.bytes_read = bytes_read_;
  now.failures = failures_.count();
  now.resident = residency_.resident();
  now.need = residency_.need();
  std::vector<std::string> messages = failures_.take_messages();
  const std::lock_guard small(small_mutex_);
  published_ = std::move(now);
  messages_.insert(messages_.end(), messages.begin(), messages.end());
}

StreamCounters SceneStream::counters() const {
  const std::lock_guard small(small_mutex_);
  return published_;
}

std::vector<std::string> SceneStream::take_messages() {
  const std::lock_guard small(small_mutex_);
  return std::exchange(messages_, {});
}

}  // namespace voyager
