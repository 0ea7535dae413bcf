// The floor of a frame, against figures worked out by hand.
#include "tools/frame_floor.h"

#include <gtest/gtest.h>

namespace voyager::tools {
namespace frame_floor_test {
namespace {

// 1e6 Gaussians at SH 3, half of them visible, in 2e6 tiles; 1e9 blended pixels; 1920x1080.
FrameWork work() {
  FrameWork work;
  work.cut = 1e6;
  work.splats = 5e5;
  work.pairs = 2e6;
  work.pixels_blended = 1e9;
  work.pixels = 1920.0 * 1080;
  work.pixel_bytes = 4;
  work.attribute_bytes = 236;
  return work;
}

TEST(FrameFloor, OfOrinIsWhatIsWorkedOutByHand) {
  const FrameFloor floor = frame_floor(work(), kOrin);
  EXPECT_NEAR(floor.project, 138e6 / 204.8e6, 1e-12);   // 12e6 + 5e5 · 252 bytes
  EXPECT_NEAR(floor.sort, 86e6 / 204.8e6, 1e-12);       // 5e5 · 68 + 2e6 · 26 bytes
  EXPECT_NEAR(floor.blend, 4.1353383458646613, 1e-12);  // 1.1e10 of 2.66e12 slots
  EXPECT_NEAR(floor.out, 0.0405, 1e-12);                // 8,294,400 bytes
  EXPECT_NEAR(floor.frame(), 0.673828125 + 0.419921875 + 4.1353383458646613 + 0.0405, 1e-12);
}

// 132 multiprocessors at 1.98 GHz, and a part of 16 of them with the same memory.
TEST(FrameFloor, OfAPartOfADeviceBlendsInProportionAndMovesBytesAsFast) {
  const FrameFloor whole = frame_floor(work(), {128 * 132 * 1.98e9, 4.8e12});
  const FrameFloor part = frame_floor(work(), {128 * 16 * 1.98e9, 4.8e12});
  EXPECT_NEAR(whole.blend, 0.328809, 1e-6);  // of 3.345e13 slots
  EXPECT_NEAR(part.blend / whole.blend, 132.0 / 16, 1e-12);
  EXPECT_NEAR(whole.project, 0.02875, 1e-12);
  EXPECT_EQ(part.project, whole.project);
  EXPECT_EQ(part.sort, whole.sort);
  EXPECT_EQ(part.out, whole.out);
}

TEST(FrameFloor, OfAStageIsTheSlowerOfItsBytesAndItsInstructions) {
  EXPECT_DOUBLE_EQ(stage_floor(204.8e9, 0, kOrin), 1000);
  EXPECT_DOUBLE_EQ(stage_floor(204.8e6, 2.66e9 * 3, kOrin), 3);
  EXPECT_DOUBLE_EQ(stage_floor(204.8e6 * 5, 2.66e9 * 3, kOrin), 5);
  EXPECT_EQ(stage_floor(0, 0, kOrin), 0);
}

TEST(FrameFloor, StoredBytesAreThoseOfTheInputFormats) {
  EXPECT_EQ(stored_bytes(0), 56);
  EXPECT_EQ(stored_bytes(1), 92);
  EXPECT_EQ(stored_bytes(2), 152);
  EXPECT_EQ(stored_bytes(3), 236);
}

TEST(FrameFloor, AttributeBytesAreTheBackendsWhereItSaysThem) {
  EXPECT_EQ(attribute_bytes(144, 3), 144);
  EXPECT_EQ(attribute_bytes(0, 3), 236);
}

}  // namespace
}  // namespace frame_floor_test
}  // namespace voyager::tools
