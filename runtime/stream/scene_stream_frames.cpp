// What a frame does: it says where it looks, and links what has come.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "runtime/stream/scene_stream.h"

namespace voyager {
namespace {

constexpr float kStartTarget = 1e-3f;  // τ* where no frame has told: a pixel of a fine display

}  // namespace

void SceneStream::look(const void* who, std::vector<Viewer> viewers) {
  {
    const std::lock_guard small(small_mutex_);
    const auto found = lookers_.find(who);
    if (found == lookers_.end() ? viewers.empty() : found->second.viewers == viewers) return;
    told_ = told_ || found == lookers_.end() || viewers.empty();  // for all that look
    if (viewers.empty())
      lookers_.erase(found);
    else
      lookers_[who].viewers = std::move(viewers);
    look_again_ = true;
  }
  signal();
}

void SceneStream::tell_shown(const void* who, const ShownChunks& shown) {
  {
    const std::lock_guard small(small_mutex_);
    const auto found = lookers_.find(who);
    if (found == lookers_.end() || found->second.shown == shown) return;
    found->second.shown = shown;
    told_ = true;
  }
  signal();
}

std::unique_lock<std::shared_mutex> SceneStream::hold_alone() const {
  const std::lock_guard door(door_);
  return std::unique_lock(pool_mutex_);
}

std::shared_lock<std::shared_mutex> SceneStream::hold() const {
  std::shared_lock<std::shared_mutex> lock;
  {
    const std::lock_guard door(door_);
    lock = std::shared_lock(pool_mutex_);
  }
  if (unsound_) std::rethrow_exception(unsound_);
  return lock;
}

// Where views draw by turns there is always one that holds the pool.
void SceneStream::commit() {
  constexpr double kPutOff = 0.1;  // seconds
  between_frames_ = 0;
  if (!commit_due_) return;
  std::unique_lock pool(pool_mutex_, std::try_to_lock);
  if (!pool.owns_lock()) {
    const double since = put_off_;
    if (since < 0) put_off_ = now();
    if (since < 0 || now() < since + kPutOff) return;
    pool = hold_alone();
  }
  commit_if_free();
}

// So that a frame finds few chunks to link, while many come. Each time without a frame it takes
// twice as many: a view that draws seldom can follow few changes.
void SceneStream::commit_between_frames() {
  constexpr size_t kEnough = 32;
  constexpr unsigned kMostDoublings = 16;
  if (filled_count_ < kEnough << std::min(between_frames_.load(), kMostDoublings)) return;
  const std::unique_lock pool(pool_mutex_, std::try_to_lock);
  if (!pool.owns_lock()) return;
  ++between_frames_;
  commit_if_free();
}

// The pool is held alone.
void SceneStream::commit_if_free() {
  const Lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock() || lost_) return;
  try {
    commit_all();
  } catch (...) {
    lose(std::current_exception());
  }
}

void SceneStream::apply(const LinkPatch& patch) {
  try {
    pool_.apply(patch);
  } catch (...) {
    unsound_ = std::current_exception();
    lose(unsound_);
    throw;
  }
}

// What it throws leaves the pool as it is, and what is known of it, or unsound.
void SceneStream::commit_all() {
  commit_changes();
  // What has come may be the last that leftovers waited for. Another patch, since what that links
  // they may unlink.
  if (residency_.has_leftovers()) commit_changes();
}

void SceneStream::commit_changes() {
  LinkPatch patch;
  const bool lacked = linker_.lacks_room_for_cut();
  moved_pages_.clear();
  put_off_ = -1;
  commit_due_ = false;
  filled_count_ = 0;
  const std::vector<Residency::Evicted> evicted = residency_.evict();
  for (const Residency::Evicted& e : evicted) {
    linker_.evict(e.chunk, patch);
    const ChunkEntry& chunk = file_->chunks()[e.chunk];
    if (pages_) pages_->release(chunk.first_subtree, chunk.subtree_count, version_ + 1);
  }
  const Residency::Arrivals arrived =
      residency_.arrive([&](uint32_t chunk) { return accept(chunk, patch); });
  linker_.link_refused(patch);
  if (!lacked && linker_.lacks_room_for_cut()) look_again();
  for (const uint32_t chunk : arrived.resident) {
    coming_.erase(chunk);
    failures_.remove(chunk);
  }
  for (const uint32_t chunk : arrived.given_up) coming_.erase(chunk);
  if (pages_) patch.pages = pages_->changes(std::exchange(moved_pages_, {}));
  if (!patch.empty()) {
    changes_.push_back(change_of(patch));
    apply(patch);
    ++version_;
    if (changes_.size() > kChangesKept) changes_.pop_front();
  }
  for (const Residency::Evicted& e : evicted) residency_.free(e);
  forget_shown(evicted);
  departures_ += std::any_of(evicted.begin(), evicted.end(), [&](const Residency::Evicted& e) {
    return residency_.is_seen(e.chunk);
  });
  if (evicted.empty() && arrived.resident.empty() && arrived.given_up.empty()) return;
  publish();
  signal();
}

// That which the next version will be.
std::shared_ptr<const StreamChange> SceneStream::change_of(const LinkPatch& patch) const {
  auto change = std::make_shared<StreamChange>();
  change->version = version_ + 1;
  change->unlinked = patch.unlinked;
  change->changed = patch.cut.changed;
  change->changed.insert(change->changed.end(), patch.tied.changed.begin(),
                         patch.tied.changed.end());
  return change;
}

