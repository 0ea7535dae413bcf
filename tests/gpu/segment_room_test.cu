// Where segments of a cut's list have no room, the narrowest window around each that has enough
// shares its room out, and nothing else moves.
#include <map>
#include <random>
#include <set>
#include <vector>

#include "cuda/search/segment_room.cuh"
#include "tests/gpu/device_test.h"
#include "tests/gpu/test_share.h"

namespace voyager::test {
namespace segment_room_test {
namespace {

using cuda::Buffer;
using cuda::download;
using cuda::kLevels;
using cuda::Segment;
using cuda::SegmentFit;
using cuda::SegmentWindows;
using cuda::StateView;

struct Outcome {
  uint32_t made, dirty;
};

__global__ void make_room(StateView state, SegmentFit fit, Outcome* outcome) {
  __shared__ cuda::BlockScan::TempStorage storage;
  __shared__ cuda::RoomAmongNeighbours room;
  __shared__ cuda::Dirty dirty;
  room.begin(state, fit);
  if (threadIdx.x == 0) dirty = {state.dirty, state.dirty_flags, 0};
  __syncthreads();
  for (uint32_t i = threadIdx.x; i < kLevels * state.block_count; i += cuda::kScanThreads)
    if (state.segments[i].size > state.segments[i].room) room.mark(i);
  __syncthreads();
  const bool made = room.make(state, storage, dirty);
  __syncthreads();
  if (threadIdx.x == 0) *outcome = {made, dirty.count};
}

// The narrowest window around a segment that has room; a count of 0 means that there is none.
struct Window {
  uint32_t first, count;
};
class Expected {
 public:
  Expected(const std::vector<Segment>& segments, SegmentFit fit) : windows_(count_of(segments)) {
    places_.resize(windows_.end());
    for (uint32_t level = windows_.depth + 1; level-- != 0;)
      for (uint32_t window = 1u << level; window < 2u << level; ++window) {
        if (level < windows_.depth) {
          places_[window] = places_[2 * window] + places_[2 * window + 1];
          continue;
        }
        const auto [first, last] = windows_.segments_of(window, level);
        for (uint32_t i = first; i < last; ++i)
          places_[window] =
              places_[window] +
              cuda::WindowPlaces{cuda::least_room(segments[i].size, fit), segments[i].room};
      }
  }

  Window around(uint32_t segment) const {
    uint32_t window = windows_.around(segment), level = windows_.depth;
    while (!places_[window].fits()) {
      if (level-- == 0) return {0, 0};
      window /= 2;
    }
    const auto [first, last] = windows_.segments_of(window, level);
    return {first, last - first};
  }

 private:
  static uint32_t count_of(const std::vector<Segment>& segments) {
    return static_cast<uint32_t>(segments.size());
  }
  SegmentWindows windows_;
  std::vector<cuda::WindowPlaces> places_;
};

class SegmentRoom : public DeviceTest {
 protected:
  std::mt19937 random{5};
  size_t narrow = 0, wide = 0;  // windows in which room was made

  uint32_t below(uint32_t most) { return random() % most; }

  // A quarter of the segments is empty and has no room.
  std::vector<Segment> list_of(uint32_t blocks, SegmentFit fit) {
    std::vector<Segment> segments(kLevels * blocks);
    uint32_t first = 0;
    for (Segment& s : segments) {
      s.size = below(4) == 0 ? 0 : below(600);
      s.first = first;
      first += s.room = cuda::segment_room(s.size, fit);
    }
    return segments;
  }

  // So many in a row grow by this share. Of the rest one of 500 grows by half, and a fifth shrinks.
  void grow(std::vector<Segment>& segments, uint32_t count, double by) {
    const auto all = static_cast<uint32_t>(segments.size());
    const uint32_t from = below(all);
    for (uint32_t k = 0; k < all; ++k) {
      uint32_t& size = segments[(from + k) % all].size;
      if (k < count)
        size += static_cast<uint32_t>(by * size) + (below(3) == 0 ? 40 : 0);
      else if (below(500) == 0)
        size += size / 2;
      else if (below(5) == 0)
        size /= 2;
    }
  }

