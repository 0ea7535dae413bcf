// How a stream begins, has other room, and ends; and what it tells.
#include "runtime/stream/scene_stream.h"

#include <algorithm>
#include <chrono>

#include "runtime/base/first_that.h"

namespace voyager {
namespace {

// What every view has at once, wherever it looks.
constexpr uint32_t kPinnedShare = 8;  // of the slots, one in so many
// Where reads wait for answers (pace_reads()).
constexpr unsigned kReadsAtFirst = 4;
constexpr uint32_t kMostPinned = 1024;

ResidencyCounters total(const ResidencyCounters& a, const ResidencyCounters& b) {
  return {a.requested + b.requested, a.arrived + b.arrived, a.evicted + b.evicted, a.late + b.late,
          a.flushed + b.flushed};
}

StreamDesc with_records_and_graph(StreamDesc desc, const SceneFile& file) {
  if (!desc.records) desc.records.emplace(file);
  if (!desc.graph) desc.graph = std::make_shared<const ChunkGraph>(file.chunks(), file.tiers());
  return desc;
}

}  // namespace

SlotShape SceneStream::slot_shape(const SceneFile& file) {
  const ChunkDirectory::Totals& all = file.chunks().totals();
  return {all.most_nodes, all.most_records};
}

uint32_t SceneStream::top_chunks(const SceneFile& file) {
  const auto& chunks = file.chunks();
  if (chunks.empty()) return 0;
  const uint32_t end = file.tiers().tier_begin[1];
  return first_that(0u, static_cast<uint32_t>(chunks.size()),
                    [&](uint32_t chunk) { return chunks.first_subtree(chunk) >= end; });
}

uint32_t SceneStream::pinned_chunks(const SceneFile& file, uint32_t slots) {
  return std::max(top_chunks(file), std::min(kMostPinned, slots / kPinnedShare));
}

SceneStream::SceneStream(std::shared_ptr<const SceneFile> file, const StreamDesc& desc,
                         ChunkPool& pool)
    : file_(std::move(file)),
      desc_(with_records_and_graph(desc, *file_)),
      tiers_(file_->tiers()),
      graph_(*desc_.graph),
      shape_(slot_shape(*file_)),
      records_(*desc_.records),
      pool_(pool),
      budget_(desc.budget),
      room_(desc.room),
      room_pinned_(desc.pinned),
      bytes_(desc.bytes.of(desc.room)),
      looks_(file_->chunks()),
      team_(std::min(desc.readers + 1, kMostThatLink)),
      residency_(graph_, file_->chunks(), records_, desc.room, desc.pinned),
      linker_(graph_, shape_, residency_.next_blocks()),
      pages_(no_pages(desc.room)) {
  linker_.make_room(desc.room, desc.bytes.list.nodes(desc.room));
  // Where reads wait for answers, one reader is left for plans.
  const unsigned at_once = file_->source().reads_at_once();
  if (at_once <= 1) return;
  most_reads_ = std::clamp(std::max(desc_.readers, 2u) - 1, 1u, at_once);
  reads_allowed_ = std::min(most_reads_, kReadsAtFirst);
}

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
  const bool plans = asked_ != PlanAsked::no && !planning_;  // whoever plans wakes the others
  if (!plans && !told_) return wait;
  const TimePoint due = told_ ? next_plan_ : TimePoint::max();
  const auto rest = (plans ? std::min(due, next_plan()) : due) - std::chrono::steady_clock::now();
  constexpr double kLinking = 1e-3;  // it takes one or two, and then wakes nobody
  const double plan =
      std::max(linking_ ? kLinking : 0.0, std::chrono::duration<double>(rest).count());
  return wait < 0 ? plan : std::min(wait, plan);
}

void SceneStream::signal() {
  wake_threads();
  progress_.notify_all();
}

void SceneStream::wake_threads() {
  {
    const std::lock_guard lock(small_mutex_);
    ++signals_;
  }
  wake_.notify_all();
}

// None has a place yet.
std::optional<SubtreePages> SceneStream::no_pages(PoolRoom room) const {
  if (desc_.bytes.pool.page == 0) return std::nullopt;
  return SubtreePages(file_->info().subtree_count, room.pages, kChangesKept);
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
  workers.for_blocks(count, kMostAtOnce, [&](size_t begin, size_t end) {
    std::vector<StagedChunk*> sound;
    for (auto chunk = static_cast<uint32_t>(begin); chunk < end; ++chunk) {
      const auto bytes =
          stored.subspan(chunks[chunk].offset - chunks[0].offset, chunks[chunk].bytes);
      StagedChunk& staged = coming[chunk]->chunk;
      try {
        staged = decode(chunk, bytes);
        const std::lock_guard lock(placing);
        if (!residency_.place_records(chunk, staged.record_blocks()))
          refuse_records(staged, file_->name());
        staged.put(residency_.slot(chunk), residency_.blocks(chunk));
      } catch (const Error& error) {
        if (error.code() != ErrorCode::damaged_chunk || chunk < residency_.pinned()) throw;
        damage[chunk] = error;
        continue;
      }
      sound.push_back(&staged);
    }
    if (!sound.empty()) pool_.fill(sound);
    for (StagedChunk* staged : sound) staged->drop_content();
  });
  for (uint32_t chunk = 0; chunk < count; ++chunk)
    if (damage[chunk])
      fail(chunk, *damage[chunk]);
    else
      residency_.filled(chunk);
  commit_all(kAllChunks, nullptr);
  for (uint32_t chunk = 0; chunk < residency_.pinned(); ++chunk)
    if (!residency_.is_resident(chunk)) failures_.rethrow(chunk);
}

