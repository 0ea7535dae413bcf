// What has come becomes resident, and what goes makes room: links, which frames follow.
#include <algorithm>
#include <utility>

#include "runtime/stream/scene_stream.h"

namespace voyager {

// What one commit does. It is taken from what is resident and given back to that under mutex_; in
// between it is linked, without that lock.
struct SceneStream::Commit {
  std::vector<Residency::Evicted> evicted;
  std::vector<uint32_t> given_up;
  std::vector<Linker::Arrival> arriving;
  bool lacked_room;  // for what is linked, before

  LinkPatch patch;
  std::vector<uint32_t> moved_pages;
  std::vector<ChunkRange> divided;  // families
};

// Chunks that a frame links at most. That takes a millisecond, or at most a tenth of the seconds
// from one frame to the next.
size_t SceneStream::most_for_frame(double seconds) {
  constexpr double kLinksASecond = 4000;
  return std::max(kFewChunks, static_cast<size_t>(kLinksASecond * std::clamp(seconds, 0.0, 1.0)));
}

// Where views draw by turns there is always one that holds the pool.
void SceneStream::commit() {
  constexpr double kPutOff = 0.1;  // seconds
  between_frames_ = 0;
  const double at = now();
  const size_t most = most_for_frame(at - last_frame_.exchange(at));
  if (!commit_due_) return;
  std::unique_lock pool(pool_mutex_, std::try_to_lock);
  if (!pool.owns_lock()) {
    const double since = put_off_;
    if (since < 0) put_off_ = at;
    if (since < 0 || at < since + kPutOff) return;
    pool = hold_alone();
  }
  Lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) {  // a plan may have it, for which no frame is to wait
    put_off_ = -1;
    return;
  }
  commit_or_lose(most, lock);
}

// After some times without a frame twice as many: a view that draws seldom can follow few changes.
size_t SceneStream::enough_between_frames() const {
  constexpr unsigned kTimes = 8, kMostDoublings = 16;
  return kFewChunks / 2 << std::min(between_frames_ / kTimes, kMostDoublings);
}

// So that a frame finds few chunks to link, while many come, and waits for few. False: frames keep
// it from that.
bool SceneStream::commit_between_frames(Lock& lock) {
  const size_t enough = enough_between_frames();
  // A plan goes first, or it would wait for one commit after another.
  if (lost_ || plan_waits_ || changes_due_ < enough) return true;
  // The pool's lock comes before this one, so it is only tried.
  const std::unique_lock pool(pool_mutex_, std::try_to_lock);
  if (!pool.owns_lock()) return false;
  ++between_frames_;
  // Those that helped the last time help for half of it.
  const size_t few = kFewChunks * std::max((team_.helpers() + 1) / 2, 1u);
  commit_or_lose(std::max(enough, few), lock);
  return true;
}

// The pool is held alone.
void SceneStream::commit_or_lose(size_t most, Lock& lock) {
  if (lost_) return;
  try {
    commit_all(most, &lock);
  } catch (...) {
    lose(std::current_exception());
  }
}

// most: chunks that come, and as many that go. What it throws leaves the pool as it is, and what is
// known of it, or lost. lock: let go while chunks are linked; null where others must not go on.
void SceneStream::commit_all(size_t most, Lock* lock) {
  const size_t done = commit_changes(most, lock);
  // What has come may be the last that leftovers waited for. Another patch, since what that links
  // they may unlink.
  if (done < most && !lost_ && residency_.has_leftovers()) commit_changes(most - done, lock);
}

// How many chunks have come or gone, the greater of both.
size_t SceneStream::commit_changes(size_t most, Lock* lock) {
  Commit commit = begin_commit(most);
  std::exception_ptr failure;
  linking_ = true;
  if (lock != nullptr) lock->unlock();
  try {
    link(commit);
  } catch (...) {
    failure = std::current_exception();
  }
  if (lock != nullptr) lock->lock();
  linking_ = false;
  linked_.notify_all();
  if (failure) {
    lose(failure);
    std::rethrow_exception(failure);
  }
  if (!lost_) end_commit(commit);
  return std::max(commit.evicted.size(), commit.arriving.size());
}

