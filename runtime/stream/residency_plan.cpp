// A plan: what is needed, the target, what to ask for and what may go.
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "runtime/stream/residency.h"

namespace voyager {

void Residency::plan(ChunkLooks& looks) {
  ++plan_;
  find_needed(looks);
  share_in_families();
  share_with_parents();
  count_need();
  choose_target();
  drop_waiting();
  queue_requests();
  list_victims();
  list_leftovers();
}

// And all that it hangs from: chains may be as long as a file says. False where it is not to be
// had, because it or what it hangs from has failed.
bool Residency::add_needed(const Needed& needed) {
  climb_.assign(1, {needed, 0});
  while (!climb_.empty()) {
    auto& [of, done] = climb_.back();
    if (state_[of.chunk] == State::failed) {
      failed_.push_back(of);
      return false;
    }
    const std::span<const uint32_t> parents = graph_->parents(of.chunk);
    while (done < parents.size() && needed_plan_[parents[done]] == plan_) ++done;
    if (done < parents.size()) {
      const uint32_t parent = parents[done++];
      own_urgency_[parent] = 0;
      climb_.push_back({{parent, of.urgency, of.now}, 0});
      continue;
    }
    needed_plan_[of.chunk] = plan_;
    extra_.push_back(of);
    climb_.pop_back();
  }
  return true;
}

// Nothing that hangs from a chunk is larger than the largest of its own nodes, or seen where these
// are not. Where few nodes go so deep a chunk is of places far apart, and its hull of all between.
uint32_t Residency::most_above(uint32_t chunk) const {
  const std::span<const uint32_t> parents = graph_->parents(chunk);
  if (parents.empty()) return UINT32_MAX;
  uint32_t most = 0;
  for (const uint32_t p : parents)
    if (needed_plan_[p] == plan_) most = std::max(most, own_urgency_[p]);
  return most;
}

// From the top: a chunk can only be needed where one that leads to it is. Both ascend.
void Residency::find_needed(ChunkLooks& looks) {
  needed_.clear(), failed_.clear(), extra_.clear();
  uint32_t next = 0;
  size_t from = 0;
  const auto needed_before = [&](uint32_t chunk) {
    return !extra_.empty() && extra_.back().chunk == chunk - 1;
  };
  const auto look = [&](uint32_t chunk) {
    next = chunk + 1;
    if (needed_plan_[chunk] == plan_) return;
    const ChunkLooks::Look own = looks.at(chunk);
    Needed found{chunk, own.urgency, own.now};
    // A node is refined with all of its children or not at all, and the hull of a chunk that goes
    // on with a node of the one before is that of this node, not of what it hangs from.
    if (chunks_[chunk].place.listed_children != 0 && needed_before(chunk)) {
      found.urgency = std::max(found.urgency, extra_.back().urgency);
      found.now = found.now || extra_.back().now;
    }
    found.urgency = std::min(found.urgency, most_above(chunk));
    if (found.urgency == 0) return;
    own_urgency_[chunk] = found.urgency;
    add_needed(found);
  };
  while (next < graph_->size() && graph_->parents(next).empty()) look(next);
  for (; from < extra_.size(); ++from) {
    const ChunkRange children = graph_->children(extra_[from].chunk);
    for (uint32_t c = std::max(next, children.first); c < children.last; ++c) look(c);
  }
  const auto by_chunk = [](const Needed& a, const Needed& b) {
    return a.chunk != b.chunk ? a.chunk < b.chunk : a.urgency > b.urgency;
  };
  std::sort(failed_.begin(), failed_.end(), by_chunk);  // what several hang from is there often
  const auto same = [](const Needed& a, const Needed& b) { return a.chunk == b.chunk; };
  failed_.erase(std::unique(failed_.begin(), failed_.end(), same), failed_.end());
  needed_ = extra_;
  std::sort(needed_.begin(), needed_.end(), by_chunk);
}

// A node is refined only when all that hangs from it is there. Which chunks hold a family is known
// when the chunk of its parent has come. What a family lends is less than the parent's urgency: so
// families of parents that have no room alter nothing in front of those, known or not. Nor is it
// lent to another class: a node that is seen and refined makes all chunks of its family seen.
void Residency::share_in_families() {
  for (const Needed& needed : needed_) urgency_[needed.chunk] = needed.urgency;
  const auto follows = [&](size_t i) {
    return i < needed_.size() && needed_[i].chunk == needed_[i - 1].chunk + 1 &&
           shares_family_[needed_[i].chunk] != 0;
  };
  for (size_t i = 1; i < needed_.size(); ++i) {
    if (!follows(i)) continue;
    size_t last = i;
    while (shares_family_[needed_[last].chunk] == 2 && follows(last + 1)) ++last;
    std::array<uint32_t, 4> most{};  // by class
    const auto of_class = [&](size_t k) -> uint32_t& {
      return most[static_cast<size_t>(ChunkLooks::class_of(urgency_[needed_[k].chunk]))];
    };
    for (size_t k = i - 1; k <= last; ++k)
      of_class(k) = std::max(of_class(k), urgency_[needed_[k].chunk]);
    for (size_t k = i - 1; k <= last; ++k)
      needed_[k].urgency = std::max(needed_[k].urgency, of_class(k) & ~ChunkLooks::kOwn);
    i = last;
  }
}

void Residency::share_with_parents() {
  for (const Needed& needed : needed_) urgency_[needed.chunk] = needed.urgency;
  for (size_t i = needed_.size(); i-- > 0;) {
    needed_[i].urgency = urgency_[needed_[i].chunk];
    // What goes before others because something that is seen hangs on it counts as seen.
    needed_[i].now =
        needed_[i].now || ChunkLooks::class_of(needed_[i].urgency) == ChunkLooks::Class::seen;
    for (const uint32_t p : graph_->parents(needed_[i].chunk))
      urgency_[p] = std::max(urgency_[p], needed_[i].urgency);
  }
}

void Residency::choose_target() {
  crowded_ = false;
  extra_.clear();
  for (const Needed& needed : needed_)
    if (needed.chunk >= pinned_) extra_.push_back(needed);
  const size_t room = room_.slots - pinned_;
  // Parents are at least as urgent as their children, and come before them.
  const auto before = [](const Needed& a, const Needed& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.chunk < b.chunk;
  };
  if (extra_.size() > room) {
    std::nth_element(extra_.begin(), extra_.begin() + static_cast<std::ptrdiff_t>(room),
                     extra_.end(), before);
    extra_.resize(room);
    crowded_ = true;
  }
  const auto blocks_of = [&](uint64_t sum, const Needed& needed) {
    return sum + known_blocks(needed.chunk);
  };
  target_blocks_ = pinned_blocks();
  const uint64_t all = std::accumulate(extra_.begin(), extra_.end(), target_blocks_, blocks_of);
  if (all > room_.blocks) {
    std::sort(extra_.begin(), extra_.end(), before);
    size_t last = 0;
    for (; target_blocks_ + known_blocks(extra_[last].chunk) <= room_.blocks; ++last)
      target_blocks_ += known_blocks(extra_[last].chunk);
    extra_.resize(last);
    crowded_ = true;
  } else {
    target_blocks_ = all;
  }
  for (const Needed& needed : extra_) target_[needed.chunk] = plan_;
}

void Residency::queue_requests() {
  for (const uint32_t chunk : requests_)
    counters_.flushed += state_[chunk] == State::absent && !is_wanted(chunk);
  requests_.clear();
  for (uint32_t chunk = 0; chunk < pinned_; ++chunk)
    if (state_[chunk] == State::absent) {
      urgency_[chunk] = UINT32_MAX;
      requests_.push_back(chunk);
    }
  for (const Needed& needed : extra_)
    if (state_[needed.chunk] == State::absent) requests_.push_back(needed.chunk);
  for (const Needed& needed : needed_)
    if (needed.now && ChunkLooks::class_of(needed.urgency) == ChunkLooks::Class::seen &&
        state_[needed.chunk] != State::resident)
      missed_[needed.chunk] = 1;
  // Families together, as no frame sees a part of one.
  const auto urgency = [&](uint32_t chunk) { return urgency_[chunk] | ChunkLooks::kOwn; };
  std::sort(requests_.begin(), requests_.end(), [&](uint32_t a, uint32_t b) {
    return urgency(a) != urgency(b) ? urgency(a) < urgency(b) : a > b;
  });
}

// By the time since they were last needed over the error that they then spared; what leads to a
// victim goes after it.
void Residency::list_victims() {
  victims_.clear();
  if (!is_short(wanted(requests_.size()))) return;
  std::vector<std::pair<float, uint32_t>> scored;
  std::vector<float> score(graph_->size(), INFINITY);
  for (uint32_t chunk = graph_->size(); chunk-- > pinned_;) {
    if (state_[chunk] != State::resident || is_wanted(chunk)) continue;
    const float age = static_cast<float>(plan_ - needed_plan_[chunk]);
    score[chunk] = std::min(score[chunk], age / ChunkLooks::error_of(urgency_[chunk]));
    for (const uint32_t p : graph_->parents(chunk)) score[p] = std::min(score[p], score[chunk]);
    scored.emplace_back(score[chunk], chunk);
  }
  std::sort(scored.begin(), scored.end());
  for (const auto& [of, chunk] : scored) victims_.push_back(chunk);
}

// All of the target fits, so that nothing of this is a victim. Where some of what is needed does
// not, what of it is there has come when others looked, and draws a cut that others would not see.
// With it goes what hangs from it.
void Residency::list_leftovers() {
  leftovers_.clear();
  if (!crowded_) return;
  std::vector<bool> goes(graph_->size());
  for (uint32_t chunk = pinned_; chunk < graph_->size(); ++chunk) {
    if (state_[chunk] != State::resident || is_wanted(chunk)) continue;
    const std::span<const uint32_t> parents = graph_->parents(chunk);
    goes[chunk] = needed_plan_[chunk] == plan_ ||
                  std::any_of(parents.begin(), parents.end(), [&](uint32_t p) { return goes[p]; });
    if (goes[chunk]) leftovers_.push_back(chunk);
  }
}

void Residency::count_need() {
  need_ = {};
  for (const Needed& needed : needed_) {
    counted_[needed.chunk] = 0;
    if (!needed.now) continue;
    const bool seen =
        ChunkLooks::class_of(needed.urgency) == ChunkLooks::Class::seen && needed.chunk >= pinned_;
    counted_[needed.chunk] = seen ? kSeen : 1;
    ++need_.chunks;
    need_.seen += seen;
    if (seen) {
      need_.seen_blocks += known_blocks(needed.chunk);
      need_.seen_unread_blocks += most_blocks(needed.chunk) - known_blocks(needed.chunk);
    }
    if (state_[needed.chunk] != State::resident) count_missing(needed.chunk, true);
  }
  for (const Needed& needed : failed_) {
    if (!needed.now) continue;
    ++need_.chunks;
    ++need_.missing;
    need_.missing_bytes += chunks_[needed.chunk].bytes;
    if (ChunkLooks::class_of(needed.urgency) != ChunkLooks::Class::seen) continue;
    ++need_.seen;
    ++need_.seen_missing;
    need_.seen_failed.push_back(needed.chunk);
  }
}

}  // namespace voyager
