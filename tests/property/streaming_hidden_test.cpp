// What is hidden behind what is drawn is asked for last of what is seen; nothing but the order of
// reads depends on it.
#include <algorithm>

#include "tests/support/wall_scene.h"

namespace voyager::streaming_hidden_test {
namespace {

using test::before_the_wall;
using test::behind_the_wall;
using test::expect_same_bits;
using test::Frame;
using test::render;
using test::StreamedWall;

class StreamingHidden : public testing::Test {
 protected:
  Frame whole(const FrameInput& input) const {
    Workers workers;
    const auto memory = std::pmr::get_default_resource();
    return render(*cpu, load_scene(test::source_of(test::wall_bytes()), memory, workers), {},
                  input);
  }
  const std::unique_ptr<Backend> cpu = create_cpu_backend();
};

TEST_F(StreamingHidden, WhatIsBehindAWallIsAskedForLast) {
  StreamedWall with(*cpu, true), without(*cpu, false);
  const Frame frame = with.settle(before_the_wall());
  expect_same_bits(without.settle(before_the_wall()), frame);
  EXPECT_GT(with.behind_later(), without.behind_later() + 0.15);
  expect_same_bits(whole(before_the_wall()), frame);
}

// From the other side, what was hidden is seen, and the other way round.
TEST_F(StreamingHidden, WhoeverHasMovedSeesAndWaitsForTheSame) {
  StreamedWall with(*cpu, true, {}, 0.4), without(*cpu, false, {}, 0.4);
  for (StreamedWall* one : {&with, &without}) one->begin(before_the_wall(), 8);
  const Frame frame = with.settle(behind_the_wall());
  EXPECT_GT(frame.stats.missing, 0u);
  EXPECT_EQ(without.settle(behind_the_wall()).cut, frame.cut);
  EXPECT_EQ(without.stream().counters().resident, with.stream().counters().resident);
  StreamedWall waits(*cpu, true);
  waits.begin(before_the_wall(), 8);
  FrameInput input = behind_the_wall();
  input.wait_resident = true;
  expect_same_bits(waits.draw(input), whole(input));
}

// A plan for who stands before the wall, and what comes of it chunk by chunk.
class Planned {
 public:
  Planned() {
    Viewer viewer;
    viewer.query = {{10, 0, -9}, 0.02f};
    const Vec3f right{1, 0, 0};  // all of what it sees
    viewer.eyes = {{viewer.query.centre, {right, right, right, right, right}}};
    looks_.begin({viewer});
    residency_.plan(looks_, false);
  }
  // All that is asked for. shown(): from then on, before each read.
  template <class Told>
  std::vector<uint32_t> read_all(const Told& shown) {
    std::vector<uint32_t> order;
    for (;;) {
      residency_.set_shown(shown(residency_.slots()));
      const ChunkRange range = residency_.take_requests(1, 0);
      if (range.empty()) return order;
      order.push_back(range.first);
      residency_.read(range.first, records_.most_blocks(range.first));
      residency_.take_slot(range.first);
      residency_.filled(range.first);
      const Residency::Arrivals arrivals = residency_.begin_arrivals(SIZE_MAX);
      EXPECT_EQ(arrivals.arriving.size(), 1u) << range.first << " came before what it hangs from";
      for (const uint32_t chunk : arrivals.arriving)
        residency_.end_arrival(chunk, Residency::Arrival::resident);
    }
  }
  bool is_seen(uint32_t chunk) const { return residency_.is_seen(chunk); }

 private:
  const SceneFile file_{test::source_of(test::wall_bytes())};
  const Tiers tiers_ = file_.tiers();
  const ChunkGraph graph_{file_.chunks(), tiers_};
  const RecordRoom records_{file_};
  ChunkLooks looks_{file_.chunks()};
  Residency residency_{graph_, file_.chunks(), records_,
                       records_.of(static_cast<uint32_t>(2 * file_.chunks().size())), 1};
};

TEST_F(StreamingHidden, WhateverIsToldOnlyTheOrderOfReadsChanges) {
  Planned untold;
  std::vector<uint32_t> all = untold.read_all([](uint32_t) { return ShownChunks(); });
  // A frame that drew nothing hides nothing.
  EXPECT_EQ(Planned().read_all([](uint32_t slots) { return ShownChunks(slots); }), all);
  const auto first_unseen = std::ranges::find_if_not(
      all, [&](uint32_t chunk) { return chunk == 0 || untold.is_seen(chunk); });
  const auto seen = first_unseen - all.begin();
  EXPECT_GT(seen, 50);
  EXPECT_LT(seen + 50, static_cast<std::ptrdiff_t>(all.size()));
  std::ranges::sort(all);
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    Planned planned;
    std::vector<uint32_t> order = planned.read_all([&](uint32_t slots) {
      ShownChunks shown(random() % (slots + 1));
      for (Shown& of : shown) of = static_cast<Shown>(random() % 3);
      return shown;
    });
    const auto unseen = std::ranges::find_if_not(
        order, [&](uint32_t chunk) { return chunk == 0 || planned.is_seen(chunk); });
    EXPECT_EQ(unseen - order.begin(), seen);
    EXPECT_TRUE(
        std::none_of(unseen, order.end(), [&](uint32_t chunk) { return planned.is_seen(chunk); }));
    std::ranges::sort(order);
    EXPECT_EQ(order, all);
  }
}

}  // namespace
}  // namespace voyager::streaming_hidden_test
