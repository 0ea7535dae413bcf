// The errors that docs/voy-format.md states for compact storage, value by value.
#include "runtime/format/quantise.h"

#include <cstring>

#include "runtime/format/record_planes.h"
#include "tests/support/test_support.h"

namespace voyager::quantise_test {
namespace {

float uniform(std::mt19937& random, float lo, float hi) {
  return lo + (hi - lo) * (static_cast<float>(random() >> 8) / 16777216.0f);
}

TEST(Quantise, PositionWithinHalfAStep) {
  std::mt19937 random(1);
  for (int i = 0; i < 100000; ++i) {
    const double centre = 594.7, step = 608.4 / kPositionSteps;
    const float x = uniform(random, -13.7f, 1203.1f);
    const uint32_t q = quantise_position(x, centre, step);
    ASSERT_LT(q, 1u << 24);
    ASSERT_LE(std::fabs(restore_position(q, centre, step) - x), step / 2 + 1203.1 * 0x1p-24);
  }
  EXPECT_EQ(restore_position(quantise_position(5.25f, 5.25, 0), 5.25, 0), 5.25f);
}

TEST(Quantise, LogScaleWithinAThousandth) {
  std::mt19937 random(2);
  for (int i = 0; i < 100000; ++i) {
    const float s = uniform(random, kMinLogScale, kMaxLogScale);
    ASSERT_LE(std::fabs(double{restore_log_scale(quantise_log_scale(s))} - s), 1.0 / 1024);
  }
  EXPECT_EQ(restore_log_scale(quantise_log_scale(-30.0f)), -21.0f);
}

TEST(Quantise, RotationWithinItsAngle) {
  std::mt19937 random(3);
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    Quatf q{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1),
            uniform(random, -1, 1)};
    if (i % 5 == 0) q.x = q.w;  // ties of the largest component
    if (i % 7 == 0) q = {q.w, 0, 0, 0};
    const Quatd a = normalise(Quatd{q.w, q.x, q.y, q.z});
    const Quatf r = restore_rotation(quantise_rotation(q).data());
    const Quatd b = normalise(Quatd{r.w, r.x, r.y, r.z});
    const double s = (a.w * b.w + a.x * b.x) + (a.y * b.y + a.z * b.z) < 0 ? -1 : 1;
    const double chord = std::hypot(std::hypot(a.w - s * b.w, a.x - s * b.x),
                                    std::hypot(a.y - s * b.y, a.z - s * b.z));
    worst = std::max(worst, 4 * std::asin(std::min(1.0, chord / 2)));
  }
  EXPECT_LE(worst, 1.6e-4);
}

TEST(Quantise, LeafOpacityWithinHalfAStep) {
  for (float word = -90.0f; word <= 90.0f; word += 0.0037f) {
    const float restored = restore_leaf_opacity(quantise_leaf_opacity(word));
    ASSERT_LE(std::fabs(double{sigmoid(restored)} - sigmoid(word)), 0.5 / 65535 + 0x1p-23) << word;
  }
  EXPECT_EQ(restore_leaf_opacity(quantise_leaf_opacity(kMaxLogit)), kMaxLogit);
  EXPECT_EQ(restore_leaf_opacity(quantise_leaf_opacity(-kMaxLogit)), -kMaxLogit);
}

TEST(Quantise, ShWithinHalfAStepOfItsBand) {
  std::mt19937 random(4);
  for (const int steps : kShSteps)
    for (int i = 0; i < 20000; ++i) {
      const float scale = 0.83f, c = uniform(random, -scale, scale);
      const float error = restore_sh(quantise_sh(c, scale, steps), scale, steps) - c;
      ASSERT_LE(std::fabs(error), scale / (2 * static_cast<float>(steps)) + 1e-7f);
    }
  EXPECT_EQ(restore_sh(quantise_sh(0, 0, 31), 0, 31), 0);
}

TEST(Quantise, RecordsSurviveToTheBit) {
  std::mt19937 random(5);
  const auto record = [&](bool small) {
    NodeRecord r{};
    for (int axis = 0; axis < 3; ++axis) {
      r.box_min[axis] = uniform(random, -1e4f, 1e4f);
      r.box_max[axis] = r.box_min[axis] + uniform(random, 0, small ? 1e-3f : 1e6f);
    }
    r.child_count = random() % 3;
    r.extent = uniform(random, 0, 1e3f);
    return r;
  };
  for (int i = 0; i < 100000; ++i) {
    const NodeRecord r = record(i % 2 == 0), other = record(i % 4 < 2);
    NodeRecord plain = r, told = r;
    plain.box_min = plain.box_max = told.box_min = told.box_max = {7, 7, 7};
    set_box(box_words(r), plain);
    set_box(box_words(r, other), other, told);
    ASSERT_EQ(std::memcmp(&plain, &r, sizeof r), 0);
    ASSERT_EQ(std::memcmp(&told, &r, sizeof r), 0);
    for (const ExtentRule rule :
         {ExtentRule::longest_side, ExtentRule::error, ExtentRule::error_with_doubles})
      for (const NodeRecord* parent : {&other, static_cast<const NodeRecord*>(nullptr)}) {
        NodeRecord back = r;
        back.extent = 7;
        back.extent = extent_of_word(extent_word(rule, r, parent), rule, back, parent);
        ASSERT_EQ(back.extent, r.extent);
      }
  }
}

// What a tree tells of its nodes costs nothing.
TEST(Quantise, WhatIsUsualIsZero) {
  NodeRecord parent{}, child{}, other{};
  child = {{1, 2, 3}, 0.98f * 5, {2, 3, 4}, 0};
  other = {{-1, 2, 3}, 0, {2, 2.5f, 9}, 3};
  const NodeRecord children[] = {child, other};
  parent = hull_of_boxes(children, 2);
  EXPECT_EQ(parent.box_min.x, -1);
  EXPECT_EQ(parent.box_max.z, 9);
  for (const uint32_t word : box_words(parent, hull_of_boxes(children, 2)).word)
    EXPECT_EQ(word, 0u);
  parent.extent = 5;
  EXPECT_EQ(extent_word(ExtentRule::error_with_doubles, child, &parent), 0u);
  child.child_count = 1;
  EXPECT_EQ(extent_word(ExtentRule::error_with_doubles, child, &parent), 0u);
  child.child_count = 0;
  child.extent = 0;
  EXPECT_EQ(extent_word(ExtentRule::error, child, &parent), 0u);
  EXPECT_EQ(extent_word(ExtentRule::longest_side, child, &parent), 0u);
}

}  // namespace
}  // namespace voyager::quantise_test
