// METHOD §4: α' of up to a million siblings, in the form that keeps its digits beside the power
// that it stands for. How k of them add up is unit/alpha's to say, and numerics/transmittance's
// what blending makes of it.
#include <algorithm>
#include <cmath>

#include "runtime/math/alpha.h"
#include "tests/numerics/measured.h"

namespace voyager::siblings_test {
namespace {

// t·α + (1 - t)·(1 - (1 - α)^(1/k)) in binary32.
float textbook(float alpha, float t, float inverse_k) {
  return t * alpha + (1 - t) * (1 - std::pow(1 - alpha, inverse_k));
}

struct SiblingErrors {
  double ours = 0, textbook = 0;  // relative
};

SiblingErrors measure(uint32_t k, float t) {
  SiblingErrors e;
  const float inverse_k = 1.0f / static_cast<float>(k);
  for (int i = 0; i <= 2000; ++i) {
    const float alpha =
        kAlphaThreshold + (kAlphaMax - kAlphaThreshold) * static_cast<float>(i) / 2000.0f;
    const double truth = sibling_alpha(double{alpha}, double{t}, 1.0 / k);
    const auto error = [&](float found) { return std::fabs(double{found} / truth - 1); };
    e.ours = std::max(e.ours, error(sibling_alpha(alpha, t, inverse_k)));
    e.textbook = std::max(e.textbook, error(textbook(alpha, t, inverse_k)));
  }
  return e;
}

constexpr float kTs[] = {0.0f, 0x1p-24f, 1e-4f, 0.5f, 1 - 0x1p-12f, 1 - 0x1p-24f};

TEST(Siblings, KeepTheirDigitsHoweverManyAndAtBothEndsOfT) {
  for (const uint32_t k : {1u, 10u, 100u, 1000u, 10000u, 100000u, 1000000u}) {
    SiblingErrors all;
    for (const float t : kTs) {
      const SiblingErrors e = measure(k, t);
      all.ours = std::max(all.ours, e.ours), all.textbook = std::max(all.textbook, e.textbook);
    }
    EXPECT_LE(all.ours, 5e-7) << k;
    test::record("k_" + std::to_string(k) + "_ours", all.ours);
    test::record("k_" + std::to_string(k) + "_textbook", all.textbook);
  }
  EXPECT_EQ(measure(1000000, 0).textbook, 1);  // nothing is left of it
}

// What a node takes does not jump where it becomes itself, or where it leaves its parent: a
// step of t changes α' by no more than α times the step, to the rounding of α' itself.
TEST(Siblings, AlphaDoesNotJumpAtEitherEnd) {
  for (const uint32_t k : {2u, 100u, 1000000u})
    for (const float alpha : {kAlphaThreshold, 0.1f, kAlphaMax}) {
      const float inverse_k = 1.0f / static_cast<float>(k);
      const auto at = [&](float t) { return double{sibling_alpha(alpha, t, inverse_k)}; };
      EXPECT_EQ(at(1), double{alpha});
      EXPECT_LE(std::fabs(at(1 - 0x1p-24f) - at(1)), double{alpha} * 2 * test::kEpsilon);
      EXPECT_LE(std::fabs(at(0x1p-24f) - at(0)), double{alpha} * 2 * test::kEpsilon);
      for (float t = 0; t < 1; t += 1.0f / 512) EXPECT_LE(at(t), at(t + 1.0f / 512));
    }
}

}  // namespace
}  // namespace voyager::siblings_test
