// Bounds as searches read them: what rounding promises, on boxes of every size and place.
#include "runtime/math/bounds_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace voyager::bounds_code_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool covers(const NodeBounds& a, const NodeBounds& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(a.box_min[axis] <= b.box_min[axis] && a.box_max[axis] >= b.box_max[axis])) return false;
  return a.extent >= b.extent;
}

bool same(const NodeBounds& a, const NodeBounds& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

class Boxes {
 public:
  // Of sides and places from denormals to 1e18, thin and flat ones among them.
  NodeBounds next() {
    NodeBounds b{};
    const float side = magnitude(), far = magnitude();
    for (int axis = 0; axis < 3; ++axis) {
      const float low = std::clamp(between(-far, far), -1e18f, 1e18f);
      const float high = std::clamp(low + (pick(4) == 0 ? 0 : between(0, side)), low, 1e18f);
      b.box_min[axis] = low, b.box_max[axis] = high;
    }
    b.extent = pick(8) == 0 ? kInfinity : pick(8) == 0 ? 0 : magnitude();
    return b;
  }
  // Which lies in it.
  NodeBounds inside(const NodeBounds& outer) {
    NodeBounds b = outer;
    for (int axis = 0; axis < 3; ++axis) {
      if (pick(3) == 0) continue;
      const float low = outer.box_min[axis], high = outer.box_max[axis];
      const float from = std::clamp(low + between(0, 1) * (high - low), low, high);
      const float to = std::clamp(from + between(0, 0.1f) * (high - from), from, high);
      b.box_min[axis] = from, b.box_max[axis] = to;
    }
    if (outer.extent < kInfinity) b.extent = outer.extent * between(0, 1);
    return b;
  }
  // Where a finer grid ends: its corners are some steps on either side of ±2^k.
  NodeBounds astride() {
    NodeBounds b{};
    const int k = pick(20) - 3;
    const float step = std::ldexp(pick(2) == 0 ? 1.0f : 0.25f, k - kCornerBits + 1);
    const auto steps = [&](int most) { return static_cast<float>(pick(most + 1)) * step; };
    for (int axis = 0; axis < 3; ++axis) {
      const float plane = std::ldexp(pick(2) == 0 ? 1.0f : -1.0f, k);
      b.box_min[axis] = pick(3) == 0 ? plane - steps(70) : plane + steps(3);
      b.box_max[axis] = b.box_min[axis] + steps(140);
    }
    b.extent = between(0, 1);
    return b;
  }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

 private:
  float between(float low, float high) {
    return low + (high - low) * std::uniform_real_distribution<float>(0, 1)(random_);
  }
  float magnitude() {
    const std::array<float, 6> of{1e-42f, 1e-20f, 1e-3f, 1, 1e4f, 1e18f};
    return of[static_cast<size_t>(pick(6))] * between(0, 1);
  }

  std::mt19937 random_{7};
};

TEST(BoundsCode, CoversWhatItRoundsAndStaysAsItIs) {
  Boxes boxes;
  for (int i = 0; i < 20000; ++i) {
    const NodeBounds b = boxes.next(), rounded = round_bounds(b);
    ASSERT_TRUE(covers(rounded, b)) << i;
    ASSERT_TRUE(same(round_bounds(rounded), rounded)) << i;
  }
}

TEST(BoundsCode, BoxesThatNestStaySo) {
  Boxes boxes;
  for (int i = 0; i < 20000; ++i) {
    NodeBounds outer = boxes.next();
    for (int depth = 0; depth < 4; ++depth) {
      const NodeBounds inner = boxes.inside(outer);
      ASSERT_TRUE(covers(outer, inner)) << i;
      ASSERT_TRUE(covers(round_bounds(outer), round_bounds(inner))) << i;
      outer = inner;
    }
  }
}

TEST(BoundsCode, BoxesThatNestStaySoWhereAFinerGridEnds) {
  const NodeBounds outer{{131071, 0, 0}, 1, {131073, 1, 1}},
      inner{{131072, 0, 0}, 1, {131073, 1, 1}};
  EXPECT_TRUE(covers(round_bounds(outer), round_bounds(inner)));
  Boxes boxes;
  for (int i = 0; i < 20000; ++i) {
    const NodeBounds b = boxes.astride();
    NodeBounds part = b;
    const int axis = boxes.pick(3);
    if (boxes.pick(2) == 0)
      part.box_min[axis] = 0.5f * (b.box_min[axis] + b.box_max[axis]);
    else
      part.box_max[axis] = 0.5f * (b.box_min[axis] + b.box_max[axis]);
    ASSERT_TRUE(covers(round_bounds(b), round_bounds(part))) << i;
    ASSERT_TRUE(covers(round_bounds(b), round_bounds(boxes.inside(b)))) << i;
  }
}

TEST(BoundsCode, GrowsByNoMoreThanItSays) {
  Boxes boxes;
  for (int i = 0; i < 20000; ++i) {
    const NodeBounds b = boxes.next(), rounded = round_bounds(b);
    double longest = 0, farthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      longest = std::max(longest, double{b.box_max[axis]} - double{b.box_min[axis]});
      farthest = std::max({farthest, -double{b.box_min[axis]}, double{b.box_max[axis]}});
    }
    const double step = std::max({longest / 30, farthest / 65535, 0x1p-126});
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LE(double{b.box_min[axis]} - double{rounded.box_min[axis]}, step) << i;
      ASSERT_LE(double{rounded.box_max[axis]} - double{b.box_max[axis]}, step) << i;
    }
    if (b.extent < kInfinity) {
      ASSERT_LE(double{rounded.extent}, double{b.extent} * (1 + 0x1p-8) + 0x1p-134) << i;
    }
    ASSERT_TRUE(b.extent != 0 || rounded.extent == 0) << i;
  }
}

TEST(BoundsCode, ReadsPlainNumbersBack) {
  const NodeBounds b{{-3, 0.5f, 1000}, 0.75f, {4, 0.5f, 1000.125f}};
  EXPECT_TRUE(same(round_bounds(b), b));
  EXPECT_TRUE(same(round_bounds({{0, 0, -0.0f}, -0.0f, {0, 0, 0}}), {{0, 0, 0}, 0, {0, 0, 0}}));
}

}  // namespace
}  // namespace voyager::bounds_code_test
