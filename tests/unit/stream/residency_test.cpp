#include "runtime/stream/residency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "runtime/stream/staged_chunk.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::residency_test {
namespace {

// Chunks that come and go in any order, a few in each commit, while some are refused; what a stream
// does with them, without one.
class RandomStream {
 public:
  RandomStream(test::TreeShape shape, double share, uint32_t seed)
      : random_(seed),
        file_(
            test::source_of(test::scene_bytes(test::baked_of(test::random_tree(shape, 3000, seed)),
                                              Quality::lossless, 0, kMinChunkBytes))),
        slots_(std::max(top(), static_cast<uint32_t>(share * graph_.size()))),
        residency_(graph_, file_.chunks(), records_,
                   PoolRoom{slots_, slots_ * records_.most_blocks()}, top()) {
    plan(true, false);
  }

  // Of a hundred chunks that are read, or arrive, so many fail; with none, nobody moves either.
  void step(uint32_t failing) {
    switch (random_() % (failing == 0 ? 5 : 6)) {
      case 0:
        return read();
      case 1:
        if (!coming_.empty()) decode(take(coming_), failing);
        return;
      case 2:
        return put();
      case 3:
        if (!filling_.empty()) residency_.filled(take(filling_));
        return;
      case 4:
        if (residency_.changes() != 0) commit(1 + random_() % 4, failing);
        return;
      default:
        if (chance(2)) plan(chance(70), chance(50));
    }
  }
  void plan(bool looks, bool in_haste) {
    for (const uint32_t chunk : failed_) residency_.retry(chunk);
    failed_.clear();
    looks_.begin(looks ? std::vector<Viewer>{{{{0, 0, 0}, 1e-30f}, {}, false}}
                       : std::vector<Viewer>{});
    residency_.plan(looks_, chance(50), in_haste);
  }
  bool settled() const {
    return residency_.settled([](uint32_t) { return false; }) && residency_.changes() == 0 &&
           coming_.empty() && ready_.empty() && filling_.empty();
  }
  size_t held() const { return held_.size(); }
  size_t waited() const { return waited_; }
  uint32_t slots() const { return slots_; }

 private:
  bool chance(uint32_t of_a_hundred) { return random_() % 100 < of_a_hundred; }
  uint32_t take(std::vector<uint32_t>& from) {
    std::swap(from[random_() % from.size()], from.back());
    const uint32_t chunk = from.back();
    from.pop_back();
    return chunk;
  }
  uint32_t top() const {
    uint32_t top = 1;
    while (top < graph_.size() && !graph_.has_parents(top)) ++top;
    return top;
  }

  void read() {
    const ChunkRange range = residency_.take_requests(1 + random_() % 8, UINT64_MAX);
    for (uint32_t chunk = range.first; chunk < range.last; ++chunk) coming_.push_back(chunk);
  }
  void decode(uint32_t chunk, uint32_t failing) {
    if (chance(failing)) {
      residency_.failed(chunk);
      failed_.insert(chunk);
    } else if (residency_.read(chunk, records_.most_blocks(chunk))) {
      ready_.push_back(chunk);
    }
  }
  void put() {
    if (ready_.empty()) return;
    if (residency_.keep(ready_.back())) {
      if (residency_.take_slot(ready_.back()) == Residency::kNoSlot) return;
      filling_.push_back(ready_.back());
    }
    ready_.pop_back();
  }

