// Each invariant is broken in turn; the validator must name the node and say so.
#include "runtime/lod/validate.h"

#include <algorithm>

#include "runtime/lod/build.h"
#include "tests/support/test_support.h"
#include "tests/support/tree_rules.h"

namespace voyager::validate_test {
namespace {

BakedScene sound(const TreeRule& rule) {
  Workers workers(1);
  return build_tree(test::random_cloud(300, 1), workers, {}, rule);
}

uint32_t first_leaf(const LodTree& tree) {
  uint32_t n = 0;
  while (!tree.is_leaf(n)) ++n;
  return n;
}

template <class Edit>
void expect_caught(const TreeRule& rule, const std::string& says, const Edit& edit) {
  BakedScene baked = sound(rule);
  ASSERT_TRUE(validate(baked).empty());
  edit(baked);
  const std::vector<std::string> messages = validate(baked);
  ASSERT_FALSE(messages.empty()) << "nothing found: " << says;
  bool named = false;
  for (const std::string& message : messages) {
    named |= message.find(says) != std::string::npos;
    EXPECT_NE(message.find(": found "), std::string::npos) << message;
    EXPECT_NE(message.find(", expected "), std::string::npos) << message;
  }
  EXPECT_TRUE(named) << says << "\nfirst message: " << messages[0];
}

// In trees of every rule.
template <class Edit>
void expect_caught(const std::string& says, const Edit& edit) {
  for (const test::NamedRule& named : test::all_rules()) {
    SCOPED_TRACE(named.name);
    expect_caught(named.rule, says, edit);
  }
}

TEST(Validate, ATreeWhoseLinksDisagreeIsCaught) {
  expect_caught("node 3, parent", [](BakedScene& b) { b.tree.parent[3] = 2; });
  expect_caught("node 3, parent", [](BakedScene& b) { b.tree.parent[3] = kNoNode; });
  expect_caught("node 0, parent", [](BakedScene& b) { b.tree.parent[0] = 0; });
  expect_caught("node 1, first child", [](BakedScene& b) { b.tree.first_child[1] += 1; });
  expect_caught("node 1, first child",
                [](BakedScene& b) { b.tree.first_child[1] = 4'000'000'000; });
  expect_caught("child count", [](BakedScene& b) { b.tree.records[2].child_count = 0xffffffff; });
  expect_caught("node 1, first child", [](BakedScene& b) { b.tree.records[0].child_count -= 1; });
  expect_caught("no earlier node", [](BakedScene& b) { b.tree.records[0].child_count = 0; });
  expect_caught("parents", [](BakedScene& b) { b.tree.parent.pop_back(); });
  expect_caught("first children", [](BakedScene& b) { b.tree.first_child.clear(); });
}

TEST(Validate, ARecordOutOfItsRangeIsCaught) {
  expect_caught("node 5, box", [](BakedScene& b) { b.tree.records[5].box_min.y = NAN; });
  expect_caught("node 0, box", [](BakedScene& b) { b.tree.records[0].box_max.x = INFINITY; });
  expect_caught("node 0, box", [](BakedScene& b) { b.tree.records[0].box_min.z = -1e18f; });
  expect_caught("node 9, box", [](BakedScene& b) {
    std::swap(b.tree.records[9].box_min, b.tree.records[9].box_max);
  });
  expect_caught("node 2, box", [](BakedScene& b) {
    b.tree.records[2].box_max.x = std::nextafter(b.tree.records[0].box_max.x, 1e9f);
  });
  expect_caught("node 4, extent", [](BakedScene& b) { b.tree.records[4].extent = -1.0f; });
  expect_caught("node 4, extent", [](BakedScene& b) { b.tree.records[4].extent = NAN; });
  expect_caught("node 4, extent", [](BakedScene& b) { b.tree.records[4].extent = INFINITY; });
  expect_caught("node 4, extent", [](BakedScene& b) {
    b.tree.records[4].extent = std::nextafter(b.tree.records[0].extent, 1e9f);
  });
}

TEST(Validate, ALeafThatIsNotItsGaussiansIsCaught) {
  expect_caught("box of a leaf", [](BakedScene& b) {
    NodeRecord& r = b.tree.records[first_leaf(b.tree)];
    r.box_max.x = std::nextafter(r.box_max.x, -1e9f);
  });
  expect_caught("Gaussian of a leaf", [](BakedScene& b) {
    const uint32_t n = first_leaf(b.tree);
    b.gaussian[n] = b.gaussian[n + 1];
  });
  expect_caught("Gaussian of a leaf", [](BakedScene& b) { b.gaussian[first_leaf(b.tree)] = 300; });
  expect_caught("merged Gaussian", [](BakedScene& b) { b.gaussian[0] = 1; });
  expect_caught("Gaussian indices", [](BakedScene& b) { b.gaussian.pop_back(); });
  expect_caught("node codes", [](BakedScene& b) { b.node_code.clear(); });
  expect_caught("leaves, position", [](BakedScene& b) { b.leaves.position.pop_back(); });
  expect_caught("merged, SH", [](BakedScene& b) { b.merged.sh.pop_back(); });
  expect_caught("SH degree", [](BakedScene& b) { b.merged.sh_degree = 2; });
  expect_caught("SH degree", [](BakedScene& b) { b.leaves.sh_degree = -7; });
}

TEST(Validate, AMergedGaussianThatIsNotItsChildrensMomentsIsCaught) {
  // Words off by more than their tolerance: node 0 draws merged Gaussian 0.
  expect_caught("node 0, mean", [](BakedScene& b) { b.merged.position[0] += 1e-3f; });
  expect_caught("node 0, covariance", [](BakedScene& b) { b.merged.log_scale[1] += 1e-3f; });
  expect_caught("node 0, covariance", [](BakedScene& b) { b.merged.rotation[2] += 1e-2f; });
  expect_caught(test::kHierarchicalGs, "node 0, opacity times surface",
                [](BakedScene& b) { b.merged.opacity[0] *= 1.001f; });
  expect_caught("node 0, SH", [](BakedScene& b) { b.merged.sh[4] += 1e-3f; });
  expect_caught("node 0, mean", [](BakedScene& b) { b.merged.position[2] = NAN; });
  for (const float opacity : {INFINITY, NAN, -0.1f})
    expect_caught("node 0, opacity", [&](BakedScene& b) { b.merged.opacity[0] = opacity; });
}

TEST(Validate, ANodeCodeThatIsNotItsParentsIsCaught) {
  expect_caught("footprint level",
                [](BakedScene& b) { b.node_code[first_leaf(b.tree)] += kAxisCodes; });
  expect_caught("node 0, footprint level", [](BakedScene& b) {
    b.leaves.native.levels = 2;
    b.node_code[0] = kAxisCodes;
  });
  expect_caught("node 0, axis code", [](BakedScene& b) { b.node_code[0] = 1; });
  expect_caught("axis code", [](BakedScene& b) {
    uint8_t& code = b.node_code[first_leaf(b.tree)];
    code = static_cast<uint8_t>((code + 5) % 24);
  });
}

TEST(Validate, AnyExtentThatNeverGrowsDownwardsIsSound) {
  BakedScene baked = sound({});
  for (NodeRecord& r : baked.tree.records) r.extent = 7.0f;
  EXPECT_TRUE(validate(baked).empty());
  baked.tree.records[0].extent = INFINITY;
  EXPECT_TRUE(validate(baked).empty());
}

TEST(Validate, StopsAtTheLimit) {
  BakedScene baked = sound({});
  for (NodeRecord& r : baked.tree.records) r.extent = -1.0f;
  EXPECT_EQ(validate(baked, 5).size(), 5u);
  EXPECT_EQ(validate(baked.tree, 1).size(), 1u);
}

TEST(Validate, SurvivesNoise) {
  std::mt19937 random(4);
  for (int repeat = 0; repeat < 300; ++repeat) {
    LodTree tree;
    const size_t nodes = random() % 40;
    tree.records.resize(nodes);
    tree.first_child.resize(nodes);
    tree.parent.resize(nodes);
    for (size_t n = 0; n < nodes; ++n) {
      tree.records[n].child_count = random() % 3 ? random() % 5 : random();
      tree.first_child[n] = random() % 2 ? random() % 40 : random();
      tree.parent[n] = random() % 2 ? random() % 40 : random();
    }
    EXPECT_LE(validate(tree).size(), 16u);
  }
}

}  // namespace
}  // namespace voyager::validate_test
