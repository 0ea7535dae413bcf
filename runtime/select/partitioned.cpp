#include "runtime/select/partitioned.h"

#include <algorithm>
#include <cassert>
#include <type_traits>
#include <utility>

#include "runtime/select/partitioned_blocks.h"
#include "runtime/select/set_bits.h"

namespace voyager {

PartitionedSearch::PartitionedSearch(const SearchTree& tree, std::pmr::memory_resource* memory,
                                     std::pmr::memory_resource* state, bool lists_cut)
    : tree_(tree),
      watch_(state == nullptr ? memory : state),
      refined_(watch_.get_allocator()),
      cut_slots_(watch_.get_allocator()),
      last_cut_slots_(watch_.get_allocator()),
      stand_ins_(watch_.get_allocator()),
      changes_(watch_.get_allocator()),
      opened_(memory),
      blocks_(watch_.get_allocator()),
      tier_block_(watch_.get_allocator()),
      touched_(watch_.get_allocator()),
      chunk_stamp_(watch_.get_allocator()),
      cut_(memory),
      lists_cut_(lists_cut) {
  blocks_.reserve(block_count(tree, kBlockSubtrees));
  for (uint32_t tier = 0; tier + 1 < tree.tier_begin.size(); ++tier) {
    tier_block_.push_back(static_cast<uint32_t>(blocks_.size()));
    const uint32_t end = tree.tier_begin[tier + 1];
    for (uint32_t s = tree.tier_begin[tier]; s < end; s += kBlockSubtrees)
      blocks_.push_back({s, std::min(end, s + kBlockSubtrees), tier, 0, 0, {}, {}});
  }
  touched_.resize(blocks_.size());
  chunk_stamp_.resize(tree.chunk_count);
  // A pool may have other room at any moment but within a run, which sees to it.
  if (!tree.chunks_come_and_go) make_room();
}

// But for less than a byte a place of changes_, which kPlaceBytes has.
uint64_t PartitionedSearch::fixed_bytes(const SearchTree& tree) {
  static_assert(sizeof(Changes) <= kRoundSubtrees);
  return sizeof(PartitionedSearch) + (block_count(tree, kBlockSubtrees) + 1) * sizeof(Changes) +
         block_count(tree, kBlockSubtrees) * (sizeof(Block) + sizeof(uint8_t)) +
         2 * tree.tier_begin.size() * sizeof(uint32_t) + tree.chunk_count * sizeof(uint32_t);
}

void PartitionedSearch::drop() noexcept {
  known_ = false;
  const auto empty = [](auto& array) {
    std::decay_t<decltype(array)>(array.get_allocator()).swap(array);
  };
  empty(watch_), empty(refined_), empty(cut_slots_), empty(last_cut_slots_);
  empty(stand_ins_), empty(changes_), empty(opened_);
}

void PartitionedSearch::make_room() {
  const size_t places = tree_.subtrees.size();
  drop();  // watch_ comes last: where it has room all have
  refined_.resize(places);
  cut_slots_.resize(places);
  last_cut_slots_.resize(places);
  if (tree_.chunks_come_and_go) stand_ins_.resize(places);
  const size_t runs = std::max(blocks_.size(), places / kRoundSubtrees + 1);
  changes_.reserve(runs);
  while (changes_.size() < runs) changes_.emplace_back(cut_.get_allocator().resource());
  watch_.resize(places);
}

void PartitionedSearch::run(const CutQuery& query, Search kind, Workers& workers) {
  assert(kind == Search::streaming || kind == Search::temporal || kind == Search::temporal_visit);
  stats_ = {};
  stats_.ran = kind;
  if (known_ && query == query_ && kind == Search::temporal && !relinked_) {
    stats_.stand_ins = count_stand_ins();
    relisted_ = false;
    return;
  }
  begin(query);
  if (continues_ && kind != Search::streaming)
    repair(kind, workers);
  else
    stream(workers);
  finish(workers);
}

void PartitionedSearch::begin(const CutQuery& query) {
  if (watch_.size() != tree_.subtrees.size()) make_room();
  continues_ = known_;
  known_ = false;
  relisted_ = std::exchange(relinked_, false) || !continues_;
  if (!continues_) references_.clear();
  places_ = tree_.places();
  query_ = query;
  references_.begin_frame(query);
  sight_ = make_sight(query);
  total_ = {};
  if (++stamp_ == 0) {
    std::fill(chunk_stamp_.begin(), chunk_stamp_.end(), 0);
    stamp_ = 1;
  }
}

void PartitionedSearch::finish(Workers& workers) {
  workers.for_blocks(blocks_.size(), kBlocksTask, [&](size_t first, size_t last) {
    Tally tally;
    for (size_t b = first; b < last; ++b)
      if (touched_[b] != 0) settle(b, tally);
    count(tally);
  });
  relisted_ = relisted_ || total_.entered + total_.left != 0;
  if (relisted_) list_cut(workers);
  stats_.nodes_tested = total_.tested;
  stats_.subtrees_visited = total_.visited;
  stats_.chunks_read = total_.chunks;
  stats_.bytes_read = total_.bytes;
  stats_.entered = total_.entered;
  stats_.left = total_.left;
  stats_.stand_ins = count_stand_ins();
  needed_missing_ = total_.needed_missing;
  known_ = needed_missing_ == kNoNode;
}

void PartitionedSearch::count(const Tally& tally) {
  const std::lock_guard lock(total_mutex_);
  total_.tested += tally.tested;
  total_.visited += tally.visited;
  total_.chunks += tally.chunks;
  total_.bytes += tally.bytes;
  total_.entered += tally.entered;
  total_.left += tally.left;
  total_.needed_missing = std::min(total_.needed_missing, tally.needed_missing);
  total_.first_opened = std::min(total_.first_opened, tally.first_opened);
  total_.last_opened = std::max(total_.last_opened, tally.last_opened);
}

size_t PartitionedSearch::block_of(uint32_t subtree) const {
  const auto& begin = tree_.tier_begin;
  const auto tier =
      static_cast<size_t>(std::upper_bound(begin.begin(), begin.end(), subtree) - begin.begin()) -
      1;
  return tier_block_[tier] + (subtree - begin[tier]) / kBlockSubtrees;
}

// By tasks that share a block.
void PartitionedSearch::touch(size_t block) {
  std::atomic_ref<uint8_t>(touched_[block]).store(1, std::memory_order_relaxed);
}

void PartitionedSearch::read_chunk_of(uint32_t subtree, AtChunk& at, Tally& tally) {
  if (subtree < at.end) return;
  at.chunk = tree_.chunk_with(subtree, at.chunk);
  at.end = tree_.chunk(at.chunk).last_subtree;
  tally.chunks += mark_read(at.chunk);
}

// True for the first of a run.
bool PartitionedSearch::mark_read(uint32_t chunk) {
  return std::atomic_ref<uint32_t>(chunk_stamp_[chunk])
             .exchange(stamp_, std::memory_order_relaxed) != stamp_;
}

// Visits an open subtree. Gives the slots whose verdict is not what it was.
uint32_t PartitionedSearch::look(uint32_t subtree, Tally& tally) {
  const uint32_t place = places_(subtree);
  const SearchSubtree& s = tree_.subtrees[place];
  const Visit found = visit(s, sight_, [&](uint32_t i) -> const SearchRecord& {
    return tree_.records[s.record(i, tree_.next_block.data())];
  });
  ++tally.visited;
  tally.tested += found.tested;
  tally.bytes += sizeof s + found.tested * sizeof(SearchRecord) + 2 * sizeof(uint32_t);
  const uint32_t before = refined_[place];
  refined_[place] = found.refined;
  cut_slots_[place] = found.cut;
  if (!stand_ins_.empty()) stand_ins_[place] = static_cast<uint8_t>(count_bits(found.stand_ins));
  watch_[place] = make_watch(found.slack, found.extent, references_.current());
  return (before ^ found.refined) & s.interior;
}

void PartitionedSearch::close(uint32_t subtree) {
  const uint32_t place = places_(subtree);
  refined_[place] = 0;
  cut_slots_[place] = 0;
  if (!stand_ins_.empty()) stand_ins_[place] = 0;
  watch_[place] = kNever;
}

uint64_t PartitionedSearch::count_stand_ins() const {
  uint64_t nodes = 0;
  for (const Block& block : blocks_) nodes += block.stand_ins;
  return nodes;
}

void PartitionedSearch::relink(std::span<const uint32_t> unlinked,
                               std::span<const uint32_t> changed) {
  relinked_ = true;
  if (!known_) return;
  places_ = tree_.places();
  // What leads to a subtree that was linked again says nothing new: it stays as it was, at other
  // addresses.
  for (const uint32_t s : unlinked) {
    if (tree_.subtree(s).entry == kNotLinked) close(s);
    touch(block_of(s));
  }
  for (const uint32_t s : changed)
    if (refined_[places_(s)] != 0) watch_[places_(s)] = kDue;
}

}  // namespace voyager