  void commit(size_t most, uint32_t failing) {
    const std::vector<Residency::Evicted> evicted = residency_.evict(most);
    const Residency::Arrivals arrivals = residency_.begin_arrivals(most);
    EXPECT_LE(evicted.size(), most);
    EXPECT_LE(arrivals.arriving.size(), most);
    if (!filling_.empty()) residency_.filled(take(filling_));  // while chunks are linked
    for (const Residency::Evicted& e : evicted) {
      EXPECT_EQ(held_.erase(e.chunk), 1u);
      for (const uint32_t chunk : held_)
        for (const uint32_t p : graph_.parents(chunk)) ASSERT_NE(p, e.chunk);
    }
    std::vector<Residency::Arrival> how;
    waits_.clear();
    for (const uint32_t chunk : arrivals.arriving) how.push_back(link(chunk, failing));
    for (size_t i = 0; i < how.size(); ++i) residency_.end_arrival(arrivals.arriving[i], how[i]);
    for (const Residency::Evicted& e : evicted) residency_.free(e);
    EXPECT_EQ(residency_.resident(), held_.size());
  }
  Residency::Arrival link(uint32_t chunk, uint32_t failing) {
    bool waits = false;
    for (const uint32_t p : graph_.parents(chunk)) {
      if (held_.count(p) != 0) continue;
      waits = true;
      EXPECT_TRUE(failed_.count(p) != 0 || waits_.count(p) != 0)
          << chunk << " came before what it hangs from";
    }
    if (waits) {
      waits_.insert(chunk);
      ++waited_;
      return Residency::Arrival::waiting;
    }
    if (chance(failing) && graph_.has_parents(chunk)) {
      failed_.insert(chunk);
      return Residency::Arrival::failed;
    }
    held_.insert(chunk);
    return Residency::Arrival::resident;
  }

  std::mt19937 random_;
  const SceneFile file_;
  const Tiers tiers_ = file_.tiers();
  const ChunkGraph graph_{file_.chunks(), tiers_};
  const RecordRoom records_{file_};
  const uint32_t slots_;
  Residency residency_;
  ChunkLooks looks_{file_.chunks()};
  std::vector<uint32_t> coming_, ready_, filling_;
  std::set<uint32_t> held_, failed_, waits_;  // waits_: in this commit
  size_t waited_ = 0;
};

TEST(Residency, WhateverComesAndFailsAFewAtATimeAllThatHasRoomIsThereInTheEnd) {
  size_t waited = 0;
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const double share : {0.3, 1.0}) {
      SCOPED_TRACE(test::name_of(shape) + " " + std::to_string(share));
      RandomStream stream(shape, share, 7);
      for (int i = 0; i < 4000; ++i) stream.step(10);
      stream.plan(true, false);
      for (int i = 0; i < 100000 && !stream.settled(); ++i) stream.step(0);
      EXPECT_TRUE(stream.settled());
      EXPECT_EQ(stream.held(), stream.slots());
      waited += stream.waited();
    }
  EXPECT_GT(waited, 0u);
}

bool share_a_parent(const ChunkGraph& graph, uint32_t a, uint32_t b) {
  const auto above_b = graph.parents(b);
  for (const uint32_t p : graph.parents(a))
    if (std::find(above_b.begin(), above_b.end(), p) != above_b.end()) return true;
  return false;
}

