// Codes give back what compact storage restores and activate() makes of it, to the bit.
#include "runtime/math/shape_code.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "runtime/format/quantise.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager::shape_code_test {
namespace {

void expect_same_bits(float a, float b) {
  EXPECT_EQ(std::bit_cast<uint32_t>(a), std::bit_cast<uint32_t>(b)) << a << " " << b;
}

TEST(ShapeCode, ItIsWhatActivationGives) {
  std::mt19937 random(11);
  for (int i = 0; i < 20000; ++i) {
    std::array<uint32_t, 3> scales;
    for (uint32_t& s : scales) s = static_cast<uint32_t>(random()) % kScaleCodes;
    if (i % 7 == 0) scales[i % 3] = scales[(i + 1) % 3];
    // Any opacity of a leaf; of a merged Gaussian any that is positive and finite.
    const bool leaf = i % 2 != 0;
    const auto opacity = static_cast<uint16_t>(leaf ? random() : random() % 0x7c00);
    const ScaleCodes packed = scale_codes(scales);
    ShapeCode code{bounds_code(packed.largest, opacity, leaf), {}};
    for (uint16_t& r : code.rest.rotation) r = static_cast<uint16_t>(random());
    const auto log_scale = [&](size_t axis) {
      return restore_log_scale(static_cast<uint16_t>(scales[axis]));
    };
    const GaussianWords words{{0, 0, 0},
                              {log_scale(0), log_scale(1), log_scale(2)},
                              restore_rotation(code.rest.rotation),
                              leaf ? restore_leaf_opacity(opacity) : half_to_float(opacity)};
    EXPECT_EQ(largest_scale_code(code), *std::max_element(scales.begin(), scales.end()));
    const Gaussian expected = activate(words, leaf);
    const Gaussian found = restored_shape(code, packed.others, shape_tables());
    ASSERT_EQ(std::memcmp(&expected, &found, sizeof expected), 0) << i;
    expect_same_bits(restored_opacity(code, shape_tables()), expected.opacity);
  }
}

// The formulas that a device takes in place of binary64 are rounded right: a smaller component of
// every step, and coefficients of every step over scales of any size.
TEST(ShapeCode, TwoHalvesGiveWhatBinary64Gives) {
  constexpr float kHigh = static_cast<float>(kRotationRange / kRotationSteps);
  constexpr float kLow = static_cast<float>(kRotationRange / kRotationSteps - double{kHigh});
  for (int steps = -kRotationSteps; steps <= kRotationSteps; ++steps) {
    const auto x = static_cast<float>(steps);
    expect_same_bits(std::fma(x, kHigh, x * kLow), smaller_component(steps));
  }
  std::mt19937 random(12);
  std::uniform_real_distribution<float> exponent(-99, 60);
  for (int i = 0; i < 2000; ++i) {
    const float scale = std::exp2(exponent(random));
    const ShStepSizes sizes = step_sizes({scale, scale, scale});
    for (size_t band = 0; band < 3; ++band)
      for (int q = -kShSteps[band]; q <= kShSteps[band]; ++q) {
        const auto x = static_cast<float>(q);
        ASSERT_EQ(std::fma(x, sizes.high[band], x * sizes.low[band]),
                  restore_sh(static_cast<int8_t>(q), scale, kShSteps[band]))
            << scale << " " << q;
      }
  }
}

TEST(ShapeCode, TheIdentityAndTheLargestAnglesComeBack) {
  for (const Quatf& q : {Quatf{1, 0, 0, 0}, Quatf{0, 0, 0, 1}, Quatf{0.5f, 0.5f, 0.5f, 0.5f},
                         Quatf{0.70710678f, 0, -0.70710678f, 0}}) {
    const Quatf back = restore_rotation(quantise_rotation(q).data());
    EXPECT_NEAR(std::fabs(back.w * q.w + back.x * q.x + back.y * q.y + back.z * q.z), 1, 1e-6);
  }
}

}  // namespace
}  // namespace voyager::shape_code_test
