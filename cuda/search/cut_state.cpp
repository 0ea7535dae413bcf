#include "cuda/search/cut_state.h"

#include <algorithm>
#include <vector>

#include "cuda/device/upload_made.h"
#include "runtime/select/partitioned_blocks.h"

namespace voyager::cuda {
namespace {

struct Layout {
  std::vector<Block> blocks;
  std::vector<Tier> tiers;
};

Layout make_layout(const SearchTree& tree) {
  Layout layout;
  for (size_t tier = 0; tier + 1 < tree.tier_begin.size(); ++tier) {
    const uint32_t begin = tree.tier_begin[tier], end = tree.tier_begin[tier + 1];
    const uint32_t count = (end - begin + kBlockSubtrees - 1) / kBlockSubtrees;
    const auto first_block = static_cast<uint32_t>(layout.blocks.size());
    layout.tiers.push_back({begin, first_block, count});
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t first = begin + i * kBlockSubtrees;
      layout.blocks.push_back(
          {first, std::min(end, first + kBlockSubtrees), kLevels * first_block + i, count});
    }
  }
  return layout;
}

// What search_place gives so many nodes; and the ends of roomy segments, as long as these take no
// more than another place in eight. Else the list of a scene of which few chunks are resident would
// be mostly ends. Where a cut needs more, its segments are less roomy (SegmentFit).
uint64_t most_places_of(uint64_t nodes) {
  return nodes + nodes / 8;
}
uint64_t ends_of_segments(const SearchTree& tree) {
  return 2 * kRowPlaces * kLevels * block_count(tree, kBlockSubtrees);
}
constexpr uint64_t kLeastPlaces = 2 * kRowPlaces;
uint64_t most_places(const SearchTree& tree, uint64_t most) {
  return most_places_of(most) + std::min(ends_of_segments(tree), most / 8) + kLeastPlaces;
}

uint64_t list_bytes(uint64_t places) {
  return places * sizeof(uint32_t) + places * sizeof(MeanBounds) / kRowPlaces;
}

}  // namespace

uint64_t CutState::eight_nodes() {
  static_assert(sizeof(MeanBounds) % kRowPlaces == 0);  // a place's share of them is whole bytes
  return list_bytes(most_places_of(8));
}

uint64_t CutState::ends_of_eight() {
  return list_bytes(1);
}
uint64_t CutState::most_ends(const SearchTree& tree) {
  return list_bytes(ends_of_segments(tree));
}

uint64_t CutState::fixed_bytes(const SearchTree& tree) {
  constexpr uint64_t kMostArrays = 32;  // that the constructor allocates together
  constexpr uint64_t kBlock = sizeof(Block) + kBlockRows * sizeof(WatchRow) +
                              kLevels * sizeof(Segment) + 4 * sizeof(uint32_t);
  const uint64_t blocks = block_count(tree, kBlockSubtrees);
  const uint64_t windows = SegmentWindows(static_cast<uint32_t>(kLevels * blocks)).end();
  return blocks * kBlock + windows * sizeof(WindowPlaces) + tree.tier_begin.size() * sizeof(Tier) +
         2 * sizeof(FrameCounters) + 2 * sizeof(uint32_t) + sizeof(MeanBounds) +
         list_bytes(kLeastPlaces) + kMostArrays * kAllocationAlignment;
}

CutState::CutState(const SearchTree& tree, uint32_t places, uint32_t due, size_t most) {
  const Layout layout = make_layout(tree);
  const size_t blocks = layout.blocks.size();
  const size_t segments = kLevels * blocks, room = most_places(tree, most);
  allocate_together(ToAllocate{blocks_, blocks}, ToAllocate{tiers_, layout.tiers.size()},
                    ToAllocate{watch_, places}, ToAllocate{rows_, blocks * kBlockRows},
                    ToAllocate{refined_, places}, ToAllocate{cut_, places},
                    ToAllocate{stand_ins_, tree.chunks_come_and_go ? places : 0},
                    ToAllocate{segments_, segments},
                    ToAllocate{windows_, SegmentWindows(static_cast<uint32_t>(segments)).end()},
                    ToAllocate{open_counts_, blocks}, ToAllocate{open_blocks_, blocks},
                    ToAllocate{open_block_count_, 1}, ToAllocate{dirty_flags_, blocks},
                    ToAllocate{dirty_, blocks}, ToAllocate{due_, due}, ToAllocate{signals_, places},
                    ToAllocate{counters_, 2},  // counting, counted
                    ToAllocate{nodes_, room}, ToAllocate{bounds_, room / kRowPlaces + 1});
  upload<Block>(layout.blocks, blocks_);
  upload<Tier>(layout.tiers, tiers_);
  upload_made(watch_, [](size_t) { return Watch{INFINITY, 0}; });
  for (const Buffer<uint32_t>* zero :
       {&refined_, &cut_, &open_counts_, &open_blocks_, &open_block_count_, &dirty_flags_, &dirty_})
    fill(*zero, 0);
  fill(stand_ins_, 0);
  fill(rows_, 0);  // not known
  fill(segments_, 0);
  fill(nodes_, 0xff);
  fill(signals_, 0xff);
  fill(counters_, 0);
}

StateView CutState::view(SubtreePlaces places) const {
  return {places,
          static_cast<uint32_t>(watch_.size()),
          watch_.data(),
          refined_.data(),
          cut_.data(),
          stand_ins_.data(),
          rows_.data(),
          blocks_.data(),
          tiers_.data(),
          static_cast<uint32_t>(blocks_.size()),
          static_cast<uint32_t>(tiers_.size()),
          segments_.data(),
          windows_.data(),
          open_counts_.data(),
          open_blocks_.data(),
          open_block_count_.data(),
          dirty_flags_.data(),
          dirty_.data(),
          due_.data(),
          static_cast<uint32_t>(due_.size()),
          signals_.data(),
          counters_.data(),
          counters_.data() + 1,
          nodes_.data(),
          list_room(),
          bounds_.data()};
}

}  // namespace voyager::cuda
