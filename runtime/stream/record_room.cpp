#include "runtime/stream/record_room.h"

#include <algorithm>
#include <cmath>

#include "runtime/math/large_families.h"
#include "runtime/math/subtree_places.h"
#include "runtime/stream/scene_stream.h"

namespace voyager {
namespace {

// So that its levels are those of its places; of the few others less is known.
bool lies_in_one_tier(const ChunkEntry& chunk, const Tiers& tiers) {
  const auto& begin = tiers.tier_begin;
  const uint32_t last = chunk.first_subtree + chunk.subtree_count - 1;
  const auto tier_end = *std::upper_bound(begin.begin(), begin.end(), chunk.first_subtree);
  return chunk.first_subtree >= begin[1] && last + 1 < tier_end;
}

}  // namespace

// The others are taken for all interior, and so is what a chunk repeats.
uint32_t most_search_records(const ChunkEntry& chunk, const SubtreePlace& after,
                             const Tiers& tiers) {
  if (!lies_in_one_tier(chunk, tiers)) return chunk.record_count;
  const auto owned = [&](size_t level) { return after.next[level] - chunk.place.next[level]; };
  return std::min(owned(0), owned(1)) + std::min(owned(1), owned(2)) +
         std::min(owned(2), owned(3)) + (chunk.record_count - chunk.node_count);
}

// What owns a node owns all of its children, too, but that the last root and the last child may go
// on in the next chunk; or they are among those below.
uint32_t most_large_families(const ChunkEntry& chunk, const SubtreePlace& after,
                             const Tiers& tiers) {
  if (!lies_in_one_tier(chunk, tiers)) return chunk.node_count;
  uint64_t families = (after.listed_children != 0) + (after.listed_grandchildren != 0);
  for (int level = 1; level < 4; ++level)
    families += (after.next[level] - chunk.place.next[level]) / kManyChildren;
  return static_cast<uint32_t>(std::min<uint64_t>(families, chunk.node_count));
}

void RecordRoom::Tally::add(uint32_t count) {
  chunks_.resize(std::max<size_t>(chunks_.size(), size_t{count} + 1));
  ++chunks_[count];
}

uint64_t RecordRoom::Tally::most(uint32_t chunks) const {
  uint64_t most = 0;
  for (size_t each = chunks_.size(); each-- > 0 && chunks != 0;) {
    const uint32_t some = std::min(chunks, chunks_[each]);
    most += uint64_t{each} * some;
    chunks -= some;
  }
  return most;
}

uint32_t RecordRoom::most_blocks(uint32_t chunk) const {
  const ChunkDirectory& chunks = file_.chunks();
  const SubtreePlace after =
      chunk + 1 < chunks.size() ? chunks.place(chunk + 1) : SubtreePlace::end_of(tiers_);
  return most_blocks(chunks.numbers(chunk), after);
}

uint32_t RecordRoom::most_blocks(const ChunkEntry& chunk, const SubtreePlace& after) const {
  return record_blocks(most_search_records(chunk, after, tiers_));
}

RecordRoom::RecordRoom(const SceneFile& file) : file_(file), tiers_(file.tiers()) {
  const auto& chunks = file.chunks();
  uint64_t records = file.info().node_count - file.info().leaf_count;
  ChunkEntry next = chunks.empty() ? ChunkEntry{} : chunks.numbers(0);
  for (size_t i = 0; i < chunks.size(); ++i) {
    const ChunkEntry chunk = next;
    const bool last = i + 1 == chunks.size();
    if (!last) next = chunks.numbers(i + 1);
    const SubtreePlace after = last ? SubtreePlace::end_of(tiers_) : next.place;
    const uint32_t most = most_blocks(chunk, after);
    greatest_ = std::max(greatest_, most);
    sum_of_most_ += most;
    records += chunk.record_count - chunk.node_count;
    pages_.add(pages_of(chunk.first_subtree + chunk.subtree_count) -
               chunk.first_subtree / kPageSubtrees);
    families_.add(most_large_families(chunk, after, tiers_));
  }
  all_pages_ = pages_of(file.info().subtree_count);
  // Each chunk leaves less than a block unused.
  const uint64_t rounded = (records + (kRecordBlock - 1) * uint64_t{chunks.size()}) / kRecordBlock;
  all_ = static_cast<uint32_t>(std::min(sum_of_most_, rounded));
}

uint64_t RecordRoom::likely_blocks(uint64_t most) const {
  const double share = static_cast<double>(all_) / static_cast<double>(sum_of_most_);
  return static_cast<uint64_t>(std::ceil(share * static_cast<double>(most)));
}

PoolRoom RecordRoom::of(uint32_t slots) const {
  const auto families = static_cast<uint32_t>(families_.most(slots));
  if (slots >= chunks()) return {slots, all_, all_pages_, families};
  const double part = static_cast<double>(slots) / chunks();
  const double share = std::ceil(all_ * part * (1.5 - 0.5 * part));
  const double least = (SceneStream::pinned_chunks(file_, slots) + 1.0) * greatest_;
  const uint64_t pages = pages_.most(slots);
  return {slots, static_cast<uint32_t>(std::min<double>(all_, std::max(share, least))),
          static_cast<uint32_t>(std::min<uint64_t>(all_pages_, pages + pages / 8 + 1)), families};
}

PoolRoom RecordRoom::enough(uint64_t chunks_needed, uint64_t blocks) const {
  // What is pinned grows with the slots.
  uint32_t pinned = 0;
  uint64_t pinned_blocks = 0;
  const auto has_room = [&](uint32_t slots) {
    const PoolRoom room = of(slots);
    while (pinned < SceneStream::pinned_chunks(file_, slots))
      pinned_blocks += most_blocks(pinned++);
    return slots >= chunks_needed + pinned &&
           (room.blocks == all_ || room.blocks >= blocks + pinned_blocks);
  };
  auto slots = static_cast<uint32_t>(std::min<uint64_t>(chunks_needed, chunks()));
  while (slots < chunks() && !has_room(slots)) ++slots;
  return of(slots);
}

}  // namespace voyager
