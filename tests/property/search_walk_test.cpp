// The searches that keep their cut, along walks that are made to catch them out.
#include "tests/support/search_rig.h"

namespace voyager::search_walk_test {
namespace {

using test::SearchRig;
using test::TreeShape;
using test::unit;

Vec3f random_direction(std::mt19937& random) {
  for (;;) {
    const Vec3f v{2 * unit(random) - 1, 2 * unit(random) - 1, 2 * unit(random) - 1};
    const float length = std::sqrt((v.x * v.x + v.y * v.y) + v.z * v.z);
    if (length > 0.1f) return (1 / length) * v;
  }
}

// Log-uniform.
float between(float least, float most, std::mt19937& random) {
  return least * std::pow(most / least, unit(random));
}

TEST(SearchWalk, StepsFromTenthsOfMicrometresToTenKilometres) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 8000, 1));
  std::mt19937 random(1);
  Vec3f c{20, 5, -10};
  for (int frame = 0; frame < 1500; ++frame) {
    c = c + between(1e-7f, 1e4f, random) * random_direction(random);
    if (frame % 20 == 0) c = 60.0f * random_direction(random);  // home again
    ASSERT_TRUE(rig.agree({c, 0.05f})) << frame;
  }
}

// Longer than the ring of references, so that each is forgotten and taken over again.
TEST(SearchWalk, ASlowWalkOutlastsTheReferences) {
  SearchRig rig(test::random_tree(TreeShape::mixture, 5000, 2));
  std::mt19937 random(2);
  Vec3f c{30, 10, 0};
  uint64_t tested = 0, all = 0;
  for (int frame = 0; frame < 2000; ++frame) {
    c = c + 0.005f * random_direction(random) + Vec3f{-0.01f, 0, 0.004f};
    ASSERT_TRUE(rig.agree({c, 0.05f})) << frame;
    if (frame == 0) continue;
    tested += rig.temporal.stats().nodes_tested;
    all += rig.oracle.nodes_tested();
  }
  EXPECT_LT(tested * 20, all);
}

TEST(SearchWalk, GranularitySweepsBackAndForth) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 8000, 3));
  const Vec3f c{12, -7, 31};
  for (const float step : {1.0001f, 1.01f, 1.3f}) {
    float target = 0.03f;
    for (int frame = 0; frame < 160; ++frame) {
      ASSERT_TRUE(rig.agree({c, target})) << frame;
      target = frame / 40 % 2 == 0 ? target * step : target / step;
    }
  }
}

// As a headset whose field of view changes, or a time budget, does.
TEST(SearchWalk, PlaceAndGranularityChangeALittleEveryFrame) {
  SearchRig rig(test::random_tree(TreeShape::four_way, 8000, 4));
  std::mt19937 random(4);
  Vec3f c{-40, 3, 8};
  float target = 0.05f;
  int streamed = 0;
  for (int frame = 0; frame < 800; ++frame) {
    c = c + 0.02f * random_direction(random);
    target *= 1 + 0.001f * (2 * unit(random) - 1);
    ASSERT_TRUE(rig.agree({c, target})) << frame;
    streamed += rig.temporal.stats().ran == Search::streaming;
  }
  EXPECT_LT(streamed, 10);
}

// Centres and τ* within some ulps of where a node's verdict changes: there the slack
// is all rounding.
void walk_on_edge(const LodTree& tree, uint32_t seed, float scale) {
  SearchRig rig(tree);
  std::mt19937 random(seed);
  for (int place = 0; place < 40; ++place) {
    const Vec3f edge = scale * 40.0f * random_direction(random);
    const float target = test::edge_target(tree, edge, random);
    for (int frame = 0; frame < 60; ++frame) {
      const float step = between(1e-8f, 1e-3f, random) * 40.0f * scale;
      const Vec3f c = edge + step * random_direction(random);
      float near = target;
      for (uint32_t ulps = random() % 8; ulps > 0; --ulps)
        near = std::nextafter(near, random() % 2 == 0 ? 1e30f : 0.0f);
      ASSERT_TRUE(rig.agree({c, near})) << place << ' ' << frame;
    }
  }
}

TEST(SearchWalk, OnTheEdgeOfEveryVerdict) {
  for (const TreeShape shape : {TreeShape::four_way, TreeShape::chain, TreeShape::uneven})
    for (const test::Extents extents : {test::Extents::longest_side, test::Extents::any})
      ASSERT_NO_FATAL_FAILURE(walk_on_edge(test::random_tree(shape, 300, 5, extents), 5, 1));
}

// Coordinates at the limits: squares near overflow, and squares that underflow.
TEST(SearchWalk, OnTheEdgeAtExtremeScales) {
  for (const float scale : {1e15f, 1e-18f, 1e-24f}) {
    const LodTree tree =
        test::moved(test::random_tree(TreeShape::four_way, 300, 6), scale, {0, 0, 0});
    ASSERT_NO_FATAL_FAILURE(walk_on_edge(tree, 6, scale)) << scale;
  }
}

// Sizes that overflow: at τ* = +inf a verdict changes where they do.
TEST(SearchWalk, UnboundedGranularityAndHugeExtents) {
  LodTree tree = test::random_tree(TreeShape::four_way, 300, 9);
  for (NodeRecord& r : tree.records) r.extent = std::min(r.extent * 1e37f, 3e38f);
  SearchRig rig(tree);
  std::mt19937 random(9);
  for (int frame = 0; frame < 3000; ++frame) {
    const NodeRecord& r = tree.records[static_cast<size_t>(frame) / 40];
    Vec3f c = 0.5f * (r.box_min + r.box_max);
    c.y = r.box_max.y + 1.5f * unit(random);
    ASSERT_TRUE(rig.agree({c, frame % 20 < 18 ? test::kInfinity : 3e38f})) << frame;
  }
}

TEST(SearchWalk, FarFromTheOrigin) {
  SearchRig rig(
      test::moved(test::random_tree(TreeShape::four_way, 3000, 7), 1000.0f, {6.4e6f, -3e6f, 1e5f}));
  std::mt19937 random(7);
  Vec3f c{6.41e6f, -3e6f, 1e5f};
  for (int frame = 0; frame < 300; ++frame) {
    c = c + between(0.1f, 1000.0f, random) * random_direction(random);
    ASSERT_TRUE(rig.agree({c, 0.05f})) << frame;
  }
}

// In and out through the faces of boxes, by single ulps and by nothing at all.
TEST(SearchWalk, ThroughTheFacesOfBoxes) {
  const LodTree tree = test::random_tree(TreeShape::four_way, 1000, 8);
  SearchRig rig(tree);
  std::mt19937 random(8);
  for (int visit = 0; visit < 60; ++visit) {
    const NodeRecord& r = tree.records[random() % tree.size()];
    Vec3f c = 0.5f * (r.box_min + r.box_max);
    const int axis = static_cast<int>(random() % 3);
    c[axis] = r.box_max[axis];
    for (int frame = 0; frame < 20; ++frame) {
      const uint32_t move = random() % 4;
      if (move != 0) c[axis] = std::nextafter(c[axis], move == 1 ? -1e30f : 1e30f);
      ASSERT_TRUE(rig.agree({c, frame % 2 == 0 ? 1e20f : 0.1f})) << visit << ' ' << frame;
    }
  }
}

}  // namespace
}  // namespace voyager::search_walk_test