SceneStream::Commit SceneStream::begin_commit(size_t most) {
  Commit commit;
  put_off_ = -1;
  commit.lacked_room = linker_.lacks_room_for_cut();
  commit.evicted = residency_.evict(most);
  Residency::Arrivals arrivals = residency_.begin_arrivals(most);
  commit.given_up = std::move(arrivals.given_up);
  commit.arriving.reserve(arrivals.arriving.size());
  for (const uint32_t chunk : arrivals.arriving)
    commit.arriving.push_back({&coming_.at(chunk).chunk, chunk});
  return commit;
}

void SceneStream::link(Commit& commit) {
  std::optional<Team::Session> session;
  // Where cuts lack room one thread links all.
  if (!commit.lacked_room && commit.evicted.size() + commit.arriving.size() > kFewChunks / 2) {
    session.emplace(team_);
    wake_threads();
  }
  std::vector<uint32_t> leaving;
  for (const Residency::Evicted& e : commit.evicted) leaving.push_back(e.chunk);
  linker_.evict(leaving, team_, commit.patch);
  linker_.arrive(commit.arriving, pool_, file_->name(), team_, commit.patch, commit.divided);
  session.reset();
  linker_.link_refused(commit.patch);
  if (!pages_) return;
  for (const uint32_t leaves : leaving) {
    const ChunkEntry chunk = file_->chunks().numbers(leaves);
    pages_->release(chunk.first_subtree, chunk.subtree_count, version_ + 1);
  }
  for (const Linker::Arrival& arrival : commit.arriving)
    if (arrival.held) place_subtrees(file_->chunks().numbers(arrival.chunk), commit.moved_pages);
  commit.patch.pages = pages_->changes(commit.moved_pages);
}

void SceneStream::place_subtrees(const ChunkEntry& chunk, std::vector<uint32_t>& moved_pages) {
  if (pages_->take(chunk.first_subtree, chunk.subtree_count, version_ + 1, moved_pages)) return;
  // Searches start from nothing.
  changes_.clear();
  version_ += kChangesKept;
}

void SceneStream::end_commit(const Commit& commit) {
  for (const Linker::Arrival& arrival : commit.arriving) {
    using How = Residency::Arrival;
    const How how = arrival.held ? How::resident : arrival.failure ? How::failed : How::waiting;
    residency_.end_arrival(arrival.chunk, how);
    if (how == How::waiting) continue;
    coming_.erase(arrival.chunk);
    if (arrival.failure)
      add_failure(arrival.chunk, *arrival.failure);
    else
      failures_.remove(arrival.chunk);
  }
  for (const uint32_t chunk : commit.given_up) coming_.erase(chunk);
  for (const ChunkRange& family : commit.divided)
    if (residency_.set_family(family)) ask_for_plan(PlanAsked::in_time);
  if (!commit.lacked_room && linker_.lacks_room_for_cut()) ask_for_plan(PlanAsked::in_time);
  if (!commit.patch.empty()) {
    changes_.push_back(change_of(commit.patch));
    apply(commit.patch);
    ++version_;
    if (changes_.size() > kChangesKept) changes_.pop_front();
  }
  for (const Residency::Evicted& e : commit.evicted) residency_.free(e);
  forget_shown(commit.evicted);
  const auto is_seen = [&](const Residency::Evicted& e) { return residency_.is_seen(e.chunk); };
  departures_ += std::any_of(commit.evicted.begin(), commit.evicted.end(), is_seen);
  note_changes();
  const bool plan_is_due =
      residency_.left_out() && residency_.is_quiet() && !planning_ && !plan_is_asked();
  if (plan_is_due) ask_for_plan(PlanAsked::in_time);
  if (commit.evicted.empty() && commit.arriving.empty() && commit.given_up.empty() && !plan_is_due)
    return;
  publish();
  signal();
}

void SceneStream::note_changes() {
  changes_due_ = residency_.changes();
  commit_due_ = changes_due_ != 0;
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

// That which the next version will be.
std::shared_ptr<const StreamChange> SceneStream::change_of(const LinkPatch& patch) const {
  auto change = std::make_shared<StreamChange>();
  change->version = version_ + 1;
  change->unlinked = patch.unlinked;
  change->arrived = patch.arrived;
  change->changed = patch.cut.changed;
  change->changed.insert(change->changed.end(), patch.tied.changed.begin(),
                         patch.tied.changed.end());
  return change;
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

}  // namespace voyager
