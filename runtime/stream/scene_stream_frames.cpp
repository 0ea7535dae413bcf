// What a frame does: it says where it looks, holds the pool, and may wait.
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
    const bool comes = found == lookers_.end();
    told_ = told_ || comes || viewers.empty();  // for all that look
    if (viewers.empty())
      lookers_.erase(found);
    else
      lookers_[who].viewers = std::move(viewers);
    asked_ = std::max(asked_, comes ? PlanAsked::at_once : PlanAsked::soon);
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

// Of what is settled: a view's cut has no room for something that is seen. However large the budget
// is, a file that says it has fewer leaves than it has is refused.
void SceneStream::check_cut() const {
  if (linker_.refuses([&](uint32_t chunk) { return residency_.is_seen(chunk); }))
    refuse_room(records_.of(graph_.size()));
}

void SceneStream::refuse_room(PoolRoom enough) const {
  const auto megabytes = [&](PoolRoom of) {
    return static_cast<double>(desc_.bytes.of(of, state_count_)) / 1e6;
  };
  char message[192];
  std::snprintf(
      message, sizeof message,
      ": found room for %.3f MB in the memory budget, expected %.3f MB, which is enough for "
      "what the view frustum needs",
      megabytes(residency_.room()), std::ceil(1e3 * megabytes(enough)) / 1e3);
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
  return asked_ != PlanAsked::no;
}

// One turn; whether it is done. Both locks are held meanwhile, but for mutex_ while chunks are
// linked. Only the first turn that can plans at once: a plan after every arrival would keep those
// that read from reading.
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
    if (first) next_plan_ = next_plan_in_time_ = {};
    first = planning_;  // what is being planned may not know of this call
    stepped = plan_if_asked(nullptr);
    if (stepped) signal();  // to read what it asks for
    commit_all(kAllChunks, &lock);
    publish();
    if (!lost_ && !plan_is_asked() && !planning_ && done()) return true;
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
void SceneStream::work_until(const Done& done, double deadline) {
  struct Waits {
    explicit Waits(std::atomic<unsigned>& count) : count_(count) { ++count_; }
    ~Waits() { --count_; }
    std::atomic<unsigned>& count_;
  } const waits(waits_);
  for (bool first = true; now() < deadline;) {
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
    progress_.wait_for(small, std::chrono::duration<double>(std::min(0.1, deadline - now())),
                       [&] { return signals_ != seen || abandoned_; });
  }
}

uint64_t SceneStream::wait(bool stand_in) {
  const double since = now();
  uint64_t departures = 0;
  const auto settled = [&] {
    check_fits();
    if (!is_settled(since)) return false;
    if (!stand_in) check_seen(), check_cut();
    departures = departures_;
    return true;
  };
  work_until(settled, INFINITY);
  return departures;
}

void SceneStream::read_around(const Vec3f& centre, uint64_t bytes) {
  constexpr double kPatience = 1;  // seconds
  look(this, {{{centre, kStartTarget}, {}, false}});
  const auto& chunks = file_->chunks();
  const uint64_t stored = chunks.back().offset + chunks.back().bytes - chunks.front().offset;
  const uint64_t enough = counters().chunks.arrived + bytes * chunks.size() / stored;
  const double begin = now();
  const auto is_enough = [&] {
    return is_settled(begin) || residency_.counters().arrived >= enough;
  };
  work_until(is_enough, begin + kPatience);
  look(this, {});
}

}  // namespace voyager