// To so much room and so many states.
template <class Change>
void SceneStream::change_bytes(PoolRoom room, size_t states, const Change& change) {
  const uint64_t before = bytes_, after = desc_.bytes.of(room, states);
  const auto count = [&](uint64_t bytes) {
    if (desc_.count) desc_.count(bytes);
  };
  if (after > before) count(after);
  try {
    change();
  } catch (...) {
    if (after > before) count(before);
    throw;
  }
  if (after < before) count(after);
  state_count_ = states;
  bytes_ = after;
}

void SceneStream::set_budget(uint64_t budget, Workers& workers) {
  const std::lock_guard sharing(sharing_);
  const PoolRoom room = fit_room(*file_, records_, desc_.bytes, budget, states_.size());
  change_bytes(room, states_.size(),
               [&] { change_room(room, pinned_chunks(*file_, room.slots), workers); });
  budget_ = budget;
}

void SceneStream::resize(PoolRoom room, uint32_t pinned, Workers& workers) {
  const std::lock_guard sharing(sharing_);
  change_bytes(room, states_.size(), [&] { change_room(room, pinned, workers); });
}

void SceneStream::add_state(PoolReaderState& state, Workers& workers) {
  const std::lock_guard sharing(sharing_);
  const size_t states = states_.size() + 1;
  states_.reserve(states);
  const auto add_within = [&](uint64_t budget) {
    const bool fits = budget == 0 || desc_.bytes.of(room_, states) <= budget;
    const PoolRoom room = fits ? room_ : fit_room(*file_, records_, desc_.bytes, budget, states);
    change_bytes(room, states, [&] {
      if (!fits) change_room(room, pinned_chunks(*file_, room.slots), workers);
      states_.push_back(&state);
    });
  };
  try {
    add_within(budget_);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::over_budget) throw;
    add_within(bytes_);  // other scenes may have taken what the budget had left
  }
}

// To count less throws nothing.
void SceneStream::remove_state(PoolReaderState& state) noexcept {
  const std::lock_guard sharing(sharing_);
  state.drop();
  std::erase(states_, &state);
  change_bytes(room_, states_.size(), [] {});
}

void SceneStream::change_room(PoolRoom room, uint32_t pinned, Workers& workers) {
  const auto pool = hold_alone();
  pool_.await_frames();  // before `mutex_`, which others want
  Lock lock(mutex_);
  filled_.wait(lock, [&] { return filling_ == 0; });
  for (PoolReaderState* state : states_) state->drop();
  try {
    reset(room, pinned, workers);
  } catch (...) {
    try {
      reset(room_, room_pinned_, workers);
    } catch (...) {
      if (unsound_) unsound_ = std::current_exception();
      lose(std::current_exception());
    }
    throw;
  }
  room_ = room;
  room_pinned_ = residency_.pinned();
}

// All anew, with what is pinned in it. Where it throws, the pool is as it was, or unsound.
void SceneStream::reset(PoolRoom room, uint32_t pinned, Workers& workers) {
  pool_.await_frames();
  Residency residency(graph_, file_->chunks(), records_, room, std::min(pinned, desc_.pinned));
  Linker linker(graph_, shape_, residency_.next_blocks());
  std::optional<SubtreePages> pages = no_pages(room);
  unsound_ = std::make_exception_ptr(Error(
      ErrorCode::internal,
      file_->name() + ": found memory that was only partly filled again, expected all of it"));
  linker_ = std::move(linker);
  pool_.resize(room);
  linker_.make_room(room, desc_.bytes.list.nodes(room));
  ++generation_;
  ++departures_;
  counted_ = total(counted_, residency_.counters());
  residency_ = std::move(residency);
  pages_.reset();
  if (pages) pages_.emplace(std::move(*pages));
  coming_.clear();
  ready_.clear();
  failures_.forget_chunks();
  staged_bytes_ = 0;
  lost_ = nullptr;
  // No search can go on from what it has.
  changes_.clear();
  version_ += kChangesKept;
  forget_shown();
  ask_for_plan(PlanAsked::in_time);
  put_first(residency_.pinned(), top_, workers);
  unsound_ = nullptr;
  signal();
}

// They are of slots that hold others now.
void SceneStream::forget_shown() {
  const std::lock_guard small(small_mutex_);
  for (auto& [who, of] : lookers_) of.shown.clear();
}

void SceneStream::forget_shown(const std::vector<Residency::Evicted>& evicted) {
  if (evicted.empty()) return;
  const std::lock_guard small(small_mutex_);
  for (auto& [who, of] : lookers_)
    for (const Residency::Evicted& e : evicted)
      if (e.slot < of.shown.size()) of.shown[e.slot] = Shown::unknown;
}

// From within a catch, or with what one has caught.
void SceneStream::lose(std::exception_ptr what) noexcept {
  constexpr double kRest = 1;  // second: memory may be had again
  lost_ = std::move(what);
  rebuild_due_ = now() + kRest;
  signal();  // whoever rebuilds may be asleep
}

// Both locks are held. As much room as is counted, and nothing in it but the top: other room that
// was to be had may have come half of the way.
void SceneStream::rebuild() {
  try {
    Workers workers(1);
    reset(room_, room_pinned_, workers);
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

void SceneStream::publish() {
  StreamCounters now;
  now.chunks = total(counted_, residency_.counters());
  now.slots = residency_.slots();
  now.reads = reads_;
  now.bytes_read = bytes_read_;
  now.failures = failures_.count();
  now.resident = residency_.resident();
  now.need = residency_.need();
  shown_wanted_ = residency_.wants_shown();
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
