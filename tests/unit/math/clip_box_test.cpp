// METHOD §6: the limits of an instance's box.
#include "runtime/math/clip_box.h"

#include <gtest/gtest.h>

namespace voyager::clip_box_test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

TEST(ClipBox, ALimitIsRoundedOnceAndWhatIsBeyondBinary32LimitsNothing) {
  EXPECT_EQ(local_limit(6.4e6 + 0.1, 6.4e6), static_cast<float>((6.4e6 + 0.1) - 6.4e6));
  EXPECT_EQ(local_limit(0.1, 0), 0.1f);
  EXPECT_EQ(local_limit(-3.4028234663852886e38, 0), -std::numeric_limits<float>::max());
  for (const double large : {3.5e38, 1e300, std::numeric_limits<double>::max(), kNoLimit}) {
    EXPECT_EQ(local_limit(large, -1e18), kInf) << large;
    EXPECT_EQ(local_limit(-large, 1e18), -kInf) << large;
  }
}

TEST(ClipBox, TheBoundaryIsInside) {
  const ClipBox<float> box = local_clip({{-1, -2, 10}, {1, -2, kNoLimit}}, {0, 0, 5});
  const Vec3f corner{-1, -2, 5};
  EXPECT_TRUE(is_inside(box, corner));
  EXPECT_TRUE(is_inside(box, {1, -2, 1e30f}));
  for (int axis = 0; axis < 3; ++axis) {
    Vec3f outside = corner;
    outside[axis] = std::nextafter(corner[axis], -kInf);
    EXPECT_FALSE(is_inside(box, outside)) << axis;
  }
  EXPECT_FALSE(is_inside(box, {std::nextafter(1.0f, kInf), -2, 5}));
  EXPECT_FALSE(is_inside(box, {0, std::nextafter(-2.0f, kInf), 5}));
  EXPECT_TRUE(is_inside(local_clip(kNoClip, {1e18, -1e18, 0}), {-1e18f, 1e18f, 0}));
}

}  // namespace
}  // namespace voyager::clip_box_test
