// bake --tree hierarchicalgs against HierarchicalGS's construction, written down as the recursion
// that it is: boxes of mean ± 3·max(s), halved by the median of the means along their longest side,
// and the moments of all Gaussians below a node.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/lod/summarise.h"
#include "tests/support/tree_clouds.h"

namespace voyager::hierarchicalgs_tree_test {
namespace {

constexpr double kRounding = 2e-5;  // of binary32 words, a level

struct Leaf {
  Gaussian gaussian;
  const float* sh;
};

class Reference {
 public:
  explicit Reference(const BakedScene& baked) : baked_(baked) {
    for (size_t i = 0; i < baked.leaves.size(); ++i) {
      const size_t floats = size_t{3} * static_cast<size_t>(baked.leaves.coefficients());
      leaves_.push_back({activate(leaf_words(baked, i), true), &baked.leaves.sh[i * floats]});
    }
  }

  void expect_equal() {
    std::vector<uint32_t> all(leaves_.size());
    std::iota(all.begin(), all.end(), 0u);
    if (!all.empty()) expect_node(0, all);
  }

 private:
  void expect_node(uint32_t node, std::vector<uint32_t> below) {
    SCOPED_TRACE("node " + std::to_string(node));
    const NodeRecord& r = baked_.tree.records[node];
    float side[3];
    expect_box(r, below, side);
    if (below.size() == 1) {
      ASSERT_EQ(r.child_count, 0u);
      ASSERT_EQ(r.extent, 0.0f);
      ASSERT_EQ(baked_.gaussian[node], below[0]);
      return;
    }
    ASSERT_EQ(r.child_count, 2u);
    ASSERT_EQ(r.extent, std::max({side[0], side[1], side[2]}));
    expect_moments(node, below);
    const int axis = static_cast<int>(std::max_element(side, side + 3) - side);
    std::sort(below.begin(), below.end(), [&](uint32_t a, uint32_t b) {
      const float x = leaves_[a].gaussian.mean[axis], y = leaves_[b].gaussian.mean[axis];
      return x < y || (x == y && a < b);
    });
    const auto half = below.begin() + static_cast<std::ptrdiff_t>(below.size() / 2);
    const uint32_t first = baked_.tree.first_child[node];
    expect_node(first, {below.begin(), half});
    expect_node(first + 1, {half, below.end()});
  }

  void expect_box(const NodeRecord& r, const std::vector<uint32_t>& below, float* side) {
    for (int axis = 0; axis < 3; ++axis) {
      float least = INFINITY, most = -INFINITY;
      for (const uint32_t i : below) {
        const Gaussian& g = leaves_[i].gaussian;
        const float reach = 3.0f * std::max({g.scale.x, g.scale.y, g.scale.z});
        least = std::min(least, g.mean[axis] - reach);
        most = std::max(most, g.mean[axis] + reach);
      }
      ASSERT_EQ(r.box_min[axis], least);
      ASSERT_EQ(r.box_max[axis], most);
      side[axis] = most - least;
    }
  }

  // The moments of moments are those of all: nothing but rounding lies between.
  void expect_moments(uint32_t node, const std::vector<uint32_t>& below) {
    const MergeInput merged = node_gaussian(node, baked_);
    double weight = 0, mean[3] = {}, covariance[3][3] = {}, reach = 0;
    const auto weight_of = [](const Gaussian& g) {
      const Vec3d s{g.scale.x, g.scale.y, g.scale.z};
      return double{g.opacity} * ((s.x * s.y + s.x * s.z) + s.y * s.z);
    };
    for (const uint32_t i : below) {
      weight += weight_of(leaves_[i].gaussian);
      for (int a = 0; a < 3; ++a)
        mean[a] += weight_of(leaves_[i].gaussian) * double{leaves_[i].gaussian.mean[a]};
    }
    for (double& m : mean) m /= weight;
    for (const uint32_t i : below) {
      const Gaussian& g = leaves_[i].gaussian;
      const Mat3d turn =
          rotation(normalise(Quatd{g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z}));
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          double sum = (g.mean[a] - mean[a]) * (g.mean[b] - mean[b]);
          for (int k = 0; k < 3; ++k)
            sum += turn.row[a][k] * turn.row[b][k] * double{g.scale[k]} * double{g.scale[k]};
          covariance[a][b] += weight_of(g) / weight * sum;
        }
    }
    const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
    for (const double m : mean) reach = std::max(reach, std::fabs(m));
    reach = std::max(reach, std::sqrt(trace));
    const Gaussian& g = merged.gaussian;
    const Mat3d turn =
        rotation(normalise(Quatd{g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z}));
    for (int a = 0; a < 3; ++a) {
      ASSERT_NEAR(g.mean[a], mean[a], kRounding * reach);
      for (int b = 0; b < 3; ++b) {
        double sum = 0;
        for (int k = 0; k < 3; ++k)
          sum += turn.row[a][k] * turn.row[b][k] * double{g.scale[k]} * double{g.scale[k]};
        ASSERT_NEAR(sum, covariance[a][b], 5 * kRounding * trace);
      }
    }
    ASSERT_NEAR(weight_of(g) / weight, 1, kRounding);
    for (int k = 0; k < 3 * baked_.merged.coefficients(); ++k) {
      double sum = 0;
      for (const uint32_t i : below)
        sum += weight_of(leaves_[i].gaussian) / weight * double{leaves_[i].sh[k]};
      ASSERT_NEAR(merged.sh[k], sum, kRounding);
    }
  }

