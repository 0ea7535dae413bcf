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
    ShapeCode code{};
    for (uint16_t& s : code.scale) s = static_cast<uint16_t>(random());
    for (uint16_t& r : code.rotation) r = static_cast<uint16_t>(random());
    code.family = family_code(i % 2 != 0, static_cast<uint32_t>(i));
    // Any opacity of a leaf; of a merged Gaussian any that is positive and finite.
    code.opacity = static_cast<uint16_t>(has_logit(code) ? random() : random() % 0x7c00);
    const GaussianWords words{
        {0, 0, 0},
        {restore_log_scale(code.scale[0]), restore_log_scale(code.scale[1]),
         restore_log_scale(code.scale[2])},
        restore_rotation(code.rotation),
        has_logit(code) ? restore_leaf_opacity(code.opacity) : half_to_float(code.opacity)};
    const Gaussian expected = activate(words, has_logit(code));
    const Gaussian found = restored_shape(code, shape_tables());
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