bool SceneStream::accept(uint32_t chunk, LinkPatch& patch) {
  StagedChunk& staged = coming_.at(chunk).chunk;
  try {
    linker_.check(staged, pool_, file_->name());
  } catch (const Error& error) {
    add_failure(chunk, error);
    return false;
  }
  if (pages_) place_subtrees(file_->chunks()[chunk]);
  linker_.arrive(std::move(staged), patch);
  learn_families(chunk);
  return true;
}

void SceneStream::place_subtrees(const ChunkEntry& chunk) {
  bool follows = false;
  try {
    follows = pages_->take(chunk.first_subtree, chunk.subtree_count, version_ + 1, moved_pages_);
  } catch (const Error&) {
    lose(std::current_exception());
    throw;
  }
  if (follows) return;
  // Searches start from nothing.
  changes_.clear();
  version_ += kChangesKept;
}

void SceneStream::learn_families(uint32_t chunk) {
  linker_.each_below(chunk, [&](const NodeBelow& node) {
    if (residency_.set_family(graph_.with_family(chunk, node.first_child, node.child_count)))
      look_again();
  });
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
  const ResidencyNeed& need = residency_.need();
  const PoolRoom room = residency_.room();
  const uint64_t seen = need.seen - need.seen_failed.size();
  const bool fits = seen + residency_.pinned() <= room.slots &&
                    need.seen_blocks + residency_.pinned_blocks() <= room.blocks;
  if (fits) return;
  const uint64_t blocks = need.seen_blocks + records_.likely_blocks(need.seen_unread_blocks);
  refuse_room(records_.enough(seen, blocks));
}

// Of what is settled: a view's cut has no room for something that is seen. No cut of a scene that
// is all there lacks room.
void SceneStream::check_cut() const {
  if (linker_.refuses([&](uint32_t chunk) { return residency_.is_seen(chunk); }))
    refuse_room(records_.of(graph_.size()));
}

void SceneStream::refuse_room(PoolRoom enough) const {
  const auto megabytes = [&](PoolRoom of) {
    return static_cast<double>(desc_.bytes.of(of, state_count_)) / 1e6;
  };
  char message[160];
  std::snprintf(message, sizeof message,
                ": what the view frustum needs takes %.3f MB, the memory budget has room for "
                "%.3f MB",
                std::ceil(1e3 * megabytes(enough)) / 1e3, megabytes(residency_.room()));
  throw Error(ErrorCode::over_budget, file_->name() + message);
}

bool SceneStream::is_settled(double since) const {
  if (failures_.source_is_down() && !failures_.source_may_be_read(now())) return true;
  const auto hopeless = [&](uint32_t chunk) { return failures_.is_hopeless(chunk, since); };
  const std::vector<uint32_t>& failed = residency_.need().seen_failed;
  return residency_.settled(hopeless) && std::all_of(failed.begin(), failed.end(), hopeless);
}

// Of what is settled.
void SceneStream::check_seen() const {
  const ResidencyNeed& need = residency_.need();
  if (!need.seen_failed.empty()) failures_.rethrow(need.seen_failed.front());
  if (need.seen_missing != 0 && failures_.source_is_down()) failures_.rethrow_source();
}

bool SceneStream::plan_is_asked() {
  const std::lock_guard small(small_mutex_);
  return look_again_;
}

// One turn; whether it is done. Both locks are held meanwhile. Only the first turn that can plans
// at once: a plan after every arrival would keep those that read from reading.
template <class Done>
bool SceneStream::work_once(const Done& done, bool& first, bool& stepped) {
  const auto pool = hold_alone();
  Lock lock(mutex_);
  if (lost_) {
    filled_.wait(lock, [&] { return filling_ == 0; });
    rebuild();
    if (lost_) std::rethrow_exception(lost_);
  }
  try {
    if (first) next_plan_ = {};
    first = planning_;  // what is being planned may not know of this call
    stepped = plan_if_asked(nullptr);
    commit_all();
    publish();
    if (!plan_is_asked() && !planning_ && done()) return true;
  } catch (const Error&) {
    throw;
  } catch (...) {
    lose(std::current_exception());
    throw;
  }
  if (desc_.readers == 0) stepped = step(lock);
  return false;
}

template <class Done>
void SceneStream::work_until(const Done& done) {
  for (bool first = true;;) {
    uint64_t seen = 0;
    {
      const std::lock_guard small(small_mutex_);
      if (abandoned_)
        throw Error(
            ErrorCode::scene_closed,
            file_->name() + ": found that the scene was closed while a frame waited for it");
      seen = signals_;
    }
    bool stepped = false;
    if (work_once(done, first, stepped)) return;
    if (stepped || desc_.readers == 0) continue;
    std::unique_lock small(small_mutex_);
    progress_.wait_for(small, std::chrono::milliseconds(100),
                       [&] { return signals_ != seen || abandoned_; });
  }
}

uint64_t SceneStream::wait(bool stand_in) {
  const double since = now();
  uint64_t departures = 0;
  work_until([&] {
    check_fits();
    if (!is_settled(since)) return false;
    if (!stand_in) check_seen(), check_cut();
    departures = departures_;
    return true;
  });
  return departures;
}

void SceneStream::read_around(const Vec3f& centre, uint64_t bytes) {
  constexpr double kPatience = 1;  // seconds
  look(this, {{{centre, kStartTarget}, {}, false}});
  const auto& chunks = file_->chunks();
  const uint64_t stored = chunks.back().offset + chunks.back().bytes - chunks.front().offset;
  const uint64_t enough = counters().chunks.arrived + bytes * chunks.size() / stored;
  const double begin = now();
  work_until([&] {
    return is_settled(begin) || residency_.counters().arrived >= enough ||
           now() >= begin + kPatience;
  });
  look(this, {});
}

}  // namespace voyager
