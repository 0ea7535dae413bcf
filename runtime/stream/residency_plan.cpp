// A plan: what is needed, the target, what to ask for and what may go.
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "runtime/stream/residency.h"

namespace voyager {
namespace {

// After so many plans in haste what they leave out is counted anew.
constexpr uint32_t kHastyPlans = 15;

}  // namespace

void Residency::plan(ChunkLooks& looks, bool cuts_are_full, bool in_haste) {
  forget_absent();
  if (!in_haste || hasty_plans_ == kHastyPlans) least_ = 0;
  consider(looks);
  if (left_out_ && count_urgent() < room_.slots) {
    least_ = 0;
    consider(looks);
  }
  hasty_plans_ = left_out_ ? hasty_plans_ + 1 : 0;
  count_need();
  choose_target();
  drop_waiting();
  queue_requests();
  list_victims();
  list_leftovers(cuts_are_full);
}

void Residency::consider(ChunkLooks& looks) {
  ++plan_;
  left_out_ = false;
  find_needed(looks);
  share_in_families();
  share_with_parents();
}

size_t Residency::count_urgent() const {
  const auto is_urgent = [&](const Needed& needed) { return needed.urgency >= least_; };
  return static_cast<size_t>(std::count_if(needed_.begin(), needed_.end(), is_urgent));
}

// Of those without room, so that plans in haste find a quarter more than there is room for.
void Residency::choose_least(std::span<Needed> rest) {
  const size_t spare = room_.slots / 4;
  if (rest.size() <= spare) return;
  const auto last = rest.begin() + static_cast<std::ptrdiff_t>(spare);
  std::nth_element(rest.begin(), last, rest.end(),
                   [](const Needed& a, const Needed& b) { return a.urgency > b.urgency; });
  least_ = std::min(last->urgency, ChunkLooks::least_of(ChunkLooks::Class::seen));
  const auto count = [&](const Needed& needed, bool missing) {
    if (!needed.now || needed.urgency >= least_) return;
    ++beyond_.chunks;
    beyond_.missing += missing;
    beyond_.missing_bytes += missing ? chunks_->bytes(needed.chunk) : 0;
  };
  for (const Needed& needed : needed_) count(needed, known(needed.chunk).state != State::resident);
  for (const Needed& needed : failed_) count(needed, true);
}

// What the last plan did not need either.
void Residency::forget_absent() {
  std::vector<uint32_t> absent;
  known_.each([&](uint32_t chunk, const Known& known) {
    if (known.state == State::absent && known.needed_plan != plan_) absent.push_back(chunk);
  });
  for (const uint32_t chunk : absent) known_.forget(chunk);
}

// And all that it hangs from: chains may be as long as a file says. False where it is not to be
// had, because it or what it hangs from has failed.
bool Residency::add_needed(const Needed& needed) {
  const auto is_needed = [&](uint32_t parent) { return known(parent).needed_plan == plan_; };
  const ChunkGraph::Parents above = graph_->parents(needed.chunk);
  if (known(needed.chunk).state != State::failed &&
      std::all_of(above.begin(), above.end(), is_needed)) {  // nearly always
    mark_needed(needed.chunk);
    extra_.push_back(needed);
    return true;
  }
  climb_.assign(1, {needed, 0});
  while (!climb_.empty()) {
    auto& [of, from] = climb_.back();
    if (known(of.chunk).state == State::failed) {
      failed_.push_back(of);
      return false;
    }
    const ChunkGraph::Parents parents = graph_->parents(of.chunk, from);
    const auto next = std::find_if_not(parents.begin(), parents.end(), is_needed);
    if (next != parents.end()) {
      const uint32_t parent = *next;
      from = parent + 1;
      know(parent).own_urgency = 0;
      climb_.push_back({{parent, of.urgency, of.now}, 0});
      continue;
    }
    mark_needed(of.chunk);
    extra_.push_back(of);
    climb_.pop_back();
  }
  return true;
}

void Residency::mark_needed(uint32_t chunk) {
  Known& own = know(chunk);
  own.needed_plan = plan_;
  if (own.blocks == kUnknown) own.blocks = records_->most_blocks(chunk);
}

// Nothing that hangs from a chunk is larger than the largest of its own nodes, or seen where these
// are not. Where few nodes go so deep a chunk is of places far apart, and its hull of all between.
uint32_t Residency::most_above(uint32_t chunk) const {
  if (!graph_->has_parents(chunk)) return UINT32_MAX;
  uint32_t most = 0;
  for (const uint32_t p : graph_->parents(chunk))
    if (known(p).needed_plan == plan_) most = std::max(most, known(p).own_urgency);
  return most;
}

// In haste, unless a family that it shares may lend it more: by looks alone, which is nearly always
// right. Of a larger family nothing is left out.
bool Residency::leaves_out(uint32_t chunk, uint32_t urgency, ChunkLooks& looks) const {
  constexpr uint32_t kFewChunks = 8;  // on either side
  if (urgency >= least_) return false;
  if (urgency == 0) return true;
  const auto lends = [&](uint32_t other) {
    const uint32_t most = looks.at(other).urgency;
    return most >= least_ && ChunkLooks::class_of(most) == ChunkLooks::class_of(urgency);
  };
  for (uint32_t c = chunk; shares_family_[c] != 0; --c) {
    if (lends(c - 1) || chunk - c == kFewChunks) return false;
    if (shares_family_[c - 1] != 2) break;
  }
  for (uint32_t c = chunk + 1; c < graph_->size() && shares_family_[c] != 0; ++c) {
    if (lends(c) || c - chunk == kFewChunks) return false;
    if (shares_family_[c] != 2) break;
  }
  return true;
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
    const ChunkLooks::Look own = looks.at(chunk);
    // A node is refined with all of its children or not at all, and the hull of a chunk that goes
    // on with a node of the one before is that of this node, not of what it hangs from.
    const bool goes_on = needed_before(chunk) && chunks_->goes_on_with_root(chunk);
    if (!goes_on && leaves_out(chunk, own.urgency, looks)) {
      left_out_ = left_out_ || own.urgency != 0;
      return;
    }
    if (known(chunk).needed_plan == plan_) return;
    Needed found{chunk, own.urgency, own.now};
    if (goes_on) {
      found.urgency = std::max(found.urgency, extra_.back().urgency);
      found.now = found.now || extra_.back().now;
    }
    found.urgency = std::min(found.urgency, most_above(chunk));
    if (found.urgency == 0) return;
    if (leaves_out(chunk, found.urgency, looks)) {
      left_out_ = true;
      return;
    }
    know(chunk).own_urgency = found.urgency;
    add_needed(found);
  };
  while (next < graph_->size() && !graph_->has_parents(next)) look(next);
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
  // Most have come in their order already.
  std::vector<Needed> others;
  for (const Needed& needed : extra_)
    (needed_.empty() || needed.chunk > needed_.back().chunk ? needed_ : others).push_back(needed);
  std::sort(others.begin(), others.end(), by_chunk);
  const auto middle = static_cast<std::ptrdiff_t>(needed_.size());
  needed_.insert(needed_.end(), others.begin(), others.end());
  std::inplace_merge(needed_.begin(), needed_.begin() + middle, needed_.end(), by_chunk);
}

