#include "runtime/stream/chunk_graph.h"

#include <algorithm>

#include "runtime/base/first_that.h"

namespace voyager {

// What is sought for a chunk of a sound file is near what was sought for the one before.
ChunkGraph::ChunkGraph(const ChunkDirectory& chunks, const Tiers& tiers)
    : chunks_(&chunks), tiers_(tiers) {
  ChunkRange near{0, 0};
  for (uint32_t chunk = 0; chunk < size(); ++chunk) {
    const ChunkRange children = find_children(chunk, near.first);
    children_.add(children);
    if (!children.empty()) near = children;
  }
  children_.close();
  near = {0, 0};
  for (uint32_t chunk = 0; chunk < size(); ++chunk) {
    ChunkRange among = near = among_parents(chunk, near);
    while (!among.empty() && children_.is_empty(among.first)) ++among.first;
    while (!among.empty() && children_.is_empty(among.last - 1)) --among.last;
    parents_.add(among);
  }
  parents_.close();
}

ChunkRange ChunkGraph::find_children(uint32_t chunk, uint32_t near) const {
  const uint32_t below = chunks_->next(chunk, 3), after = next_after(chunk, 3);
  if (below == after) return {0, 0};
  const uint32_t first =
      first_near(near, size(), [&](uint32_t other) { return last_root(other) >= below; });
  const uint32_t last =
      first_near(first, size(), [&](uint32_t other) { return first_root(other) >= after; });
  const uint32_t least = std::max(first, chunk + 1);
  return {least, std::max(least, last)};
}

// From the first parent to the last.
ChunkRange ChunkGraph::among_parents(uint32_t chunk, ChunkRange near) const {
  const uint32_t last = last_root(chunk);
  if (last == 0) return {chunk, chunk};
  const uint32_t begin = owner_near(std::max(first_root(chunk), 1u), near.first);
  const uint32_t end = std::min(chunk, owner_near(last, near.last) + 1);
  return {std::min(begin, end), end};
}

uint32_t ChunkGraph::next_after(uint32_t chunk, int level) const {
  if (chunk + 1 < size()) return chunks_->next(chunk + 1, level);
  return SubtreePlace::end_of(tiers_).next[level];
}

uint32_t ChunkGraph::tier_of(uint32_t subtree) const {
  const auto& begin = tiers_.tier_begin;
  return static_cast<uint32_t>(std::upper_bound(begin.begin(), begin.end(), subtree) -
                               begin.begin() - 1);
}

// Repeated or not.
uint32_t ChunkGraph::first_root(uint32_t chunk) const {
  return chunks_->next(chunk, 0) - (chunks_->goes_on_with_root(chunk) ? 1 : 0);
}

uint32_t ChunkGraph::last_root(uint32_t chunk) const {
  const uint32_t end =
      chunk + 1 < size() ? chunks_->first_subtree(chunk + 1) : tiers_.tier_begin.back();
  const uint32_t tier = tier_of(end - 1);
  if (chunk + 1 < size() && tier_of(end) == tier) return next_after(chunk, 0) - 1;
  const uint32_t level = tier == 0 ? 0 : tiers_.first_tier_levels + (tier - 1) * kTierLevels;
  return tiers_.level_begin[level + 1] - 1;
}

// next[3] ascends over all chunks; a chunk that nothing hangs from has its successor's.
bool ChunkGraph::leads_beyond(uint32_t chunk, uint32_t root) const {
  return chunks_->next(chunk, 3) > root;
}

// What owns it is among the parents, or the chunk itself.
uint32_t ChunkGraph::owner_of_parent(uint32_t chunk, uint32_t root) const {
  const ChunkRange among = parents_[chunk];
  const auto leads = [&](uint32_t other) { return leads_beyond(other, root); };
  if (among.empty() || !leads(among.last)) return chunk;
  return first_that(among.first + 1, among.last, leads) - 1;
}

// Of any chunk's root, sought from a chunk that is probably near.
uint32_t ChunkGraph::owner_near(uint32_t root, uint32_t near) const {
  const uint32_t after =
      first_near(near, size(), [&](uint32_t chunk) { return leads_beyond(chunk, root); });
  return after == 0 ? 0 : after - 1;
}

ChunkRange ChunkGraph::with_roots(uint32_t first, uint32_t count, ChunkRange among) const {
  const uint32_t begin = first_that(among.first, among.last,
                                    [&](uint32_t chunk) { return last_root(chunk) >= first; });
  return {begin, first_that(begin, among.last,
                            [&](uint32_t chunk) { return first_root(chunk) >= first + count; })};
}

bool ChunkGraph::leads_to_itself(uint32_t chunk) const {
  return children_.is_empty(chunk) || last_root(chunk) >= chunks_->next(chunk, 3);
}

ChunkRange ChunkGraph::with_family(uint32_t chunk, uint32_t first, uint32_t count) const {
  ChunkRange among = children_[chunk];
  if (among.empty()) return {chunk, chunk + 1};
  if (last_root(chunk) >= first) among.first = chunk;
  return with_roots(first, count, among);
}

void ChunkGraph::Families::go_to(uint32_t chunk) {
  near_ = chunk;
  begin_ = graph_->chunks_->next(chunk, 0);
  end_ = chunk + 1 < graph_->size() ? graph_->first_root(chunk + 1) : UINT32_MAX;
}

}  // namespace voyager
