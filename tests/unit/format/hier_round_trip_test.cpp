// .hier in, through a .voy, and out again.
#include <bit>

#include "runtime/format/export_flat.h"
#include "runtime/format/export_hier.h"
#include "runtime/format/extent_cut.h"
#include "runtime/frame/load.h"
#include "runtime/lod/kept_tree.h"
#include "runtime/scene/import/hier/tree.h"
#include "tests/support/hier_files.h"
#include "tests/support/scene_files.h"

namespace voyager::hier_round_trip_test {
namespace {

using test::Bytes;

std::shared_ptr<const ByteSource> named(const Bytes& bytes) {
  return std::make_shared<MemorySource>("test.hier", bytes);
}

Bytes voy_of(const Bytes& hier, Quality quality = Quality::lossless) {
  return test::scene_bytes(read_kept_tree(named(hier)).scene, quality);
}

Bytes hier_of(const Bytes& voy) {
  const test::TempFolder folder;
  export_hier(SceneFile(test::source_of(voy)), folder.file("out.hier"));
  return test::file_bytes(folder.file("out.hier"));
}

bool same(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}

// All numbers of the further Gaussians of all nodes.
std::vector<uint32_t> further_bits(const Bytes& hier) {
  const hier::File file(named(hier));
  const hier::Tree tree = hier::read_tree(file);
  std::vector<uint32_t> bits;
  for (const FurtherCount& of : tree.further) {
    const Bytes bytes = file.read_gaussians(tree.gaussian[of.node] + 1, of.count);
    const hier::Rows rows(bytes, of.count, file.half());
    bits.insert(bits.end(), {of.node, of.count});
    for (size_t i = 0; i < of.count; ++i) {
      float words[kHierFloats];
      rows.copy_all(i, words);
      for (const float word : words) bits.push_back(std::bit_cast<uint32_t>(word));
    }
  }
  return bits;
}

// Nodes of both, breadth-first.
void expect_same_tree(const Bytes& a, const Bytes& b) {
  const hier::File first(named(a)), second(named(b));
  const hier::Tree of_first = hier::read_tree(first), of_second = hier::read_tree(second);
  ASSERT_EQ(of_first.child_count, of_second.child_count);
  for (size_t n = 0; n < of_first.child_count.size(); ++n) {
    const auto gaussian = [&](const hier::File& file, const hier::Tree& tree) {
      return file.read_gaussians(tree.gaussian[n], 1);
    };
    const Bytes one = gaussian(first, of_first), two = gaussian(second, of_second);
    const hier::Rows in(one, 1, first.half()), out(two, 1, second.half());
    const GaussianWords p = in.words(0), q = out.words(0);
    const float* words[2] = {&p.mean.x, &q.mean.x};
    for (size_t i = 0; i < sizeof p / sizeof(float); ++i)
      EXPECT_TRUE(same(words[0][i], words[1][i])) << "node " << n << ", word " << i;
    float sh[2][kHierShFloats];
    in.copy_sh(0, sh[0]);
    out.copy_sh(0, sh[1]);
    for (size_t k = 0; k < kHierShFloats; ++k) EXPECT_TRUE(same(sh[0][k], sh[1][k]));
    const HierBox from = first.read_boxes(of_first.file_node[n], 1).front();
    const HierBox to = second.read_boxes(of_second.file_node[n], 1).front();
    EXPECT_EQ(std::memcmp(&from, &to, sizeof from), 0) << "node " << n;
  }
}

TEST(HierRoundTrip, EveryNumberComesBackFromALosslessScene) {
  for (const bool half : {false, true}) {
    const Bytes in = test::hier_bytes(test::merged_hier(), half);
    const Bytes out = hier_of(voy_of(in));
    expect_same_tree(in, out);
    EXPECT_EQ(further_bits(in), further_bits(out));
    EXPECT_EQ(hier_of(voy_of(out)), out);
  }
}

TEST(HierRoundTrip, AMergedFileComesBackToTheByte) {
  const Bytes in = test::hier_bytes(test::merged_roots_hier());
  EXPECT_EQ(hier_of(voy_of(in)), in);
  EXPECT_EQ(further_bits(in).size(), 3 * 2 + 5 * kHierFloats);
  const Bytes half = test::hier_bytes(test::merged_roots_hier(), true);
  EXPECT_EQ(further_bits(hier_of(voy_of(half))), further_bits(half));
  EXPECT_EQ(further_bits(hier_of(voy_of(in, Quality::compact))), further_bits(in));
}

// More than are read at a time, of one node and of many.
TEST(HierRoundTrip, AnyNumberOfFurtherGaussiansComesBack) {
  constexpr int32_t kOfRoot = 9000, kChildren = 600;
  test::HierSample s;
  std::mt19937 random(10);
  s.nodes.push_back({2, -1, 0, 0, kOfRoot, 1, kChildren});
  s.boxes.push_back({{-1, -1, -1}, 9, {1, 1, 1}, 9});
  for (int32_t i = 0; i < kChildren; ++i) {
    s.nodes.push_back({1, 0, kOfRoot + 3 * i, 0, 3, 0, 0});
    s.boxes.push_back({{-1, -1, -1}, 0, {1, 1, 1}, 0});
  }
  for (int32_t i = 0; i < kOfRoot + 3 * kChildren; ++i) test::add_hier_gaussian(s, random);
  const Bytes in = test::hier_bytes(s);
  EXPECT_TRUE(hier_of(voy_of(in)) == in);
}

// The format has no place for the share where blending starts, for footprints, and for the order of
// the input; turned leaves come back turned.
TEST(HierRoundTrip, OurOwnTreeComesBackToTheByte) {
  for (const TreeKind kind : {TreeKind::clustered, TreeKind::hierarchicalgs}) {
    const BakedScene baked = test::bake(test::random_cloud(2000, 41, 2), {.kind = kind});
    const Bytes hier = hier_of(test::scene_bytes(baked, Quality::lossless));
    const KeptTree kept = read_kept_tree(named(hier));
    EXPECT_TRUE(notes_of(kept).empty());
    ASSERT_EQ(kept.scene.tree.size(), baked.tree.size());
    for (size_t n = 0; n < baked.tree.size(); ++n) {
      EXPECT_EQ(kept.scene.tree.records[n].extent, baked.tree.records[n].extent);
      EXPECT_EQ(kept.scene.tree.records[n].child_count, baked.tree.records[n].child_count);
    }
    EXPECT_EQ(hier_of(voy_of(hier)), hier);
  }
}

TEST(HierRoundTrip, LeavesOfTheSceneAreThoseOfTheFile) {
  const Bytes hier = test::hier_bytes(test::merged_hier());
  const Bytes voy = voy_of(hier);
  const GaussianCloud leaves = read_leaves(SceneFile(test::source_of(voy)));
  const BakedScene scene = read_kept_tree(named(hier)).scene;
  ASSERT_EQ(leaves.size(), scene.leaves.size());
  for (size_t i = 0; i < leaves.size(); ++i)
    EXPECT_EQ(leaves.opacity[i], flat_logit(scene.leaves.opacity[i]));
  EXPECT_EQ(leaves.position, scene.leaves.position);
  EXPECT_EQ(leaves.rotation, scene.leaves.rotation);
}

TEST(HierRoundTrip, AShareOfTheTreeIsThatOfItsScene) {
  const BakedScene baked = test::bake(test::random_cloud(500, 42, 1));
  const Bytes hier = hier_of(test::scene_bytes(baked, Quality::lossless));
  const BakedScene kept = read_kept_tree(named(hier)).scene;
  const Bytes voy = test::scene_bytes(kept, Quality::lossless);
  const GaussianCloud of_tree = extent_cut(kept, 100);
  const GaussianCloud of_file = read_extent_cut(SceneFile(test::source_of(voy)), 100);
  ASSERT_EQ(of_tree.size(), of_file.size());
  EXPECT_GT(of_tree.size(), 50u);
  EXPECT_LE(of_tree.size(), 100u);
  std::vector<float> a(of_tree.position.begin(), of_tree.position.end());
  std::vector<float> b(of_file.position.begin(), of_file.position.end());
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  EXPECT_EQ(a, b);
}

// Leaves of such a tree may have opacities above 1, which no logit says.
TEST(HierRoundTrip, OpacitiesAreDrawnAsTheyAre) {
  const test::HierSample sample = test::merged_hier();
  const Bytes hier = test::hier_bytes(sample);
  const float most = *std::max_element(sample.opacities.begin() + 4, sample.opacities.end());
  ASSERT_GT(most, 1.0f);
  Workers workers;
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const Bytes voy = voy_of(hier, quality);
    const auto scene = load_scene(test::source_of(voy), std::pmr::get_default_resource(), workers);
    EXPECT_TRUE(scene->damaged.empty());
    EXPECT_GT(scene->profile.opacities_above_one, 0u);
  }
  const Bytes compact = voy_of(hier, Quality::compact);
  const Chunk chunk = SceneFile(test::source_of(compact)).read_chunk(0);
  float largest = 0;
  for (size_t i = 0; i < chunk.node.size(); ++i)
    if (chunk.is_leaf(i)) largest = std::max(largest, chunk.words[i].opacity);
  EXPECT_NEAR(largest, most, 0.001f);
}

}  // namespace
}  // namespace voyager::hier_round_trip_test