  const BakedScene& baked_;
  std::vector<Leaf> leaves_;
};

BakedScene build(GaussianCloud cloud) {
  Workers workers(2);
  return build_tree(std::move(cloud), workers, {}, test::kHierarchicalGs);
}

TEST(HierarchicalGsTree, IsThatOfThePlainRecursion) {
  for (const size_t count : {1, 2, 3, 4, 5, 7, 8, 100, 777, 2048}) {
    SCOPED_TRACE(count);
    const BakedScene baked = build(test::random_cloud(count, 3, 1));
    EXPECT_EQ(baked.tree.size(), 2 * count - 1);
    Reference(baked).expect_equal();
  }
}

// Ties go to the lower index; sides that are equally long to the first.
TEST(HierarchicalGsTree, IsThatOfTheRecursionWhereMeansTie) {
  for (const float grid : {4.0f, 100.0f}) {
    GaussianCloud cloud = test::random_cloud(500, 4, 0);
    for (float& x : cloud.position) x = std::round(x / grid) * grid;
    for (float& s : cloud.log_scale) s = -1;
    Reference(build(std::move(cloud))).expect_equal();
  }
}

// Where large Gaussians reach beyond the means, it is their boxes that say which side is longest.
TEST(HierarchicalGsTree, HalvesTheLongestSideOfTheBoxesNotOfTheMeans) {
  GaussianCloud cloud = test::random_cloud(2, 5, 0);
  cloud = test::random_cloud(4, 5, 0);
  const float x[4] = {0, 1, 2, 3}, y[4] = {0, 0.5f, 0.5f, 0};
  for (size_t i = 0; i < 4; ++i) {
    cloud.position[3 * i] = x[i];
    cloud.position[3 * i + 1] = y[i];
    cloud.position[3 * i + 2] = 0;
    for (size_t k = 0; k < 3; ++k) cloud.log_scale[3 * i + k] = std::log(i == 1 ? 4.0f : 0.01f);
  }
  // 1 reaches 12 to each side, alike on all axes: the first is taken, though y and z tie.
  const BakedScene baked = build(cloud);
  Reference(baked).expect_equal();
  EXPECT_EQ(baked.tree.records[0].extent, 24.0f);
}

TEST(HierarchicalGsTree, OpacityTimesSurfaceTelescopes) {
  // The root's weight is the sum over all leaves: one rounding of an opacity a level.
  for (const size_t count : {5, 1000, 20000}) {
    const BakedScene baked = build(test::random_cloud(count, 5));
    double leaves = 0.0;
    for (uint32_t n = 0; n < baked.tree.size(); ++n)
      if (baked.tree.is_leaf(n)) leaves += merge_weight(node_gaussian(n, baked).gaussian);
    EXPECT_NEAR(merge_weight(node_gaussian(0, baked).gaussian) / leaves, 1.0, 2e-6) << count;
  }
}

TEST(HierarchicalGsTree, TwoLevelsHalveTheExtentOfASurface) {
  GaussianCloud cloud = test::random_cloud(16384, 2, 0);
  for (size_t i = 0; i < cloud.size(); ++i) {
    cloud.position[3 * i + 2] = 0.0f;
    for (size_t k = 0; k < 3; ++k) cloud.log_scale[3 * i + k] = -12.0f;
  }
  const BakedScene baked = build(std::move(cloud));
  double ratio = 0.0;
  int measured = 0;
  for (uint32_t n = 3; n < 127; ++n, ++measured)  // to the sixth level under the root
    ratio += baked.tree.records[n].extent /
             baked.tree.records[baked.tree.parent[baked.tree.parent[n]]].extent;
  EXPECT_NEAR(ratio / measured, 0.5, 0.05);
}

}  // namespace
}  // namespace voyager::hierarchicalgs_tree_test
