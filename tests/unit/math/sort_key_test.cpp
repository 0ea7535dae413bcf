// METHOD §6: the depth that orders splats, to the bit.
#include "runtime/math/sort_key.h"

#include <algorithm>
#include <vector>

#include "runtime/frame/depth_order.h"
#include "tests/support/test_support.h"

namespace voyager::sort_key_test {
namespace {

TEST(SortKey, SubtractsBeforeItRounds) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 100000; ++i) {
    const Vec3f mean{static_cast<float>(16e3 * uniform(random)),
                     static_cast<float>(uniform(random)), 0.125f};
    const Vec3d origin{6250.0 * 1024, -1024, 1e6 * 1024};
    const Vec3d eye{origin.x + 16e3 * uniform(random), origin.y + uniform(random),
                    origin.z + 1e-3 * uniform(random)};
    const Vec3f d = camera_relative(mean, origin, eye);
    for (int k = 0; k < 3; ++k) {
      const long double exact = (static_cast<long double>(mean[k]) + origin[k]) - eye[k];
      EXPECT_EQ(d[k], static_cast<float>(exact));
    }
  }
}

// Each product and sum rounded, in this order: written so that no compiler may fuse it, and on
// its own, because sharing its products with view_depth would keep those from being fused.
__attribute__((noinline)) float stepwise(const Vec3f& d, const Vec3f& f) {
  volatile float x = d.x * f.x, y = d.y * f.y, z = d.z * f.z;
  volatile float sum = x + y;
  return sum + z;
}

TEST(SortKey, RoundsEachOperation) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(-1, 1);
  size_t fused_differs = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3f d{100 * uniform(random), 100 * uniform(random), 100 * uniform(random)};
    const Vec3f f{uniform(random), uniform(random), uniform(random)};
    ASSERT_EQ(view_depth(d, f), stepwise(d, f));
    fused_differs += std::fma(d.z, f.z, std::fma(d.y, f.y, d.x * f.x)) != stepwise(d, f);
  }
  EXPECT_GT(fused_differs, 1000u);  // or the test could not tell
}

TEST(SortKey, OrdersByDepthThenId) {
  Workers workers(3);
  std::mt19937 random(3);
  std::vector<std::pair<float, uint32_t>> expected;
  std::vector<uint64_t> keys;
  for (uint32_t id = 0; id < 50000; ++id) {
    const float z = id % 3 == 0 ? 1.0f
                                : std::ldexp(1.0f + static_cast<float>(random() % 64),
                                             static_cast<int>(random() % 80) - 20);
    expected.push_back({z, id});
    keys.push_back(depth_key(z, id));
  }
  std::shuffle(keys.begin(), keys.end(), random);
  std::sort(expected.begin(), expected.end());
  sort_by_depth(keys, workers);
  for (size_t i = 0; i < keys.size(); ++i) ASSERT_EQ(depth_key_index(keys[i]), expected[i].second);
}

}  // namespace
}  // namespace voyager::sort_key_test
