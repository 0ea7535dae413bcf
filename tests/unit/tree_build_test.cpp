// Shape, origin and refusals of build_tree().
#include <memory_resource>

#include "runtime/base/error.h"
#include "runtime/lod/build.h"
#include "runtime/lod/shape.h"
#include "runtime/lod/validate.h"
#include "runtime/scene/sanitise.h"
#include "tests/support/test_support.h"

namespace voyager {
namespace {

TEST(TreeBuild, NothingGivesNothing) {
  Workers workers(2);
  const BakedScene baked = build_tree(GaussianCloud(), workers);
  EXPECT_EQ(baked.tree.size(), 0u);
  EXPECT_EQ(baked.merged.size(), 0u);
  EXPECT_TRUE(validate(baked).empty());
}

TEST(TreeBuild, OneGaussianIsALeafRoot) {
  Workers workers(2);
  const BakedScene baked = build_tree(test::random_cloud(1, 1), workers);
  ASSERT_EQ(baked.tree.size(), 1u);
  EXPECT_TRUE(baked.tree.is_leaf(0));
  EXPECT_EQ(baked.tree.records[0].extent, 0.0f);
  EXPECT_EQ(baked.merged.size(), 0u);
}

TEST(TreeBuild, UpToFourGaussiansAreTheRootsChildren) {
  Workers workers(1);
  for (uint32_t count = 2; count <= kChildren; ++count) {
    const BakedScene baked = build_tree(test::random_cloud(count, count), workers);
    EXPECT_EQ(baked.tree.size(), count + 1);
    EXPECT_EQ(baked.tree.records[0].child_count, count);
  }
}

TEST(TreeBuild, ShapeHasTwoToFourChildrenAndFewMergedNodes) {
  for (uint32_t size = 2; size < 5000; ++size) {
    const Parts parts = split_in_parts(size);
    ASSERT_GE(parts.count, 2u) << size;
    ASSERT_LE(parts.count, kChildren) << size;
    uint32_t sum = 0;
    for (uint32_t i = 0; i < parts.count; ++i) {
      ASSERT_GT(parts.size[i], 0u) << size;
      sum += parts.size[i];
    }
    ASSERT_EQ(sum, size);
    if (size > 16) {
      ASSERT_LE(static_cast<double>(count_nodes(size) - size), 0.36 * size + 3) << size;
    }
  }
  EXPECT_LE(count_nodes(10'000'000), 13'600'000u);
  EXPECT_LE(count_nodes(1u << 23),
            11'450'000u);  // twice a power of four, the worst of plain halving
}

TEST(TreeBuild, LevelsHalveTheExtentOfASurface) {
  Workers workers(2);
  GaussianCloud cloud = test::random_cloud(16384, 2, 0);
  for (size_t i = 0; i < cloud.size(); ++i) {
    cloud.position[3 * i + 2] = 0.0f;
    for (size_t k = 0; k < 3; ++k) cloud.log_scale[3 * i + k] = -12.0f;
  }
  const BakedScene baked = build_tree(std::move(cloud), workers);
  double ratio = 0.0;
  int measured = 0;
  for (uint32_t n = 1; n < 85; ++n, ++measured)  // three levels under the root
    ratio += baked.tree.records[n].extent / baked.tree.records[baked.tree.parent[n]].extent;
  EXPECT_NEAR(ratio / measured, 0.5, 0.05);
}

TEST(TreeBuild, SplitsAtTheMedianOfTheLongestSide) {
  Workers workers(1);
  GaussianCloud cloud = test::random_cloud(64, 3, 0);
  for (size_t i = 0; i < 64; ++i) cloud.position[3 * i + 1] *= 100.0f;
  const BakedScene baked = build_tree(cloud, workers);
  ASSERT_EQ(baked.tree.records[0].child_count, 4u);
  std::vector<float> largest(4, -1e30f), least(4, 1e30f);
  for (uint32_t n = 0; n < baked.tree.size(); ++n) {
    if (!baked.tree.is_leaf(n)) continue;
    uint32_t child = n;
    while (baked.tree.parent[child] != 0) child = baked.tree.parent[child];
    const float y = cloud.position[3 * size_t{baked.gaussian[n]} + 1];
    largest[child - 1] = std::max(largest[child - 1], y);
    least[child - 1] = std::min(least[child - 1], y);
  }
  EXPECT_LE(std::max(largest[0], largest[1]), std::min(least[2], least[3]));
}

TEST(TreeBuild, OriginIsZeroNearAndAMultipleOf1024MetresFar) {
  EXPECT_EQ(scene_origin({-16000, -5, 0}, {16000, 5, 0}), (std::array<double, 3>{0, 0, 0}));
  const std::array<double, 3> far = scene_origin({6.4e6, -10, -2e5}, {6.401e6, 20, -1e5});
  EXPECT_EQ(far[0], 1024 * std::round(6.4005e6 / 1024));
  EXPECT_EQ(far[1], 0.0);
  EXPECT_EQ(far[2], 1024 * std::round(-1.5e5 / 1024));
}

TEST(TreeBuild, EarthCentredMeansKeepTheirMillimetres) {
  Workers workers(2);
  GaussianCloud cloud = test::random_cloud(200, 4);
  const GaussianCloud local = cloud;
  cloud.origin = {6.4e6, -1.25e6, 3.0e5};
  const BakedScene baked = build_tree(std::move(cloud), workers);
  EXPECT_TRUE(validate(baked).empty());
  for (size_t i = 0; i < local.size(); ++i) {
    const Vec3f mean = local_mean(baked.leaves, i, baked.origin);
    for (int axis = 0; axis < 3; ++axis) {
      const size_t a = static_cast<size_t>(axis);
      const double world = double{local.position[3 * i + a]} + baked.leaves.origin[a];
      EXPECT_NEAR(mean[axis] + baked.origin[a], world, 1e-4);
    }
  }
}

TEST(TreeBuild, AStrayGaussianDoesNotMoveTheOrigin) {
  GaussianCloud cloud = test::random_cloud(1000, 5);
  cloud.position[300] = 1e17f;
  EXPECT_EQ(scene_origin(cloud), (std::array<double, 3>{0, 0, 0}));
}

TEST(TreeBuild, RefusesWhatSanitisingWouldHaveMended) {
  Workers workers(1);
  const auto refused = [&](const auto& edit, const std::string& says) {
    GaussianCloud cloud = test::random_cloud(20, 6);
    edit(cloud);
    try {
      build_tree(std::move(cloud), workers);
      ADD_FAILURE() << "not refused: " << says;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      EXPECT_NE(std::string(error.what()).find("Gaussian 7: " + says), std::string::npos)
          << error.what();
    }
  };
  refused([](GaussianCloud& c) { c.position[21] = NAN; }, "a position is nan");
  refused([](GaussianCloud& c) { c.position[22] = 1e18f; }, "a position");
  refused([](GaussianCloud& c) { c.position[23] = -INFINITY; }, "a position is -inf");
  refused([](GaussianCloud& c) { c.log_scale[21] = NAN; }, "a log scale is nan");
  refused([](GaussianCloud& c) { c.log_scale[22] = 14.0f; }, "a log scale is 14");
}

TEST(TreeBuild, KeepsTheInputsWords) {
  Workers workers(2);
  const GaussianCloud cloud = test::random_cloud(500, 8, 2);
  const BakedScene baked = build_tree(cloud, workers);
  EXPECT_EQ(baked.leaves.position, cloud.position);
  EXPECT_EQ(baked.leaves.log_scale, cloud.log_scale);
  EXPECT_EQ(baked.leaves.rotation, cloud.rotation);
  EXPECT_EQ(baked.leaves.opacity, cloud.opacity);
  EXPECT_EQ(baked.leaves.sh, cloud.sh);
}

TEST(TreeBuild, MemoryComesFromTheCloudsResource) {
  std::pmr::monotonic_buffer_resource memory;
  Workers workers(1);
  GaussianCloud cloud(&memory);
  cloud.sh_degree = 1;
  const GaussianCloud source = test::random_cloud(50, 9);
  cloud.position.assign(source.position.begin(), source.position.end());
  cloud.log_scale.assign(source.log_scale.begin(), source.log_scale.end());
  cloud.rotation.assign(source.rotation.begin(), source.rotation.end());
  cloud.opacity.assign(source.opacity.begin(), source.opacity.end());
  cloud.sh.assign(source.sh.begin(), source.sh.end());
  const float* words = cloud.sh.data();
  const BakedScene baked = build_tree(std::move(cloud), workers);
  EXPECT_EQ(baked.leaves.sh.data(), words);  // moved, not copied
  EXPECT_EQ(baked.tree.records.get_allocator().resource(), &memory);
  EXPECT_EQ(baked.merged.sh.get_allocator().resource(), &memory);
}

TEST(TreeBuild, ProgressReachesItsTotals) {
  Workers workers(2);
  std::vector<std::pair<std::string, uint64_t>> ends;
  build_tree(test::random_cloud(1000, 10), workers,
             [&](const char* stage, uint64_t done, uint64_t total) {
               EXPECT_LE(done, total);
               if (done == total) ends.push_back({stage, total});
             });
  ASSERT_EQ(ends.size(), 3u);
  EXPECT_EQ(ends[0].first, "splitting");
  EXPECT_EQ(ends[1].first, "merging");
  EXPECT_EQ(ends[2].first, "aligning");
}

}  // namespace
}  // namespace voyager