// Of viewers that jump about, and see half of space.
TEST(Residency, APlanInHasteLeavesOutNothingThatIsSeenAndNothingThatHasRoom) {
  const SceneFile file(test::source_of(
      test::scene_bytes(test::baked_of(test::random_tree(test::TreeShape::four_way, 3000, 5)),
                        Quality::lossless, 0, kMinChunkBytes)));
  const Tiers tiers = file.tiers();
  const ChunkGraph graph(file.chunks(), tiers);
  const RecordRoom records(file);
  const uint32_t slots = graph.size() / 4;
  const PoolRoom room{slots, slots * records.most_blocks()};
  Residency whole(graph, file.chunks(), records, room, slots / 8);
  Residency hasty(graph, file.chunks(), records, room, slots / 8);
  ChunkLooks looks(file.chunks());
  const EntryHull hull = file.chunks().hull(0);
  std::mt19937 random(3);
  size_t left_out = 0;
  for (int i = 0; i < 40; ++i) {
    if (i == 20) {  // from here on with families that are known
      for (uint32_t first = 0, last; first < graph.size(); first = last) {
        const uint32_t most = 1 + random() % 4;
        for (last = first + 1; last < graph.size() && last - first < most; ++last)
          if (!share_a_parent(graph, first, last)) break;
        whole.set_family({first, last}), hasty.set_family({first, last});
      }
      hasty.plan(looks, false);
    }
    Vec3f eye{};
    for (int axis = 0; axis < 3; ++axis)
      eye[axis] =
          hull.box_min[axis] + (hull.box_max[axis] - hull.box_min[axis]) * test::unit(random);
    const Vec3f ahead{i % 2 == 0 ? 1.0f : -1.0f, 0, 0};
    looks.begin({{{eye, 0.01f}, {{eye, {ahead, ahead, ahead, ahead, ahead}}}, false}});
    whole.plan(looks, false);
    hasty.plan(looks, false, true);
    if (hasty.left_out()) {
      ++left_out;
      EXPECT_LT(hasty.needed().size(), whole.needed().size());
    }
    EXPECT_EQ(hasty.need().seen, whole.need().seen);
    EXPECT_EQ(hasty.need().seen_missing, whole.need().seen_missing);
    for (uint32_t chunk = 0; chunk < graph.size(); ++chunk)
      ASSERT_EQ(hasty.is_wanted(chunk), whole.is_wanted(chunk)) << i << " " << chunk;
    // From one place all is counted.
    hasty.plan(looks, false);
    EXPECT_FALSE(hasty.left_out());
    hasty.plan(looks, false, true);
    EXPECT_EQ(hasty.need().chunks, whole.need().chunks);
    EXPECT_EQ(hasty.need().missing_bytes, whole.need().missing_bytes);
  }
  EXPECT_GT(left_out, 10u);
}

// Of many that have come the wrong way round, a few in each commit.
TEST(Residency, LinksParentsFirstHoweverManyWait) {
  const SceneFile file(test::source_of(
      test::scene_bytes(test::baked_of(test::random_tree(test::kTreeShapes[0], 3000, 5)),
                        Quality::lossless, 0, kMinChunkBytes)));
  const Tiers tiers = file.tiers();
  const ChunkGraph graph(file.chunks(), tiers);
  const RecordRoom records(file);
  uint32_t top = 1;
  while (top < graph.size() && !graph.has_parents(top)) ++top;
  Residency residency(graph, file.chunks(), records,
                      PoolRoom{graph.size(), graph.size() * records.most_blocks()}, top);
  ChunkLooks looks(file.chunks());
  looks.begin({{{{0, 0, 0}, 1e-30f}, {}, false}});
  residency.plan(looks, false);
  std::vector<uint32_t> all;
  for (;;) {
    const ChunkRange range = residency.take_requests(16, UINT64_MAX);
    if (range.empty()) break;
    for (uint32_t chunk = range.first; chunk < range.last; ++chunk) {
      ASSERT_TRUE(residency.read(chunk, records.most_blocks(chunk)));
      ASSERT_TRUE(residency.keep(chunk));
      ASSERT_NE(residency.take_slot(chunk), Residency::kNoSlot);
      all.push_back(chunk);
    }
  }
  ASSERT_EQ(all.size(), graph.size());
  std::sort(all.rbegin(), all.rend());
  for (const uint32_t chunk : all) residency.filled(chunk);
  std::set<uint32_t> there;
  while (residency.changes() != 0) {
    const Residency::Arrivals arrivals = residency.begin_arrivals(3);
    ASSERT_LE(arrivals.arriving.size(), 3u);
    for (const uint32_t chunk : arrivals.arriving) {
      for (const uint32_t p : graph.parents(chunk)) ASSERT_EQ(there.count(p), 1u);
      there.insert(chunk);
      residency.end_arrival(chunk, Residency::Arrival::resident);
    }
  }
  EXPECT_EQ(there.size(), graph.size());
}

}  // namespace
}  // namespace voyager::residency_test