// A node is refined only when all that hangs from it is there. Which chunks hold a family is known
// when the chunk of its parent has come. What a family lends is less than the parent's urgency: so
// families of parents that have no room alter nothing in front of those, known or not. Nor is it
// lent to another class: a node that is seen and refined makes all chunks of its family seen.
void Residency::share_in_families() {
  for (const Needed& needed : needed_) know(needed.chunk).urgency = needed.urgency;
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
      return most[static_cast<size_t>(ChunkLooks::class_of(known(needed_[k].chunk).urgency))];
    };
    for (size_t k = i - 1; k <= last; ++k)
      of_class(k) = std::max(of_class(k), known(needed_[k].chunk).urgency);
    for (size_t k = i - 1; k <= last; ++k)
      needed_[k].urgency = std::max(needed_[k].urgency, of_class(k) & ~ChunkLooks::kOwn);
    i = last;
  }
}

void Residency::share_with_parents() {
  for (const Needed& needed : needed_) know(needed.chunk).urgency = needed.urgency;
  for (size_t i = needed_.size(); i-- > 0;) {
    needed_[i].urgency = known(needed_[i].chunk).urgency;
    // What goes before others because something that is seen hangs on it counts as seen.
    needed_[i].now =
        needed_[i].now || ChunkLooks::class_of(needed_[i].urgency) == ChunkLooks::Class::seen;
    for (const uint32_t p : graph_->parents(needed_[i].chunk))
      know(p).urgency = std::max(known(p).urgency, needed_[i].urgency);
  }
}

void Residency::choose_target() {
  crowded_ = left_out_;
  if (!left_out_) least_ = 0, beyond_ = {};
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
    if (!left_out_) choose_least(std::span(extra_).subspan(room));
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
  for (const Needed& needed : extra_) know(needed.chunk).target_plan = plan_;
}

