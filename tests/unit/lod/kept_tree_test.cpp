// HierarchicalGS's files in: their own tree, and what no tree can be.
#include "runtime/lod/kept_tree.h"

#include <functional>

#include "runtime/lod/validate.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/importer.h"
#include "tests/support/hier_files.h"
#include "tests/support/scene_files.h"

namespace voyager::kept_tree_test {
namespace {

using test::Bytes;

std::shared_ptr<const ByteSource> named(const Bytes& bytes, const char* name = "test.hier") {
  return std::make_shared<MemorySource>(name, bytes);
}

KeptTree read(const Bytes& bytes) {
  return read_kept_tree(named(bytes));
}

TEST(KeptTree, IsTheFilesBreadthFirst) {
  for (const bool half : {false, true}) {
    const KeptTree kept = read(test::hier_bytes(test::merged_hier(), half));
    const BakedScene& scene = kept.scene;
    EXPECT_TRUE(validate(scene).empty()) << validate(scene).front();
    const uint32_t children[] = {2, 2, 3, 2, 0, 0, 0, 0, 0, 0};
    const float extents[] = {INFINITY, 16, 7, 4, 3, 0, 0, 0, 0, 0};
    ASSERT_EQ(scene.tree.size(), 10u);
    for (uint32_t n = 0; n < 10; ++n) {
      EXPECT_EQ(scene.tree.records[n].child_count, children[n]) << n;
      EXPECT_EQ(scene.tree.records[n].extent, extents[n]) << n;
    }
    ASSERT_EQ(kept.scene.further.nodes.size(), 1u);
    EXPECT_EQ(kept.scene.further.nodes[0].node, 0u);
    EXPECT_EQ(kept.scene.further.nodes[0].count, 1u);
    EXPECT_EQ(kept.scene.further.words.size(), kHierFloats);
    EXPECT_EQ(kept.unused, 0u);
    EXPECT_EQ(kept.childless, 1u);
    EXPECT_EQ(kept.grown, 0u);
    EXPECT_EQ(notes_of(kept).size(), 1u);
  }
}

// Nodes 7 to 9 of the file are the children of node 2, which come before those of node 3.
TEST(KeptTree, GaussiansAreTheFilesWords) {
  const test::HierSample sample = test::merged_hier();
  const KeptTree kept = read(test::hier_bytes(sample));
  const size_t gaussian[] = {0, 2, 7, 3, 6, 8, 9, 10, 4, 5};
  for (uint32_t n = 0; n < 10; ++n) {
    const bool leaf = kept.scene.tree.is_leaf(n);
    const GaussianCloud& cloud = leaf ? kept.scene.leaves : kept.scene.merged;
    const size_t i = kept.scene.gaussian[n], of = gaussian[n];
    EXPECT_EQ(cloud.opacity[i], sample.opacities[of]);
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(cloud.position[3 * i + k], sample.positions[3 * of + k]);
      EXPECT_EQ(cloud.log_scale[3 * i + k], sample.log_scales[3 * of + k]);
    }
    for (size_t k = 0; k < 4; ++k)
      EXPECT_EQ(cloud.rotation[4 * i + k], sample.rotations[4 * of + k]);
    for (size_t k = 0; k < kHierShFloats; ++k)
      EXPECT_EQ(cloud.sh[kHierShFloats * i + k], sample.sh[kHierShFloats * of + k]);
  }
}

TEST(KeptTree, HalvesAreTheirBinary32) {
  const test::HierSample sample = test::merged_hier();
  const KeptTree kept = read(test::hier_bytes(sample, true));
  for (size_t i = 0; i < kept.scene.leaves.size(); ++i) {
    const size_t of[] = {4, 5, 6, 8, 9, 10};
    EXPECT_EQ(kept.scene.leaves.opacity[i], half_to_float(float_to_half(sample.opacities[of[i]])));
    EXPECT_EQ(kept.scene.leaves.position[3 * i], sample.positions[3 * of[i]]);
    EXPECT_EQ(kept.scene.leaves.sh[kHierShFloats * i + 47],
              half_to_float(float_to_half(sample.sh[kHierShFloats * of[i] + 47])));
  }
}

TEST(KeptTree, BandsThatAreZeroEverywhereAreLeftOut) {
  test::HierSample sample = test::small_hier();
  for (size_t i = 0; i < sample.sh.size(); ++i)
    if (i % kHierShFloats >= 12) sample.sh[i] = 0;
  const KeptTree kept = read(test::hier_bytes(sample));
  EXPECT_EQ(kept.scene.leaves.sh_degree, 1);
  EXPECT_EQ(kept.scene.leaves.left_out_bands, 2);
  EXPECT_EQ(kept.scene.merged.sh[11], sample.sh[11]);
}

TEST(KeptTree, GaussiansOfNoNodeAreCounted) {
  test::HierSample sample = test::merged_hier();
  sample.nodes[0].count_merged = 1;
  const KeptTree kept = read(test::hier_bytes(sample));
  EXPECT_TRUE(kept.scene.further.nodes.empty());
  EXPECT_EQ(kept.unused, 1u);
  EXPECT_EQ(notes_of(kept).size(), 2u);
}

TEST(KeptTree, BoxesGrowToHoldTheirChildren) {
  test::HierSample sample = test::small_hier();
  sample.boxes[1].min.x = -5;
  sample.boxes[2].size = 9;
  const KeptTree kept = read(test::hier_bytes(sample));
  EXPECT_EQ(kept.grown, 1u);
  EXPECT_EQ(kept.scene.tree.records[0].box_min.x, -5);
  EXPECT_EQ(kept.scene.tree.records[0].extent, 9);
  EXPECT_TRUE(validate(kept.scene).empty());
}

// A scale of 0 has no logarithm, and a rotation of no length no direction.
TEST(KeptTree, RepairsAreCounted) {
  test::HierSample sample = test::small_hier();
  sample.log_scales[3] = -INFINITY;
  for (size_t k = 0; k < 4; ++k) sample.rotations[k] = 0;
  sample.opacities[1] = -0.5f;
  const KeptTree kept = read(test::hier_bytes(sample));
  EXPECT_EQ(kept.scene.leaves.report.repaired_scale, 1u);
  EXPECT_EQ(kept.scene.leaves.report.repaired_rotation, 1u);
  EXPECT_EQ(kept.scene.leaves.opacity[0], 0.5f);
}

TEST(KeptTree, LeavesAreAFlatSceneInAnyBlocks) {
  const Bytes bytes = test::hier_bytes(test::merged_hier());
  const BakedScene scene = read(bytes).scene;
  for (const size_t most : {size_t{1}, size_t{2}, size_t{100}}) {
    const auto reader = open_blocks(named(bytes, "flat.HIER"));
    ASSERT_EQ(reader->count(), scene.leaves.size());
    size_t at = 0;
    for (RawBlock block = reader->next(most); block.count > 0; block = reader->next(most)) {
      const GaussianCloud part = reader->decode(block);
      for (size_t i = 0; i < part.size(); ++i, ++at) {
        EXPECT_EQ(part.opacity[i], flat_logit(scene.leaves.opacity[at]));
        EXPECT_EQ(part.position[3 * i], scene.leaves.position[3 * at]);
        EXPECT_EQ(part.sh[kHierShFloats * i + 47], scene.leaves.sh[kHierShFloats * at + 47]);
      }
    }
    EXPECT_EQ(at, scene.leaves.size());
  }
}

TEST(KeptTree, AnEmptyFileIsAnEmptyTree) {
  const Bytes bytes(8);
  EXPECT_EQ(read(bytes).scene.tree.size(), 0u);
  EXPECT_EQ(import_gaussians(named(bytes)).size(), 0u);
}

// What the message says, or nothing where the file is read.
std::string refusal(const Bytes& bytes) {
  try {
    const KeptTree kept = read(bytes);
    EXPECT_TRUE(validate(kept.scene).empty()) << validate(kept.scene).front();
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
    return error.what();
  }
}

void expect_refused(const std::function<void(test::HierSample&)>& change, const std::string& part) {
  test::HierSample sample = test::merged_hier();
  change(sample);
  for (const bool half : {false, true})
    EXPECT_NE(refusal(test::hier_bytes(sample, half)).find(part), std::string::npos)
        << part << ": " << refusal(test::hier_bytes(sample, half));
}

TEST(KeptTree, RefusesLinksThatAreNoTree) {
  using Sample = test::HierSample;
  expect_refused([](Sample& s) { s.nodes[0].parent = 0; }, "node 0, parent");
  expect_refused([](Sample& s) { s.nodes[3].parent = 2; }, "node 3, parent");
  expect_refused([](Sample& s) { s.nodes[4] = {1, 1, 6, 0, 1, 1, 1}; },
                 "a second node");  // a cycle
  expect_refused([](Sample& s) { s.nodes[1].start_children = 2; }, "a second node");
  expect_refused([](Sample& s) { s.nodes[1].start_children = 0; }, "node 1, children");
  expect_refused([](Sample& s) { s.nodes[2].count_children = 4; }, "node 2, children");
  expect_refused([](Sample& s) { s.nodes[2].count_children = -1; }, "node 2, children");
  expect_refused([](Sample& s) { s.nodes[2].start_children = 1 << 30; }, "node 2, children");
  expect_refused([](Sample& s) { s.nodes[2].count_children = 2; }, "no node that has it");
  expect_refused([](Sample& s) { s.nodes[2].depth = -1; }, "node 2, depth");
  expect_refused(
      [](Sample& s) {
        s.nodes[2].depth = 0, s.nodes[2].count_leafs = 1, s.nodes[2].count_merged = 0;
      },
      "node 2, depth");
}

TEST(KeptTree, RefusesGaussiansThatNodesCannotHave) {
  using Sample = test::HierSample;
  expect_refused([](Sample& s) { s.nodes[5].count_leafs = 2; }, "node 5, Gaussians");
  expect_refused([](Sample& s) { s.nodes[5].count_leafs = 0; }, "node 5, Gaussians");
  expect_refused([](Sample& s) { s.nodes[1].count_merged = 0; }, "node 1, Gaussians");
  expect_refused([](Sample& s) { s.nodes[1].count_leafs = 1; }, "node 1, Gaussians");
  expect_refused([](Sample& s) { s.nodes[1].start = -1; }, "node 1, start");
  expect_refused([](Sample& s) { s.nodes[1].start = 11; }, "node 1, start");
  expect_refused([](Sample& s) { s.nodes[1].start = 7; }, "another node has");
  // Nor further ones: every node could claim all of the file's.
  expect_refused([](Sample& s) { s.nodes[0].count_merged = 3; }, "node 1, Gaussians");
  expect_refused([](Sample& s) { s.nodes[1].count_merged = 12; }, "node 1, start");
  expect_refused([](Sample& s) { s.positions[6] = NAN; }, "Gaussian 2, position");
  expect_refused([](Sample& s) { s.positions[6] = 1e18f; }, "Gaussian 2, position");
  for (const float bad : {NAN, INFINITY}) {
    const auto with = [&](auto change) {
      Sample sample = test::merged_hier();
      change(sample);
      return refusal(test::hier_bytes(sample));
    };
    EXPECT_NE(with([&](Sample& s) { s.opacities[2] = bad; }).find("Gaussian 2, opacity"),
              std::string::npos);
    EXPECT_NE(with([&](Sample& s) { s.log_scales[6] = bad; }).find("Gaussian 2, log scale"),
              std::string::npos);
    EXPECT_NE(with([&](Sample& s) { s.boxes[2].max.y = bad; }).find("node 2, box"),
              std::string::npos);
  }
  expect_refused([](Sample& s) { s.boxes[2].min.y = 15; }, "node 2, box");
  expect_refused([](Sample& s) { s.boxes[2].size = -1; }, "node 2, extent");
}

// A claim costs nothing: the length of the file is looked at before anything else.
TEST(KeptTree, RefusesEveryTruncationAndLongerFile) {
  for (const bool half : {false, true}) {
    const Bytes whole = test::hier_bytes(test::small_hier(), half);
    for (size_t size = 0; size < whole.size(); ++size)
      EXPECT_NE(refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
                "");
    Bytes longer = whole;
    longer.push_back(std::byte{0});
    EXPECT_NE(refusal(longer), "");
    for (const int32_t count : {INT32_MAX, INT32_MIN, -1}) {
      Bytes claim = whole;
      std::memcpy(claim.data(), &count, sizeof count);
      EXPECT_NE(refusal(claim), "");
    }
  }
}

TEST(KeptTree, AFlippedByteGivesASoundTreeOrARefusal) {
  for (const bool half : {false, true}) {
    Bytes bytes = test::hier_bytes(test::small_hier(), half);
    for (std::byte& b : bytes)
      for (const std::byte flip : {std::byte{0x01}, std::byte{0x80}, std::byte{0xff}}) {
        b ^= flip;
        refusal(bytes);
        b ^= flip;
      }
  }
}

}  // namespace
}  // namespace voyager::kept_tree_test
