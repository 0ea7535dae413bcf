#include "cuda/splat/splat_state.h"

#include <algorithm>

#include "runtime/base/error.h"

namespace voyager::cuda {
namespace {

constexpr size_t kFirstPlaces = size_t{1} << 18, kFirstSlots = kFirstPlaces;
constexpr size_t kFirstStrips = size_t{1} << 19, kFirstPairs = size_t{1} << 20;
// Indices of 32 bits, and sums of two of them.
constexpr size_t kMostIndices = size_t{1} << 31;

size_t counter_bytes(size_t tiles) {
  return sizeof(PassCounters) + (kPasses + 1) * tiles * sizeof(uint32_t);
}

size_t rows_for(size_t places) {
  return (places + kRowPlaces - 1) / kRowPlaces;
}

size_t sums_for(size_t places) {
  return (rows_for(places) + kSumRows - 1) / kSumRows;
}

// Of a frame: each pass has as many as instances.
constexpr uint32_t kRankTags = kPasses * (kMaxInstances + 1);

// Filled with tag 0, which no frame uses.
Buffer<unsigned long long> make_sums(size_t places) {
  Buffer<unsigned long long> sums(sums_for(places));
  fill(sums, 0);
  return sums;
}

// Allocates with some to spare, else as much as is wanted, else what there was. False
// where that did not help. Throws where not even that is left.
template <class Allocate>
bool grow_to(size_t wanted, size_t before, const Allocate& allocate) {
  const size_t least = std::min(wanted, kMostIndices);
  if (least <= before) return false;
  for (const size_t room : {std::min(least + least / 4, kMostIndices), least}) {
    try {
      allocate(room);
      return true;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::over_budget) throw;
    }
  }
  allocate(before);
  return false;
}

}  // namespace

FrameTiles frame_tiles(const FrameInput& frame) {
  FrameTiles tiles{};
  tiles.eyes = static_cast<uint32_t>(frame.eyes.size());
  for (size_t eye = 0; eye < kMaxEyes; ++eye) {
    if (eye < tiles.eyes)
      tiles.grids[eye] = tile_grid(frame.eyes[eye].camera.width, frame.eyes[eye].camera.height);
    const TileGrid& grid = tiles.grids[eye];
    tiles.first[eye + 1] =
        tiles.first[eye] + static_cast<uint32_t>(grid.columns) * static_cast<uint32_t>(grid.rows);
  }
  return tiles;
}

SplatRoom room_for(const PassCounters& passes) {
  SplatRoom room;
  for (const SplatCounters& counters : passes) {
    room.places = std::max<size_t>(room.places, counters.places);
    room.slots = std::max<size_t>(room.slots, counters.slots);
    room.strips = std::max<size_t>(room.strips, counters.strip_room);
    room.pairs = std::max<size_t>(room.pairs, counters.pairs);
  }
  return room;
}

uint64_t dropped(const PassCounters& passes, const SplatRoom& room) {
  const auto beyond = [](uint64_t counted, size_t there) {
    return counted > there ? counted - there : 0;
  };
  uint64_t sum = 0;
  for (const SplatCounters& counters : passes)
    sum += beyond(counters.places, room.places) + beyond(counters.slots, room.slots) +
           counters.strips_dropped + beyond(counters.pairs, room.pairs);
  return sum;
}

SplatState::SplatState(unsigned bin_blocks, uint32_t eyes)
    : bin_blocks_(bin_blocks),
      eyes_(eyes),
      rows_(rows_for(kFirstPlaces)),
      ranks_(rows_for(kFirstPlaces)),
      rank_sums_(make_sums(kFirstPlaces)),
      records_(kFirstSlots * eyes),
      whole_(kFirstSlots),
      blended_(kFirstSlots),
      keys_(kFirstPairs),
      merge_keys_(kFirstPairs),
      strips_(kFirstStrips) {}