void Residency::queue_requests() {
  for (const uint32_t chunk : requests_)
    counters_.flushed += known(chunk).state == State::absent && !is_wanted(chunk);
  std::erase_if(extra_,
                [&](const Needed& needed) { return known(needed.chunk).state != State::absent; });
  for (uint32_t chunk = 0; chunk < pinned_; ++chunk)
    if (known(chunk).state == State::absent) extra_.push_back({chunk, UINT32_MAX, false});
  // Families together, as no frame sees a part of one.
  const auto urgency = [](const Needed& needed) { return needed.urgency | ChunkLooks::kOwn; };
  std::sort(extra_.begin(), extra_.end(), [&](const Needed& a, const Needed& b) {
    return urgency(a) != urgency(b) ? urgency(a) < urgency(b) : a.chunk > b.chunk;
  });
  asked_.clear();
  for (const Needed& needed : extra_) asked_.push_back(needed.chunk);
  order_requests();
  for (const Needed& needed : needed_)
    if (needed.now && ChunkLooks::class_of(needed.urgency) == ChunkLooks::Class::seen &&
        known(needed.chunk).state != State::resident)
      missed_[needed.chunk] = true;
}

// Residents that nobody wants, ascending. Clears what the lists below keep of all residents.
std::vector<uint32_t> Residency::unwanted() {
  std::vector<uint32_t> chunks;
  known_.each([&](uint32_t chunk, Known& known) {
    known.score = INFINITY;
    known.leaves = false;
    if (known.state == State::resident && !is_wanted(chunk)) chunks.push_back(chunk);
  });
  std::sort(chunks.begin(), chunks.end());
  return chunks;
}

// By the time since they were last needed over the error that they then spared; what leads to a
// victim goes after it.
void Residency::list_victims() {
  victims_.clear();
  if (!is_short(wanted(requests_.size()))) return;
  std::vector<std::pair<float, uint32_t>> scored;
  const std::vector<uint32_t> chunks = unwanted();
  for (size_t i = chunks.size(); i-- > 0;) {
    Known& own = know(chunks[i]);
    const float age = static_cast<float>(plan_ - own.needed_plan);
    own.score = std::min(own.score, age / ChunkLooks::error_of(own.urgency));
    scored.emplace_back(own.score, chunks[i]);
    for (const uint32_t p : graph_->parents(chunks[i]))
      know(p).score = std::min(known(p).score, scored.back().first);
  }
  std::sort(scored.begin(), scored.end());
  for (const auto& [of, chunk] : scored) victims_.push_back(chunk);
}

// All of the target fits, so that nothing of this is a victim. Where some of what is needed does
// not, what of it is there has come when others looked, and draws a cut that others would not see.
// With it goes what hangs from it.
void Residency::list_leftovers(bool cuts_are_full) {
  leftovers_.clear();
  if (left_out_ || (!crowded_ && !cuts_are_full)) return;  // another plan follows
  for (const uint32_t chunk : unwanted()) {
    const ChunkGraph::Parents parents = graph_->parents(chunk);
    const bool leaves =
        cuts_are_full || known(chunk).needed_plan == plan_ ||
        std::any_of(parents.begin(), parents.end(), [&](uint32_t p) { return known(p).leaves; });
    know(chunk).leaves = leaves;
    if (leaves) leftovers_.push_back(chunk);
  }
}

void Residency::count_need() {
  need_ = left_out_ ? beyond_ : ResidencyNeed{};
  for (const Needed& needed : needed_) {
    know(needed.chunk).counted = 0;
    if (!needed.now || (left_out_ && needed.urgency < least_)) continue;
    const bool seen =
        ChunkLooks::class_of(needed.urgency) == ChunkLooks::Class::seen && needed.chunk >= pinned_;
    know(needed.chunk).counted = seen ? kSeen : 1;
    ++need_.chunks;
    need_.seen += seen;
    if (seen) {
      need_.seen_blocks += known_blocks(needed.chunk);
      need_.seen_unread_blocks += most_blocks(needed.chunk) - known_blocks(needed.chunk);
    }
    if (known(needed.chunk).state != State::resident) count_missing(needed.chunk, true);
  }
  for (const Needed& needed : failed_) {
    if (!needed.now || (left_out_ && needed.urgency < least_)) continue;
    ++need_.chunks;
    ++need_.missing;
    need_.missing_bytes += chunks_->bytes(needed.chunk);
    if (ChunkLooks::class_of(needed.urgency) != ChunkLooks::Class::seen) continue;
    ++need_.seen;
    ++need_.seen_missing;
    need_.seen_failed.push_back(needed.chunk);
  }
}

}  // namespace voyager