  // Whether room was made.
  bool check(const std::vector<Segment>& before, SegmentFit fit) {
    const auto count = static_cast<uint32_t>(before.size()), blocks = count / kLevels;
    const Buffer<Segment> segments = cuda::upload(std::span<const Segment>(before));
    const Buffer<cuda::WindowPlaces> windows(SegmentWindows(count).end());
    const std::vector<cuda::Tier> tiers_of{{0, 0, blocks / 3},
                                           {blocks / 3 * 512, blocks / 3, blocks - blocks / 3}};
    const Buffer<cuda::Tier> tiers = cuda::upload(std::span<const cuda::Tier>(tiers_of));
    const Buffer<uint32_t> dirty(blocks), flags(blocks);
    cuda::fill(flags, 0);
    const Buffer<Outcome> outcome(1);
    StateView state{};
    state.block_count = blocks;
    state.segments = segments.data();
    state.windows = windows.data();
    state.tiers = tiers.data();
    state.tier_count = 2;
    state.dirty = dirty.data();
    state.dirty_flags = flags.data();
    make_room<<<1, cuda::kScanThreads>>>(state, fit, outcome.data());
    cuda::check(cudaGetLastError(), "make room");
    const Outcome found = download(outcome)[0];
    expect(before, download(segments), download(dirty), found, tiers_of, fit);
    return found.made != 0;
  }

 private:
  static uint32_t block_of(uint32_t segment, const std::vector<cuda::Tier>& tiers) {
    const cuda::Tier& tier = tiers[segment >= kLevels * tiers[1].first_block];
    return tier.first_block + (segment - kLevels * tier.first_block) % tier.blocks;
  }

  void expect(const std::vector<Segment>& before, const std::vector<Segment>& after,
              const std::vector<uint32_t>& dirty, const Outcome& found,
              const std::vector<cuda::Tier>& tiers, SegmentFit fit) {
    const Expected expected(before, fit);
    std::map<uint32_t, uint32_t> windows;  // by the first segment, how many
    bool enough = true;
    for (uint32_t i = 0; i < before.size(); ++i) {
      if (before[i].size <= before[i].room) continue;
      const Window window = expected.around(i);
      enough = enough && window.count != 0;
      windows[window.first] = std::max(windows[window.first], window.count);
    }
    ASSERT_EQ(found.made != 0, enough) << before.size();
    std::vector<bool> moves(before.size(), false);
    if (enough)
      for (const auto& [first, count] : windows) {
        std::fill_n(moves.begin() + first, count, true);
        narrow += count <= 64;
        wide += count > 4096;
      }
    std::set<uint32_t> blocks;
    for (uint32_t i = 0; i < before.size(); ++i) {
      if (moves[i] && before[i].size != 0) blocks.insert(block_of(i, tiers));
      ASSERT_EQ(after[i].size, before[i].size);
      if (enough) {
        ASSERT_GE(after[i].room, after[i].size) << i;
      }
      if (moves[i]) {
        ASSERT_GE(after[i].room, cuda::least_room(after[i].size, fit)) << i;
        ASSERT_EQ(after[i].room % cuda::kRowPlaces, 0u) << i;
        ASSERT_EQ(after[i].first % cuda::kRowPlaces, 0u) << i;
      }
      if (i + 1 < before.size()) {
        ASSERT_LE(after[i].first + after[i].room, after[i + 1].first) << i;
      }
      if (moves[i]) continue;
      ASSERT_EQ(after[i].first, before[i].first) << i;
      ASSERT_EQ(after[i].room, before[i].room) << i;
    }
    ASSERT_LE(after.back().first + after.back().room, before.back().first + before.back().room);
    ASSERT_EQ(found.dirty, blocks.size());
    ASSERT_EQ(std::set<uint32_t>(dirty.begin(), dirty.begin() + found.dirty), blocks);
  }
};

TEST_F(SegmentRoom, IsMadeByTheFewestNeighboursThatHaveIt) {
  size_t not_enough = 0;
  for (const uint32_t blocks :
       {3u, 5u, 6u, 40u, 171u, 1366u, 3000u, 11'000u, 49'000u, share_of(400'000u)})
    for (const SegmentFit fit : {SegmentFit::roomy, SegmentFit::rows})
      for (const double by : {0.1, 0.3, 1.5})
        for (const uint32_t part : {1u, 3u, 50u, 100'000u}) {
          std::vector<Segment> segments = list_of(blocks, fit);
          grow(segments, std::max(1u, kLevels * blocks / part), by);
          not_enough += !check(segments, fit);
          if (HasFatalFailure()) return;
        }
  EXPECT_GT(narrow, 1000u);
  EXPECT_GT(wide, 4u);
  EXPECT_GT(not_enough, 20u);
}

}  // namespace
}  // namespace segment_room_test
}  // namespace voyager::test
