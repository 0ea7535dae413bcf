// Shape, origin and refusals of build_tree().
#include <cstring>
#include <memory_resource>

#include "runtime/base/error.h"
#include "runtime/lod/build.h"
#include "runtime/lod/shape.h"
#include "runtime/lod/stand_in.h"
#include "runtime/lod/validate.h"
#include "runtime/scene/sanitise.h"
#include "tests/support/test_support.h"
#include "tests/support/tree_rules.h"

namespace voyager::tree_build_test {
namespace {

TEST(TreeBuild, NothingGivesNothing) {
  Workers workers(2);
  for (const test::NamedRule& named : test::all_rules()) {
    const BakedScene baked = build_tree(GaussianCloud(), workers, {}, named.rule);
    EXPECT_EQ(baked.tree.size(), 0u);
    EXPECT_EQ(baked.merged.size(), 0u);
    EXPECT_EQ(baked.kind, named.rule.kind);
    EXPECT_TRUE(validate(baked).empty());
  }
}

TEST(TreeBuild, OneGaussianIsALeafRoot) {
  Workers workers(2);
  for (const test::NamedRule& named : test::all_rules()) {
    const BakedScene baked = build_tree(test::random_cloud(1, 1), workers, {}, named.rule);
    ASSERT_EQ(baked.tree.size(), 1u);
    EXPECT_TRUE(baked.tree.is_leaf(0));
    EXPECT_EQ(baked.tree.records[0].extent, 0.0f);
    EXPECT_EQ(baked.merged.size(), 0u);
  }
}

// One: a double, of a clustered tree.
TEST(TreeBuild, NodesHaveUpToFourChildren) {
  Workers workers(2);
  for (const test::NamedRule& named : test::all_rules())
    for (const size_t count : {2, 3, 17, 1025, 3000}) {
      const BakedScene baked = build_tree(test::random_cloud(count, 2, 0), workers, {}, named.rule);
      const bool clustered = named.rule.kind == TreeKind::clustered;
      for (const NodeRecord& r : baked.tree.records) {
        if (r.child_count == 0) continue;
        ASSERT_GE(r.child_count, clustered ? 1u : 2u) << named.name;
        ASSERT_LE(r.child_count, clustered ? kChildren : 2u) << named.name;
      }
    }
}

// Of a clustered tree: it says over which part of its parent's size a node blends, so that leaves
// need no extent and no node stands there twice.
TEST(TreeBuild, AClusteredTreeBlendsLate) {
  Workers workers(2);
  for (const TreeRule& rule : {TreeRule{}, test::kSmallBlocks, test::kHierarchicalGs}) {
    const BakedScene baked = build_tree(test::random_cloud(3000, 3), workers, {}, rule);
    EXPECT_EQ(baked.tree.blend_share, blend_share(rule.kind));
    for (uint32_t n = 0; n < baked.tree.size(); ++n) {
      const NodeRecord& r = baked.tree.records[n];
      ASSERT_NE(r.child_count, 1u) << n;
      ASSERT_TRUE(r.child_count != 0 || r.extent == 0) << n;
    }
  }
}

TEST(TreeBuild, PartsOfANodeAreTwoToFourAndAllButTheLastFullBlocks) {
  for (const test::NamedRule& named : test::all_rules()) {
    const KdRule rule = kd_rule(named.rule);
    for (uint32_t size = rule.block + 1; size < rule.block + 5000; ++size) {
      const Parts parts = split_in_parts(size, rule);
      ASSERT_GE(parts.count, 2u) << size;
      ASSERT_LE(parts.count, kChildren) << size;
      uint32_t sum = 0;
      for (uint32_t i = 0; i < parts.count; ++i) {
        ASSERT_GT(parts.size[i], 0u) << size;
        if (i + 1 < parts.count) {
          ASSERT_EQ(parts.size[i] % rule.block, 0u) << size;
        }
        sum += parts.size[i];
      }
      ASSERT_EQ(sum, size);
    }
  }
}

TEST(TreeBuild, BlocksFollowOneAnotherAndAreAsFewAsCanBe) {
  const KdRule rule = kd_rule(test::kSmallBlocks);
  for (uint32_t size = 0; size < 5000; size += 7)
    for (const uint32_t most : {16u, 100u, 256u}) {
      uint32_t end = 0;
      for (const Range& part : parts_of(size, most, rule)) {
        ASSERT_EQ(part.begin, end);
        ASSERT_GT(part.size, 0u);
        ASSERT_LE(part.size, most);
        end += part.size;
      }
      ASSERT_EQ(end, size);
      if (most == rule.block) {
        ASSERT_EQ(parts_of(size, most, rule).size(), (size + most - 1) / most) << size;
      }
    }
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
  for (const test::NamedRule& named : test::all_rules()) {
    std::vector<std::string> ends;
    build_tree(
        test::random_cloud(3000, 10), workers,
        [&](const char* stage, uint64_t done, uint64_t total) {
          EXPECT_LE(done, total);
          if (done == total) ends.push_back(stage);
        },
        named.rule);
    std::vector<std::string> expected = {"splitting", "clustering", "merging", "aligning"};
    if (named.rule.kind == TreeKind::hierarchicalgs) expected.erase(expected.begin() + 1);
    EXPECT_EQ(ends, expected) << named.name;
  }
}

}  // namespace
}  // namespace voyager::tree_build_test
