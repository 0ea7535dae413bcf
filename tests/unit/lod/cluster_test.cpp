// What is put together in a block, and that each Gaussian is, once.
#include "runtime/lod/cluster.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>

#include "runtime/lod/exposure.h"
#include "runtime/lod/find_layout.h"
#include "runtime/lod/shape.h"
#include "tests/support/test_support.h"
#include "tests/support/tree_clouds.h"

namespace voyager::cluster_test {
namespace {

constexpr ExposureCode kPlain{255, 0}, kHidden{kLeastSeen, 0};

ClusterTree cluster_all(const GaussianCloud& cloud) {
  std::vector<uint32_t> leaves(cloud.size());
  std::iota(leaves.begin(), leaves.end(), 0u);
  const std::vector<ExposureCode> exposure(cloud.size(), kPlain);
  return cluster(cloud, {0, 0, 0}, leaves, exposure);
}

// Nodes that lead to it; the root none.
std::vector<uint32_t> parents_of(const ClusterTree& tree) {
  std::vector<uint32_t> count(tree.nodes.size());
  for (const ClusterTree::Node& node : tree.nodes)
    for (uint32_t i = 0; i < node.children; ++i) ++count.at(node.child[i]);
  return count;
}

// A plane of n x n, red and blue by turns.
GaussianCloud chequers(uint32_t n) {
  GaussianCloud cloud;
  cloud.sh_degree = 0;
  for (uint32_t i = 0; i < n * n; ++i) {
    const bool red = (i / n + i % n) % 2 == 0;
    cloud.position.insert(cloud.position.end(),
                          {static_cast<float>(i % n), static_cast<float>(i / n), 0});
    for (const float scale : {0.5f, 0.5f, 0.01f}) cloud.log_scale.push_back(std::log(scale));
    cloud.rotation.insert(cloud.rotation.end(), {1, 0, 0, 0});
    cloud.opacity.push_back(2);
    cloud.sh.insert(cloud.sh.end(), {red ? 1.5f : -1.5f, 0, red ? -1.5f : 1.5f});
  }
  return cloud;
}

TEST(Cluster, LowNodesShareAColour) {
  constexpr uint32_t kSide = 24;
  const ClusterTree tree = cluster_all(chequers(kSide));
  const auto is_red = [](uint32_t i) { return (i / kSide + i % kSide) % 2 == 0; };
  uint32_t low = 0, mixed = 0;
  for (const ClusterTree::Node& node : tree.nodes) {
    uint32_t leaves = 0, red = 0;
    for (uint32_t i = 0; i < node.children; ++i)
      if (node.child[i] < kSide * kSide) ++leaves, red += is_red(node.child[i]);
    if (leaves == 0 || leaves < node.children) continue;
    ++low;
    mixed += red != 0 && red != leaves;
  }
  EXPECT_GT(low, kSide * kSide / 8);
  EXPECT_EQ(mixed, 0u) << "of " << low;
}

TEST(Cluster, EachGaussianIsALeafOnceAndNodesHaveTwoToFourChildren) {
  for (const test::NamedCloud& named : test::all_clouds()) {
    if (named.cloud.size() > 1000) continue;
    SCOPED_TRACE(named.name);
    const ClusterTree tree = cluster_all(named.cloud);
    const size_t leaves = named.cloud.size();
    const std::vector<uint32_t> parents = parents_of(tree);
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
      const uint32_t children = tree.nodes[i].children;
      ASSERT_EQ(parents[i], i + 1 < tree.nodes.size() ? 1u : 0u) << i;
      if (i < leaves) {
        ASSERT_EQ(children, 0u);
        continue;
      }
      ASSERT_TRUE(children >= 2 && children <= kChildren) << children;
      for (uint32_t k = 0; k < children; ++k) ASSERT_LT(tree.nodes[i].child[k], i);
    }
  }
}

TEST(Cluster, IndicesAreOfTheBlockNotOfTheCloud) {
  const GaussianCloud cloud = test::random_cloud(300, 3);
  std::vector<uint32_t> leaves;
  for (uint32_t i = 7; i < 300; i += 3) leaves.push_back(i);
  const std::vector<ExposureCode> exposure(300, kPlain);
  const ClusterTree tree = cluster(cloud, {0, 0, 0}, leaves, exposure);
  EXPECT_EQ(std::count_if(tree.nodes.begin(), tree.nodes.end(),
                          [](const ClusterTree::Node& n) { return n.children == 0; }),
            static_cast<std::ptrdiff_t>(leaves.size()));
}

// What is hidden costs nothing: pairs of it are found first, however unlike one another.
TEST(Cluster, HiddenGaussiansArePutTogetherFirst) {
  const GaussianCloud cloud = chequers(2);  // 0 and 3 are red
  const std::vector<uint32_t> leaves = {0, 1, 2, 3};
  std::vector<ExposureCode> exposure(4, kPlain);
  const auto together = [&](uint32_t a, uint32_t b) {
    for (const ClusterTree::Node& node : cluster(cloud, {0, 0, 0}, leaves, exposure).nodes) {
      const uint32_t* end = node.child + node.children;
      if (node.children == 2 && std::find(node.child, end, a) != end &&
          std::find(node.child, end, b) != end)
        return true;
    }
    return false;
  };
  EXPECT_TRUE(together(0, 3));
  exposure = {kHidden, kHidden, kPlain, kPlain};
  EXPECT_TRUE(together(0, 1));
}

TEST(Cluster, ALayoutDoesNotDependOnThreads) {
  const GaussianCloud cloud = test::random_cloud(3000, 4);
  for (const TreeRule& rule : {TreeRule{}, test::kSmallBlocks}) {
    Workers one(1), two(2), five(5);
    const TreeLayout expected = find_layout(cloud, {0, 0, 0}, rule, one);
    for (Workers* workers : {&two, &five}) {
      const TreeLayout found = find_layout(cloud, {0, 0, 0}, rule, *workers);
      EXPECT_EQ(found.child_count, expected.child_count);
      EXPECT_EQ(found.leaf, expected.leaf);
      EXPECT_EQ(found.exposure, expected.exposure);
    }
  }
}

double seconds_to_cluster(const GaussianCloud& cloud) {
  const std::clock_t begin = std::clock();
  cluster_all(cloud);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Where nothing is nearer than the rest, a round must still find many pairs.
TEST(Cluster, GaussiansInOnePlaceTakeNoLongerThanOthers) {
  GaussianCloud cloud = test::random_cloud(1024, 5, 0);
  const double spread = seconds_to_cluster(cloud);
  for (float& x : cloud.position) x = 1.5f;
  EXPECT_LT(seconds_to_cluster(cloud), 10 * spread + 0.05);
}

}  // namespace
}  // namespace voyager::cluster_test
