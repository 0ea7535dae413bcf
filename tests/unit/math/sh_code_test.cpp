// Rows give back what compact storage restores, to the bit.
#include "runtime/math/sh_code.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace voyager::sh_code_test {
namespace {

// A Gaussian's coefficients as a compact chunk restores them.
std::vector<float> restored(int degree, const ShScales& scale, std::mt19937& random) {
  std::vector<float> sh(3 * static_cast<size_t>(sh_coefficients(degree)));
  std::normal_distribution<float> constant(0, 2);
  for (int c = 0; c < 3; ++c)
    sh[static_cast<size_t>(c)] = half_to_float(float_to_half(constant(random)));
  for (size_t band = 0; static_cast<int>(band) < degree; ++band) {
    std::uniform_int_distribution<int> steps(-kShSteps[band], kShSteps[band]);
    for (int k = 3 * kShBandStart[band]; k < 3 * kShBandStart[band + 1]; ++k)
      sh[static_cast<size_t>(k)] =
          restore_sh(static_cast<int8_t>(steps(random)), scale[band], kShSteps[band]);
  }
  return sh;
}

TEST(ShCode, ARowGivesBackWhatWasRestored) {
  std::mt19937 random(5);
  const ShScales scales[] = {
      {0.7f, 0.31f, 1.9f}, {3e-38f, 1e-45f, 0.0f}, {1e30f, 2.5e-7f, 65504.0f}};
  for (int degree = 0; degree <= kMaxShDegree; ++degree) {
    EXPECT_EQ(sh_row_bytes(degree) % sizeof(uint32_t), 0u);
    for (uint32_t of = 0; of < 3; ++of)
      for (int i = 0; i < 200; ++i) {
        const std::vector<float> sh = restored(degree, scales[of], random);
        std::vector<uint8_t> row(sh_row_bytes(degree));
        pack_sh(sh.data(), degree, scales[of], row.data());
        EXPECT_EQ(last_word(row.data(), degree), 0u);
        put_last_word(0xffffffffu, degree, row.data());
        std::vector<float> back(sh.size());
        unpack_sh(row.data(), degree, scales[of], back.data());
        ASSERT_EQ(back, sh) << degree << " " << of;
      }
  }
}

// As if the higher bands had never been there.
TEST(ShCode, AShortenedRowIsThatOfTheLowerDegree) {
  std::mt19937 random(6);
  const ShScales scale = {0.5f, 0.4f, 0.3f};
  const std::vector<float> sh = restored(3, scale, random);
  const auto row_of = [&](int degree) {
    std::vector<uint8_t> row(sh_row_bytes(degree));
    pack_sh(sh.data(), degree, scale, row.data());
    put_last_word(0x12345678u, degree, row.data());
    return row;
  };
  for (int degree = 1; degree <= kMaxShDegree; ++degree)
    for (int lower = 0; lower < degree; ++lower) {
      std::vector<uint8_t> shorter(sh_row_bytes(lower));
      shorten_sh(row_of(degree).data(), degree, lower, shorter.data());
      EXPECT_EQ(shorter, row_of(lower)) << degree << " " << lower;
    }
}

}  // namespace
}  // namespace voyager::sh_code_test
