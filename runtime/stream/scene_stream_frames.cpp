// What a frame does: it says where it looks, and links what has come.
#include <algorithm>
#include <cstdio>

#include "runtime/stream/scene_stream.h"

namespace voyager {
namespace {

constexpr float kStartTarget = 1e-3f;  // τ* where no frame has told: a pixel of a fine display

}  // namespace

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

std::shared_lock<std::shared_mutex> SceneStream::hold() const {
  std::shared_lock lock(pool_mutex_);
  if (unsound_) std::rethrow_exception(unsound_);
  return lock;
}

void SceneStream::apply(const LinkPatch& patch) {
  try {
    pool_.apply(patch);
  } catch (...) {
    unsound_ = std::current_exception();
    throw;
  }
}

void SceneStream::commit_all() {
  if (unsound_) std::rethrow_exception(unsound_);
  LinkPatch patch;
  const std::vector<Residency::Evicted> evicted = residency_.evict();
  for (const Residency::Evicted& e : evicted) linker_.evict(e.chunk, patch);
  const Residency::Arrivals arrived =
      residency_.arrive([&](uint32_t chunk) { return accept(chunk, patch); });
  for (const uint32_t chunk : arrived.resident) coming_.erase(chunk);
  for (const uint32_t chunk : arrived.given_up) coming_.erase(chunk);
  if (!patch.empty()) {
    apply(patch);
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
  if (evicted.empty() && arrived.resident.empty() && arrived.given_up.empty()) return;
  publish();
  signal();
}

bool SceneStream::accept(uint32_t chunk, LinkPatch& patch) {
  StagedChunk& staged = coming_.at(chunk).chunk;
  try {
    linker_.check(staged, file_->name());
  } catch (const Error& error) {
    add_failure(chunk, error);
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

template <class Done>
void SceneStream::work_until(const Done& done) {
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
      next_plan_ = {};
      stepped = plan_if_asked();
      commit_all();
      publish();
      if (done()) return;
      if (desc_.readers == 0) stepped = step(lock);
    }
    if (stepped || desc_.readers == 0) continue;
    std::unique_lock small(small_mutex_);
    progress_.wait_for(small, std::chrono::milliseconds(100), [&] { return signals_ != seen; });
  }
}

void SceneStream::wait(bool stand_in) {
  work_until([&] {
    check_fits();
    if (!is_settled()) return false;
    const std::vector<uint32_t> failed = residency_.need().seen_failed;
    if (!failed.empty() && !stand_in) failures_.rethrow(failed.front());
    return true;
  });
}

void SceneStream::read_around(const Vec3f& centre, uint64_t bytes) {
  look(this, {{{centre, kStartTarget}, {}, false}});
  const auto& chunks = file_->chunks();
  const uint64_t stored = chunks.back().offset + chunks.back().bytes - chunks.front().offset;
  const uint64_t enough = counters().chunks.arrived + bytes * chunks.size() / stored;
  work_until([&] { return residency_.settled() || residency_.counters().arrived >= enough; });
  look(this, {});
}

}  // namespace voyager
