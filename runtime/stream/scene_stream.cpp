#include "runtime/stream/scene_stream.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <new>

#include "runtime/base/floating_point_mode.h"

namespace voyager {
namespace {

constexpr size_t kChangesKept = 64;
constexpr uint32_t kMostChunksARead = 64;

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

SceneStream::SceneStream(std::shared_ptr<const SceneFile> file, const StreamDesc& desc,
                         ChunkPool& pool)
    : file_(std::move(file)),
      desc_(desc),
      tiers_(file_->tiers()),
      graph_(file_->chunks(), tiers_),
      pool_(pool),
      residency_(graph_, file_->chunks(), desc.slots, desc.pinned),
      linker_(graph_, slot_shape(*file_)) {}

SceneStream::~SceneStream() {
  {
    const std::lock_guard lock(small_mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  file_->source().cancel();  // a read may wait for a server
  for (std::thread& thread : threads_) thread.join();
}

double SceneStream::now() const {
  if (desc_.clock) return desc_.clock();
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void SceneStream::signal() {
  {
    const std::lock_guard lock(small_mutex_);
    ++signals_;
  }
  wake_.notify_all();
  progress_.notify_all();
}

// ---------------------------------------------------------------- threads

void SceneStream::read_top() {
  file_->source().expect(Access::uncached);  // the pool is the cache
  {
    const std::unique_lock pool(pool_mutex_);
    Lock lock(mutex_);
    const uint32_t top = top_chunks(*file_);
    for (uint32_t chunk = 0; chunk < top;) {
      if (residency_.is_resident(chunk)) {
        ++chunk;
        continue;
      }
      const bool more = step(lock);
      commit_all();
      if (!more && !residency_.is_resident(chunk)) failures_.rethrow(chunk);
    }
  }
  for (unsigned i = 0; i < desc_.readers; ++i) threads_.emplace_back([this] { run(); });
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
      wait = failures_.next_due(now());
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
  const bool done = plan_if_asked() || retry_due() || fill_one(lock) || read_some(lock);
  if (done) {
    publish();
    signal();
  }
  return done;
}

bool SceneStream::plan_if_asked() {
  std::vector<Viewer> viewers;
  {
    const std::lock_guard small(small_mutex_);
    if (!look_again_) return false;
    look_again_ = false;
    for (const auto& [who, of] : viewers_) viewers.insert(viewers.end(), of.begin(), of.end());
  }
  residency_.plan(viewers);
  return true;
}

bool SceneStream::retry_due() {
  const std::vector<uint32_t> due = failures_.take_due(now());
  for (const uint32_t chunk : due) residency_.retry(chunk);
  if (due.empty()) return false;
  const std::lock_guard small(small_mutex_);
  look_again_ = true;
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

bool SceneStream::read_some(Lock& lock) {
  if (staged_bytes_ >= desc_.staged_bytes) return false;
  const ChunkRange range = residency_.take_requests(kMostChunksARead, desc_.read_bytes);
  if (range.empty()) return false;
  const auto& chunks = file_->chunks();
  lock.unlock();
  std::vector<std::byte> bytes;
  try {
    bytes = file_->read_stored(range.first, range.last);
  } catch (const std::exception&) {
    // Chunk by chunk, to find which of them cannot be had.
  }
  lock.lock();
  ++reads_;
  bytes_read_ += bytes.size();
  for (uint32_t chunk = range.first; chunk < range.last; ++chunk) {
    const uint64_t at = chunks[chunk].offset - chunks[range.first].offset;
    const std::span stored = std::span<const std::byte>(bytes);
    stage(
        chunk,
        [&] {
          return bytes.empty() ? file_->read_chunk(chunk)
                               : file_->decode(chunk, stored.subspan(at, chunks[chunk].bytes));
        },
        lock);
  }
  return true;
}

// The lock is let go while the chunk is decoded.
void SceneStream::stage(uint32_t chunk, const std::function<Chunk()>& decode, Lock& lock) {
  StagedChunk staged;
  std::exception_ptr failure;
  lock.unlock();
  try {
    staged = stage_chunk(decode(), chunk, tiers_, file_->name());
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  if (failure) {
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      fail(chunk, error);
    }
    return;
  }
  failures_.remove(chunk);
  if (!residency_.read(chunk)) return;
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
  failures_.add(chunk, ours != nullptr ? *ours : other, now());
}

void SceneStream::forget(uint32_t chunk) {
  const auto found = coming_.find(chunk);
  if (found == coming_.end()) return;
  staged_bytes_ -= found->second.stored_bytes;
  coming_.erase(found);
}

// ------------------------------------------------------------------ frames

void SceneStream::look(const void* who, std::vector<Viewer> viewers) {
  {
    const std::lock_guard small(small_mutex_);
    const auto found = viewers_.find(who);
    if (found == viewers_.end() ? viewers.empty() : found->second == viewers) return;
    if (viewers.empty())
      viewers_.erase(found);
    else
      viewers_[who] = std::move(viewers);
    look_again_ = true;
  }
  signal();
}

void SceneStream::commit() {
  const std::unique_lock pool(pool_mutex_, std::try_to_lock);
  if (!pool.owns_lock()) return;
  const Lock lock(mutex_, std::try_to_lock);
  if (lock.owns_lock()) commit_all();
}

void SceneStream::commit_all() {
  LinkPatch patch;
  const std::vector<Residency::Evicted> evicted = residency_.evict();
  for (const Residency::Evicted& e : evicted) linker_.evict(e.chunk, patch);
  const std::vector<uint32_t> arrived =
      residency_.arrive([&](uint32_t chunk) { return accept(chunk, patch); });
  for (const uint32_t chunk : arrived) coming_.erase(chunk);
  // Those that nobody wants any more.
  std::erase_if(coming_, [&](const auto& coming) { return !residency_.is_coming(coming.first); });
  if (!patch.empty()) {
    pool_.apply(patch);
    auto change = std::make_shared<StreamChange>();
    change->version = ++version_;
    change->unlinked = std::move(patch.unlinked);
    change->changed = std::move(patch.cut.changed);
    change->changed.insert(change->changed.end(), patch.tied.changed.begin(),
                           patch.tied.changed.end());
    changes_.push_back(std::move(change));
    if (changes_.size() > kChangesKept) changes_.pop_front();
  }
  for (const Residency::Evicted& e : evicted) residency_.free_slot(e.slot);
  if (evicted.empty() && arrived.empty()) return;
  publish();
  signal();
}

bool SceneStream::accept(uint32_t chunk, LinkPatch& patch) {
  StagedChunk& staged = coming_.at(chunk).chunk;
  try {
    linker_.check(staged, file_->name());
  } catch (const Error& error) {
    failures_.add(chunk, error, now());
    return false;
  }
  learn_families(staged.links);
  linker_.arrive(std::move(staged.links), patch);
  return true;
}

void SceneStream::learn_families(const LinkTable& table) {
  for (const NodeBelow& node : table.below) {
    const ChunkRange range = graph_.with_roots(node.first_child, node.child_count);
    for (uint32_t chunk = range.first + 1; chunk < range.last; ++chunk)
      residency_.set_shares_family(chunk, chunk + 1 < range.last);
  }
}

bool SceneStream::changes_since(uint64_t version,
                                std::vector<std::shared_ptr<const StreamChange>>& out) const {
  out.clear();
  if (version == version_) return true;
  if (changes_.empty() || changes_.front()->version > version + 1) return false;
  for (const auto& change : changes_)
    if (change->version > version) out.push_back(change);
  return true;
}

void SceneStream::check_fits() const {
  const uint64_t slots = residency_.need().seen + residency_.pinned();
  if (slots <= residency_.slots()) return;
  const auto megabytes = [&](uint64_t of) {
    return static_cast<double>(of * desc_.slot_bytes + desc_.fixed_bytes) / 1e6;
  };
  char message[160];
  std::snprintf(message, sizeof message,
                ": what the view frustum needs takes %.3f MB, the memory budget has room for "
                "%.3f MB",
                megabytes(slots), megabytes(residency_.slots()));
  throw Error(ErrorCode::over_budget, file_->name() + message);
}

bool SceneStream::is_settled() const {
  const std::vector<uint32_t> failed = residency_.need().seen_failed;
  return residency_.settled() && std::all_of(failed.begin(), failed.end(), [&](uint32_t chunk) {
           return failures_.is_hopeless(chunk);
         });
}

void SceneStream::wait(bool stand_in) {
  for (;;) {
    uint64_t seen = 0;
    {
      const std::lock_guard small(small_mutex_);
      seen = signals_;
    }
    bool stepped = false;
    {
      const std::unique_lock pool(pool_mutex_);
      Lock lock(mutex_);
      stepped = plan_if_asked();
      commit_all();
      publish();
      check_fits();
      if (is_settled()) {
        const std::vector<uint32_t> failed = residency_.need().seen_failed;
        if (!failed.empty() && !stand_in) failures_.rethrow(failed.front());
        return;
      }
      if (desc_.readers == 0) stepped = step(lock);
    }
    if (stepped) continue;
    std::unique_lock small(small_mutex_);
    progress_.wait_for(small, std::chrono::milliseconds(100), [&] { return signals_ != seen; });
  }
}

void SceneStream::publish() {
  StreamCounters now;
  now.chunks = residency_.counters();
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
