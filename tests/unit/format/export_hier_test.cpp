#include "runtime/format/export_hier.h"

#include <cstring>

#include "runtime/math/axes.h"
#include "tests/support/scene_files.h"

namespace voyager::export_hier_test {
namespace {

// The .hier layout as METHOD §2 writes it down, read without the exporter's structures.
class Hier {
 public:
  explicit Hier(test::Bytes bytes) : bytes_(std::move(bytes)) {}
  size_t size() const { return bytes_.size(); }
  int32_t count() const { return at<int32_t>(0); }
  int32_t node_count() const { return at<int32_t>(4 + 236 * p()); }
  float position(size_t i, size_t axis) const { return at<float>(4 + 12 * i + 4 * axis); }
  float rotation(size_t i, size_t k) const { return at<float>(4 + 12 * p() + 16 * i + 4 * k); }
  float log_scale(size_t i, size_t k) const { return at<float>(4 + 28 * p() + 12 * i + 4 * k); }
  float opacity(size_t i) const { return at<float>(4 + 40 * p() + 4 * i); }
  float sh(size_t i, size_t k) const { return at<float>(4 + 44 * p() + 192 * i + 4 * k); }
  // depth, parent, start, count_leafs, count_merged, start_children, count_children
  int32_t node(size_t n, size_t field) const {
    return at<int32_t>(8 + 236 * p() + 28 * n + 4 * field);
  }
  float box(size_t n, size_t k) const { return at<float>(8 + 264 * p() + 32 * n + 4 * k); }

 private:
  size_t p() const { return static_cast<size_t>(count()); }
  template <class T>
  T at(size_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }
  test::Bytes bytes_;
};

Hier exported(const BakedScene& baked) {
  const test::TempFolder folder;
  const test::Bytes bytes = test::scene_bytes(baked, Quality::lossless);
  export_hier(SceneFile(test::source_of(bytes)), folder.file("out.hier"));
  return Hier(test::file_bytes(folder.file("out.hier")));
}

TEST(ExportHier, HoldsTheTree) {
  const BakedScene baked = test::bake(test::random_cloud(3000, 30, 1));
  const Hier hier = exported(baked);
  const size_t n = baked.tree.size();
  ASSERT_EQ(hier.size(), 8 + 236 * n + 60 * n);
  ASSERT_EQ(static_cast<size_t>(hier.count()), n);
  ASSERT_EQ(static_cast<size_t>(hier.node_count()), n);
  for (uint32_t i = 0; i < n; ++i) {
    const NodeRecord& r = baked.tree.records[i];
    const bool leaf = r.child_count == 0;
    ASSERT_EQ(static_cast<uint32_t>(hier.node(i, 1)), baked.tree.parent[i]);
    ASSERT_EQ(hier.node(i, 2), static_cast<int32_t>(i));
    ASSERT_EQ(hier.node(i, 3), leaf ? 1 : 0);
    ASSERT_EQ(hier.node(i, 4), leaf ? 0 : 1);
    ASSERT_EQ(hier.node(i, 5), leaf ? 0 : static_cast<int32_t>(baked.tree.first_child[i]));
    ASSERT_EQ(hier.node(i, 6), static_cast<int32_t>(r.child_count));
    int32_t depth = 0;
    for (uint32_t c = 0; c < r.child_count; ++c)
      depth = std::max(depth, 1 + hier.node(baked.tree.first_child[i] + c, 0));
    ASSERT_EQ(hier.node(i, 0), depth);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(hier.box(i, static_cast<size_t>(axis)), r.box_min[axis]);
      ASSERT_EQ(hier.box(i, static_cast<size_t>(axis) + 4), r.box_max[axis]);
    }
    ASSERT_EQ(hier.box(i, 3), r.extent);
    ASSERT_EQ(hier.box(i, 7), r.extent);
  }
}

// Entry (row, column) of R diag(s²) Rᵀ.
double covariance(const Quatd& q, const Vec3d& s, int row, int column) {
  const Mat3d m = rotation(normalise(q));
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += m.row[row][k] * s[k] * s[k] * m.row[column][k];
  return sum;
}

TEST(ExportHier, LeavesAreTheSameGaussiansTurnedToTheirParents) {
  const BakedScene baked = test::bake(test::random_cloud(800, 31, 2));
  const Hier hier = exported(baked);
  size_t turned = 0;
  for (uint32_t i = 0; i < baked.tree.size(); ++i) {
    if (!baked.tree.is_leaf(i)) continue;
    const GaussianWords words = leaf_words(baked, baked.gaussian[i]);
    const Vec3f log_scale = turn_scale(words.log_scale, baked.node_code[i]);
    turned += baked.node_code[i] != 0;
    Vec3d scale{}, own{};
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(hier.log_scale(i, static_cast<size_t>(k)), log_scale[k]);
      ASSERT_EQ(hier.position(i, static_cast<size_t>(k)), words.mean[k]);
      scale[k] = std::exp(double{log_scale[k]});
      own[k] = std::exp(double{words.log_scale[k]});
    }
    const Quatd q{hier.rotation(i, 0), hier.rotation(i, 1), hier.rotation(i, 2),
                  hier.rotation(i, 3)};
    const Quatd q0{words.rotation.w, words.rotation.x, words.rotation.y, words.rotation.z};
    const double bound = 1e-6 * std::max({own.x, own.y, own.z}) * std::max({own.x, own.y, own.z});
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        ASSERT_NEAR(covariance(q, scale, row, column), covariance(q0, own, row, column), bound);
    ASSERT_EQ(hier.opacity(i), sigmoid(words.opacity));
  }
  EXPECT_GT(turned, 0u);
}

TEST(ExportHier, ShIsPaddedToDegreeThree) {
  const BakedScene baked = test::bake(test::random_cloud(50, 32, 1));
  const Hier hier = exported(baked);
  for (uint32_t i = 0; i < baked.tree.size(); ++i) {
    const GaussianCloud& cloud = baked.tree.is_leaf(i) ? baked.leaves : baked.merged;
    for (size_t k = 0; k < 48; ++k)
      ASSERT_EQ(hier.sh(i, k), k < 12 ? cloud.sh[baked.gaussian[i] * 12 + k] : 0.0f);
  }
}

TEST(ExportHier, AnEmptySceneIsEightBytesOfZeros) {
  const Hier hier = exported(test::bake(test::random_cloud(0, 1)));
  EXPECT_EQ(hier.size(), 8u);
  EXPECT_EQ(hier.count(), 0);
  EXPECT_EQ(hier.node_count(), 0);
}

}  // namespace
}  // namespace voyager::export_hier_test
