#include "runtime/format/extent_cut.h"

#include <algorithm>
#include <set>

#include "runtime/format/export_flat.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::extent_cut_test {
namespace {

GaussianCloud cut_of(const test::Bytes& bytes, uint64_t most) {
  return read_extent_cut(SceneFile(test::source_of(bytes)), most);
}

// By refining one node after the other, the greatest extent first, equal ones together.
uint64_t expected_size(const LodTree& tree, uint64_t most) {
  std::multiset<std::pair<float, uint32_t>> interior;
  uint64_t size = 1, best = 1;
  if (!tree.is_leaf(0)) interior.emplace(tree.records[0].extent, 0);
  while (!interior.empty()) {
    const float extent = interior.rbegin()->first;
    while (!interior.empty() && interior.rbegin()->first == extent) {
      const uint32_t node = std::prev(interior.end())->second;
      interior.erase(std::prev(interior.end()));
      const uint32_t children = tree.records[node].child_count;
      size += children - 1;
      for (uint32_t c = 0; c < children; ++c)
        if (const uint32_t child = tree.first_child[node] + c; !tree.is_leaf(child))
          interior.emplace(tree.records[child].extent, child);
    }
    if (size > most) break;
    best = size;
  }
  return best;
}

TEST(ExtentCut, IsTheLargestThatIsNotAboveTheSize) {
  const BakedScene baked = test::bake(test::random_cloud(3000, 20, 1));
  const test::Bytes bytes = test::scene_bytes(baked, Quality::lossless);
  for (const uint64_t most : {1, 2, 7, 100, 750, 1500, 2999, 3000})
    EXPECT_EQ(cut_of(bytes, most).size(), expected_size(baked.tree, most)) << most;
  EXPECT_GT(cut_of(bytes, 750).size(), 700u);
}

TEST(ExtentCut, OfAnyShapeOfTreeToo) {
  for (const auto shape : {test::TreeShape::star, test::TreeShape::star_of_stars,
                           test::TreeShape::recursive, test::TreeShape::eight_way}) {
    const BakedScene baked = test::baked_of(test::random_tree(shape, 320, 5));
    const test::Bytes bytes = test::scene_bytes(baked, Quality::lossless, 1, kMinChunkBytes);
    for (const uint64_t most : {1, 10, 80, 320})
      EXPECT_EQ(cut_of(bytes, most).size(), expected_size(baked.tree, most)) << most;
  }
}

// The positions of the leaves, so that none is there twice and none is missing.
TEST(ExtentCut, AllLeavesWhereAllFit) {
  const GaussianCloud cloud = test::random_cloud(2000, 20, 2);
  GaussianCloud cut = cut_of(test::scene_bytes(test::bake(cloud), Quality::lossless), 2000);
  std::vector<float> a(cloud.position.begin(), cloud.position.end());
  std::vector<float> b(cut.position.begin(), cut.position.end());
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  EXPECT_EQ(a, b);
  EXPECT_EQ(cut.sh_degree, 2);
}

// Those of merged Gaussians may exceed 1 in the tree.
TEST(ExtentCut, OpacitiesAreLogits) {
  GaussianCloud cloud = test::random_cloud(2000, 20, 0);
  for (float& opacity : cloud.opacity) opacity = 8.0f;
  const GaussianCloud cut = cut_of(test::scene_bytes(test::bake(cloud), Quality::lossless), 200);
  for (const float logit : cut.opacity) {
    EXPECT_TRUE(std::isfinite(logit));
    EXPECT_LE(sigmoid(logit), 1.0f);
  }
  EXPECT_FLOAT_EQ(flat_logit(1.7f), std::log(0x1p24f - 1));
  EXPECT_FLOAT_EQ(sigmoid(flat_logit(0.25f)), 0.25f);
  EXPECT_EQ(flat_logit(0.0f), -kMaxLogit);
}

TEST(ExtentCut, ADamagedChunkLeavesNoFile) {
  const test::TempFolder folder;
  const test::Bytes bytes =
      test::scene_bytes(test::bake(test::random_cloud(100, 23)), Quality::compact);
  const SceneFile file(
      std::make_shared<test::FlippedSource>(bytes, bytes.size() - 1, std::byte{4}));
  EXPECT_EQ(test::error_code([&] { export_extent_cut(file, 50, folder.file("out.ply")); }),
            ErrorCode::damaged_chunk);
  EXPECT_FALSE(std::filesystem::exists(folder.file("out.ply")));
}

TEST(ExtentCut, OfAnEmptySceneNothing) {
  EXPECT_EQ(
      cut_of(test::scene_bytes(test::bake(test::random_cloud(0, 1)), Quality::lossless), 5).size(),
      0u);
}

}  // namespace
}  // namespace voyager::extent_cut_test
