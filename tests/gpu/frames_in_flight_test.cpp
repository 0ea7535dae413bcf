// What a view's frames that are in flight do to one another: room that a frame outgrows, and
// buffers that the next one replaces.
#include <chrono>
#include <thread>

#include "tests/gpu/frames_in_flight.h"

namespace voyager::test {
namespace frames_in_flight_test {
namespace {

using cuda::buffer_bytes;

// Sheets over the whole image: fewer splats than a view has room for at first, and more pairs.
std::shared_ptr<const Scene> sheets() {
  auto scene = empty_scene();
  for (int i = 0; i < 4000; ++i)
    add_gaussian(*scene, {0, 0, 1 + 1e-4f * static_cast<float>(i)}, {1e4f, 1e4f, 1e-6f}, 0.004f);
  return scene;
}
const Camera kWide = look({0, 0, 0}, {0, 0, 1}, 333, 320),
             kNarrow = look({0, 0, 0}, {0, 0, 1}, 16, 16);

FrameStats finished(Pipeline& pipeline) {
  FrameStats stats;
  EXPECT_TRUE(pipeline.finish(true, stats)) << "there is no frame";
  return stats;
}

TEST_F(FramesInFlight, EachThatOutgrowsTheRoomSaysSoAndTheNextHasIt) {
  const auto drawn = pipeline(sheets());
  const auto ring = make_ring(kWide.width, kWide.height);
  const FrameInput input = into(*ring, kWide);
  for (int i = 0; i < 2; ++i) drawn->submit(input, false);
  for (int i = 0; i < 2; ++i) {
    const FrameStats outgrown = finished(*drawn);
    EXPECT_GT(outgrown.pairs_after, uint64_t{1} << 20);
    EXPECT_GT(outgrown.pairs_dropped, 0u);
  }
  drawn->submit(input, false);
  EXPECT_EQ(finished(*drawn).pairs_dropped, 0u);
}

TEST_F(FramesInFlight, WhereTheRoomIsCheckedNoFrameOutgrowsIt) {
  const auto drawn = pipeline(sheets());
  const auto ring = make_ring(kWide.width, kWide.height);
  drawn->submit(into(*ring, kWide), true);
  const FrameStats stats = finished(*drawn);
  EXPECT_GT(stats.pairs_after, uint64_t{1} << 20);
  EXPECT_EQ(stats.pairs_dropped, 0u);
}

// Each finds hidden what the one before it covered, which has not ended when it is submitted.
TEST_F(FramesInFlight, LeaveOutWhatFramesThatAreWaitedForLeaveOut) {
  const auto scene = flat_scene(random_cloud(60000, 31, 0));
  const PipelineDesc desc{.occlusion = Occlusion::on};
  const auto waited = view(scene, desc);
  const auto drawn = pipeline(scene, desc);
  const auto ring = make_ring(kWide.width, kWide.height);
  const auto camera = [](int i) {
    return look({0.05 * i, 0, -24}, {i < 6 ? 0.0 : 0.5 * i, 0, 0}, kWide.width, kWide.height);
  };
  drawn->submit(into(*ring, camera(0)), true);  // so that there is room
  render(*waited, frame_input(camera(0), 3));
  const uint64_t all = finished(*drawn).pairs_after;
  for (int first = 1; first < 12; first += 3) {
    for (int i = first; i < first + 3; ++i) drawn->submit(into(*ring, camera(i)), false);
    for (int i = first; i < first + 3; ++i) {
      const FrameStats expected = render(*waited, frame_input(camera(i), 3)).stats;
      const FrameStats stats = finished(*drawn);
      if (i < 6) {
        EXPECT_LT(stats.pairs_after, all);
      }
      EXPECT_EQ(stats.pairs_after, expected.pairs_after) << "frame " << i;
      EXPECT_EQ(stats.splats, expected.splats) << "frame " << i;
      EXPECT_EQ(stats.pairs_dropped, 0u);
    }
  }
}

// Submits a frame while another is held back on the device: no buffer comes or goes before that
// one has ended.
void expect_buffers_kept(Pipeline& drawn, const FrameInput& input, double held) {
  const size_t before = buffer_bytes;
  std::thread host([&] { drawn.submit(input, false); });
  std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(held / 3));
  EXPECT_EQ(buffer_bytes, before) << "a buffer was replaced that a frame in flight uses";
  host.join();
  EXPECT_GT(buffer_bytes, before) << "nothing was replaced";
}

TEST_F(FramesInFlight, KeepTheirBuffersFromALargerFrame) {
  const auto drawn = pipeline(sheets());
  const auto small = make_ring(kNarrow.width, kNarrow.height),
             large = make_ring(kWide.width, kWide.height);
  drawn->submit(into(*small, kNarrow), true);
  finished(*drawn);
  hold_back(*small);
  drawn->submit(into(*small, kNarrow), false);
  expect_buffers_kept(*drawn, into(*large, kWide), kHeld);
  for (int i = 0; i < 2; ++i) finished(*drawn);
}

TEST_F(FramesInFlight, KeepTheirBuffersFromAFrameThatHasMoreRoom) {
  const auto drawn = pipeline(sheets());
  const auto ring = make_ring(kWide.width, kWide.height);
  const FrameInput input = into(*ring, kWide);
  drawn->submit(input, false);
  hold_back(*ring);
  drawn->submit(input, false);
  EXPECT_GT(finished(*drawn).pairs_dropped, 0u);  // so the next frame makes room
  expect_buffers_kept(*drawn, input, kHeld);
  EXPECT_GT(finished(*drawn).pairs_dropped, 0u);
  EXPECT_EQ(finished(*drawn).pairs_dropped, 0u);
}

}  // namespace
}  // namespace frames_in_flight_test
}  // namespace voyager::test