void SplatState::fit(const FrameTiles& of) {
  if (fits(of)) return;
  const size_t tiles = of.count();
  counters_ = Buffer<unsigned char>(counter_bytes(tiles));
  tile_offsets_ = Buffer<uint32_t>(tiles * bin_blocks_);
  tile_order_ = Buffer<uint32_t>(tiles);
  tiles_ = Buffer<TileList>(tiles);
}

// The old buffers go first: nothing in them outlives a frame.
bool SplatState::grow_places(size_t wanted) {
  return grow_to(wanted, room().places, [&](size_t places) {
    rows_ = {}, ranks_ = {}, rank_sums_ = {};
    rows_ = Buffer<uint32_t>(rows_for(places));
    ranks_ = Buffer<RankRow>(rows_for(places));
    rank_sums_ = make_sums(places);
  });
}

bool SplatState::grow_slots(size_t wanted) {
  return grow_to(wanted, room().slots, [&](size_t slots) {
    records_ = {}, whole_ = {}, blended_ = {};
    records_ = Buffer<SplatRecord>(slots * eyes_);
    whole_ = Buffer<Candidate>(slots);
    blended_ = Buffer<Candidate>(slots);
  });
}

bool SplatState::grow_strips(size_t wanted) {
  return grow_to(wanted, strips_.size(), [&](size_t strips) {
    strips_ = {};
    strips_ = Buffer<TileStrip>(strips);
  });
}

bool SplatState::grow_pairs(size_t wanted) {
  return grow_to(wanted, room().pairs, [&](size_t pairs) {
    keys_ = {}, merge_keys_ = {};
    keys_ = Buffer<DepthKey>(pairs);
    merge_keys_ = Buffer<DepthKey>(pairs);
  });
}

bool SplatState::grow(const SplatRoom& wanted) {
  // All of them, whatever becomes of one.
  const bool places = grow_places(wanted.places), slots = grow_slots(wanted.slots),
             strips = grow_strips(wanted.strips), pairs = grow_pairs(wanted.pairs);
  return places || slots || strips || pairs;
}

SplatView SplatState::view(const FrameTiles& tiles, int pass) const {
  auto* const passes = reinterpret_cast<SplatCounters*>(counters_.data());
  auto* const counts = reinterpret_cast<uint32_t*>(passes + kPasses);
  SplatView view{};
  view.records = records_.data();
  view.whole = whole_.data();
  view.blended = blended_.data();
  view.slots = static_cast<uint32_t>(room().slots);
  view.rows = rows_.data();
  view.ranks = ranks_.data();
  view.places = static_cast<uint32_t>(room().places);
  view.rank_sums = rank_sums_.data();
  view.rank_tag = rank_tag_ + static_cast<uint32_t>(pass) * kRankTags / kPasses;
  view.strips = strips_.data();
  view.strip_room = static_cast<uint32_t>(strips_.size());
  view.keys = keys_.data();
  view.merge_keys = merge_keys_.data();
  view.pairs = static_cast<uint32_t>(room().pairs);
  view.counters = passes + pass;
  view.tile_counts = counts + static_cast<size_t>(pass) * tiles.count();
  view.tile_offsets = tile_offsets_.data();
  view.tiles = tiles_.data();
  view.tile_order = tile_order_.data();
  view.ends = counts + static_cast<size_t>(kPasses) * tiles.count();
  view.open_parts = pass == 0 ? nullptr : &passes->open_parts;
  view.frame = tiles;
  return view;
}

void SplatState::begin_frame(const FrameTiles& tiles, cudaStream_t stream) {
  if (rank_tag_ > UINT32_MAX - 2 * kRankTags) {
    check(cudaMemsetAsync(rank_sums_.data(), 0, rank_sums_.bytes(), stream), "sums of ranks");
    rank_tag_ = 0;
  }
  rank_tag_ += kRankTags;
  check(cudaMemsetAsync(counters_.data(), 0, counter_bytes(tiles.count()), stream),
        "a frame's counters");
}

}  // namespace voyager::cuda
