// What every tree must satisfy, over random and degenerate clouds.
#include <cstring>
#include <map>

#include "runtime/lod/summarise.h"
#include "runtime/lod/validate.h"
#include "tests/support/tree_clouds.h"

namespace voyager::tree_test {
namespace {

template <class T>
bool same_bits(const std::pmr::vector<T>& a, const std::pmr::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_identical(const BakedScene& a, const BakedScene& b) {
  EXPECT_TRUE(same_bits(a.tree.records, b.tree.records));
  EXPECT_TRUE(same_bits(a.tree.first_child, b.tree.first_child));
  EXPECT_TRUE(same_bits(a.tree.parent, b.tree.parent));
  EXPECT_TRUE(same_bits(a.gaussian, b.gaussian));
  EXPECT_TRUE(same_bits(a.node_code, b.node_code));
  EXPECT_TRUE(same_bits(a.merged.position, b.merged.position));
  EXPECT_TRUE(same_bits(a.merged.log_scale, b.merged.log_scale));
  EXPECT_TRUE(same_bits(a.merged.rotation, b.merged.rotation));
  EXPECT_TRUE(same_bits(a.merged.opacity, b.merged.opacity));
  EXPECT_TRUE(same_bits(a.merged.sh, b.merged.sh));
}

class Tree : public ::testing::TestWithParam<test::NamedRule> {
 protected:
  BakedScene build(GaussianCloud cloud, Workers& workers) const {
    return build_tree(std::move(cloud), workers, {}, GetParam().rule);
  }

  // Of every cloud, built once a rule for all tests.
  struct NamedTree {
    std::string name;
    size_t gaussians;
    BakedScene baked;
  };
  const std::vector<NamedTree>& trees() const {
    static std::map<std::string, std::vector<NamedTree>> made;
    std::vector<NamedTree>& trees = made[GetParam().name];
    Workers workers(2);
    if (trees.empty())
      for (test::NamedCloud& named : test::all_clouds()) {
        const size_t gaussians = named.cloud.size();
        trees.push_back({named.name, gaussians, build(std::move(named.cloud), workers)});
      }
    return trees;
  }
};
INSTANTIATE_TEST_SUITE_P(Rules, Tree, ::testing::ValuesIn(test::all_rules()),
                         test::rule_name<::testing::TestParamInfo<test::NamedRule>>);

TEST_P(Tree, IsSoundForEveryCloud) {
  for (const NamedTree& tree : trees())
    for (const std::string& message : validate(tree.baked))
      ADD_FAILURE() << tree.name << ": " << message;
}

TEST_P(Tree, EveryGaussianIsExactlyOneLeaf) {
  for (const auto& [name, count, baked] : trees()) {
    std::vector<int> seen(count);
    for (uint32_t n = 0; n < baked.tree.size(); ++n)
      if (baked.tree.is_leaf(n)) ++seen.at(baked.gaussian[n]);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(count)) << name;
  }
}

TEST_P(Tree, DoesNotDependOnThreads) {
  std::vector<test::NamedCloud> clouds = test::all_clouds();
  clouds.push_back({"9000 random", test::specks(9000, 11, 0)});  // halved by several threads
  for (const test::NamedCloud& named : clouds) {
    Workers one(1), two(2), five(5);
    const BakedScene baked = build(named.cloud, one);
    SCOPED_TRACE(named.name);
    expect_identical(baked, build(named.cloud, two));
    expect_identical(baked, build(named.cloud, five));
  }
}

TEST_P(Tree, DoesNotDependOnTheCallersFloatingPointMode) {
  Workers workers(2);
  const GaussianCloud cloud = test::random_cloud(1000, 12);
  const BakedScene baked = build(cloud, workers);
  std::fenv_t saved;
  std::fegetenv(&saved);
  std::fesetround(FE_UPWARD);
  const BakedScene upward = build(cloud, workers);
  std::fesetenv(&saved);
  expect_identical(baked, upward);
}

TEST_P(Tree, SizeNeverGrowsFromParentToChild) {
  std::mt19937 random(3);
  for (const NamedTree& named : trees()) {
    const LodTree& tree = named.baked.tree;
    std::vector<Vec3f> centres = {{0, 0, 0}, {1e17f, -1e17f, 3e16f}, {-9.9e17f, 9.9e17f, 9.9e17f}};
    for (int i = 0; i < 10; ++i) {
      const NodeRecord& r = tree.records[random() % tree.size()];
      const Vec3f middle = 0.5f * (r.box_min + r.box_max);
      centres.push_back(middle);                             // inside
      centres.push_back({r.box_max.x, middle.y, middle.z});  // on a face
      centres.push_back(
          {middle.x, std::nextafter(r.box_min.y, -1e30f), middle.z});  // an ulp outside
      centres.push_back(3.0f * r.box_max - 2.0f * r.box_min);          // outside
    }
    for (const Vec3f& c : centres)
      for (uint32_t n = 1; n < tree.size(); ++n)
        ASSERT_LE(tree.screen_size(n, c), tree.screen_size(tree.parent[n], c))
            << named.name << ", node " << n;
  }
}

TEST_P(Tree, ExtentsAndOpacitiesAreFiniteAndNotNegative) {
  for (const NamedTree& tree : trees()) {
    for (const NodeRecord& r : tree.baked.tree.records)
      ASSERT_TRUE(r.extent >= 0 && std::isfinite(r.extent)) << tree.name << ": " << r.extent;
    for (const float opacity : tree.baked.merged.opacity)
      ASSERT_TRUE(opacity >= 0 && std::isfinite(opacity)) << tree.name << ": " << opacity;
  }
}

TEST_P(Tree, MeansStayInsideTheBoxes) {
  // A weighted mean of children lies in their hull, up to its rounding.
  Workers workers(2);
  const BakedScene baked = build(test::random_cloud(5000, 6), workers);
  for (uint32_t n = 0; n < baked.tree.size(); ++n) {
    const Vec3f mean = node_gaussian(n, baked).gaussian.mean;
    const NodeRecord& r = baked.tree.records[n];
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(mean[axis], r.box_min[axis] - 1e-5f);
      EXPECT_LE(mean[axis], r.box_max[axis] + 1e-5f);
    }
  }
}

}  // namespace
}  // namespace voyager::tree_test
