#include "runtime/stream/chunk_graph.h"

#include <algorithm>

#include "runtime/base/first_that.h"

namespace voyager {

// What is sought for one chunk lies behind what was sought for the one before: O(n) in all.
class ChunkGraph::Builder {
 public:
  explicit Builder(const ChunkGraph& graph) : graph_(graph) {}

  ChunkRange children(uint32_t chunk) {
    const uint32_t below = graph_.chunks_->place(chunk).next[3];
    const uint32_t after = graph_.place_after(chunk).next[3];
    if (below == after) return {0, 0};
    while (first_ < graph_.size() && graph_.last_root(first_) < below) ++first_;
    uint32_t last = first_;
    while (last < graph_.size() && graph_.first_root(last) < after) ++last;
    const uint32_t least = std::max(first_, chunk + 1);
    return {least, std::max(least, last)};
  }

  // From the first parent to the last.
  ChunkRange among_parents(uint32_t chunk) {
    const uint32_t last = graph_.last_root(chunk);
    if (last == 0) return {chunk, chunk};
    const uint32_t begin = owner(std::max(graph_.first_root(chunk), 1u), first_owner_);
    const uint32_t end = std::min(chunk, owner(last, last_owner_) + 1);
    return {std::min(begin, end), end};
  }

 private:
  // As owner_of_parent().
  uint32_t owner(uint32_t root, uint32_t& after) const {
    while (after < graph_.size() && graph_.chunks_->place(after).next[3] <= root) ++after;
    return after == 0 ? 0 : after - 1;
  }

  const ChunkGraph& graph_;
  uint32_t first_ = 0, first_owner_ = 0, last_owner_ = 0;
};

ChunkGraph::ChunkGraph(const ChunkDirectory& chunks, const Tiers& tiers)
    : chunks_(&chunks), tiers_(tiers) {
  Builder builder(*this);
  words_.resize(chunks.size() / 64 + 1);
  for (uint32_t chunk = 0; chunk < size(); ++chunk) {
    Word& word = words_[chunk / 64];
    if (chunk % 64 == 0) word.before = static_cast<uint32_t>(leading_.size());
    const ChunkRange children = builder.children(chunk);
    if (children.empty()) continue;
    word.leads |= uint64_t{1} << chunk % 64;
    leading_.push_back(chunk);
    children_.push_back(children);
  }
  leading_.shrink_to_fit();
  children_.shrink_to_fit();
  const auto place_of = [&](uint32_t chunk) {
    return static_cast<uint32_t>(std::lower_bound(leading_.begin(), leading_.end(), chunk) -
                                 leading_.begin());
  };
  parents_.reserve(chunks.size());
  for (uint32_t chunk = 0; chunk < size(); ++chunk) {
    const ChunkRange among = builder.among_parents(chunk);
    parents_.push_back({place_of(among.first), place_of(among.last)});
  }
}

SubtreePlace ChunkGraph::place_after(uint32_t chunk) const {
  return chunk + 1 < size() ? chunks_->place(chunk + 1) : SubtreePlace::end_of(tiers_);
}

uint32_t ChunkGraph::tier_of(uint32_t subtree) const {
  const auto& begin = tiers_.tier_begin;
  return static_cast<uint32_t>(std::upper_bound(begin.begin(), begin.end(), subtree) -
                               begin.begin() - 1);
}

// Repeated or not.
uint32_t ChunkGraph::first_root(uint32_t chunk) const {
  const SubtreePlace place = chunks_->place(chunk);
  return place.next[0] - (place.listed_children != 0 ? 1 : 0);
}

uint32_t ChunkGraph::last_root(uint32_t chunk) const {
  const uint32_t end =
      chunk + 1 < size() ? chunks_->first_subtree(chunk + 1) : tiers_.tier_begin.back();
  const uint32_t tier = tier_of(end - 1);
  if (chunk + 1 < size() && tier_of(end) == tier) return place_after(chunk).next[0] - 1;
  const uint32_t level = tier == 0 ? 0 : tiers_.first_tier_levels + (tier - 1) * kTierLevels;
  return tiers_.level_begin[level + 1] - 1;
}

// next[3] ascends over all chunks; a chunk that nothing hangs from has its successor's.
uint32_t ChunkGraph::owner_of_parent(uint32_t root) const {
  const uint32_t after =
      first_that(0u, size(), [&](uint32_t chunk) { return chunks_->place(chunk).next[3] > root; });
  return after == 0 ? 0 : after - 1;
}

ChunkRange ChunkGraph::with_roots(uint32_t first, uint32_t count, ChunkRange among) const {
  const uint32_t begin = first_that(among.first, among.last,
                                    [&](uint32_t chunk) { return last_root(chunk) >= first; });
  return {begin, first_that(begin, among.last,
                            [&](uint32_t chunk) { return first_root(chunk) >= first + count; })};
}

ChunkRange ChunkGraph::with_family(uint32_t chunk, uint32_t first, uint32_t count) const {
  ChunkRange among = children(chunk);
  if (among.empty()) return {chunk, chunk + 1};
  if (last_root(chunk) >= first) among.first = chunk;
  return with_roots(first, count, among);
}

}  // namespace voyager
