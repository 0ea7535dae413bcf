// Extents from what refining is seen to gain: the gain is the picture's, to a rounding; the tree
// stays one; threads and stops do not show.
#include "runtime/refine/refine.h"

#include <cstring>
#include <filesystem>
#include <fstream>

#include "runtime/lod/stand_in.h"
#include "runtime/lod/validate.h"
#include "runtime/refine/gain.h"
#include "runtime/select/cut.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

namespace voyager::refine_test {
namespace {

double squared_error(const Picture& found, const Picture& expected) {
  double sum = 0;
  for (int tile = 0; tile < kTiles; ++tile)
    for (int i = 0; i < kTilePixels; ++i) {
      if (!pixel_centre(tile, i).inside()) continue;
      const Vec3f d = found.colours(tile)[i] - expected.colours(tile)[i];
      sum += double{dot(d, d)};
    }
  return sum;
}

std::vector<uint32_t> leaves_of(const LodTree& tree) {
  std::vector<uint32_t> leaves;
  for (uint32_t n = 0; n < tree.size(); ++n)
    if (tree.is_leaf(n)) leaves.push_back(n);
  return leaves;
}

// Against pictures in which the children are drawn.
TEST(Refine, AGainIsWhatThePictureGains) {
  Workers workers;
  const BakedScene baked = test::bake(test::specks(6000, 4, 1));
  const LodTree& tree = baked.tree;
  const NodeArrays arrays(baked, workers);
  size_t compared = 0;
  size_t off = 0;
  double most = 0;
  for (const uint32_t k : {0u, 1u, 2u, 3u, 4u, 5u}) {
    const Viewpoint view = Viewpoints(baked)(k);
    const ProjectParams params = picture_params(view, baked.leaves.native);
    const Picture leaves(params, arrays, leaves_of(tree), workers);
    ExhaustiveSearch search;
    search.run(tree, {}, {cut_centre(view.eye, {0, 0, 0}), 0.3f}, workers);
    const auto& nodes = search.cut();
    const Picture cut(params, arrays, nodes, workers);
    const double error = squared_error(cut, leaves);
    for (const NodeGain& gain : gains(params, arrays, tree, cut, leaves, workers)) {
      ASSERT_FALSE(tree.is_leaf(gain.node));
      ++compared;
      std::vector<uint32_t> refined;
      for (const uint32_t n : nodes) {
        if (n != gain.node) {
          refined.push_back(n);
          continue;
        }
        for (uint32_t i = 0; i < tree.records[n].child_count; ++i)
          refined.push_back(tree.first_child[n] + i);
      }
      const double expected = error - squared_error({params, arrays, refined, workers}, leaves);
      most = std::max(most, std::fabs(expected));
      off += std::fabs(gain.squares - expected) > 0.1 * std::fabs(expected) + 1e-3;
    }
  }
  EXPECT_GT(compared, 60u);
  EXPECT_GT(most, 1);
  // Children are put in their parent's place, not each in its own among all others.
  EXPECT_LE(off, compared / 50);
}

TEST(Refine, ExtentsStillNeverGrowDownwards) {
  Workers workers;
  const test::TempFolder folder;
  BakedScene baked = test::bake(test::random_cloud(2500, 5, 1));
  const LodTree before = baked.tree;
  refine_extents(baked, 8, folder.file("kept"), workers);
  EXPECT_TRUE(validate(baked).empty());
  const LodTree& tree = baked.tree;
  size_t grown = 0, shrunk = 0;
  for (uint32_t n = 0; n < tree.size(); ++n) {
    const NodeRecord &was = before.records[n], &is = tree.records[n];
    ASSERT_TRUE(was.box_min == is.box_min && was.box_max == is.box_max);
    ASSERT_EQ(was.child_count, is.child_count);
    grown += is.extent > was.extent, shrunk += is.extent < was.extent;
    const uint32_t parent = tree.parent[n];
    if (parent == kNoNode) continue;
    ASSERT_LE(is.extent, tree.records[parent].extent) << n;
    ASSERT_TRUE(is.child_count != 0 || is.extent == 0) << n;
  }
  EXPECT_GT(grown, 20u);
  EXPECT_GT(shrunk, 20u);
}

TEST(Refine, NeitherThreadsNorStopsShow) {
  const BakedScene baked = test::bake(test::random_cloud(1500, 6, 1));
  const test::TempFolder folder;
  const auto extents = [&](unsigned threads, std::initializer_list<uint32_t> views) {
    Workers workers(threads);
    const std::string kept = folder.file(std::to_string(threads) + std::to_string(views.size()));
    BakedScene refined;
    for (const uint32_t count : views) {
      refined = baked;
      refine_extents(refined, count, kept, workers);
    }
    std::vector<float> of;
    for (const NodeRecord& r : refined.tree.records) of.push_back(r.extent);
    return of;
  };
  const std::vector<float> expected = extents(1, {5});
  EXPECT_EQ(extents(4, {5}), expected);
  EXPECT_EQ(extents(2, {2, 3, 5}), expected);
}

TEST(Refine, WhatWasMeasuredOfAnotherSceneOrWasAlteredIsRefused) {
  Workers workers;
  const test::TempFolder folder;
  const std::string kept = folder.file("kept");
  BakedScene first = test::bake(test::random_cloud(500, 7, 0)), other = first;
  other.tree.records[0].extent *= 2;
  refine_extents(first, 1, kept, workers);
  try {
    refine_extents(other, 2, kept, workers);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::refused_input);
    EXPECT_EQ(std::string(error.what()),
              kept +
                  ": found what was measured of another scene, expected this one: remove it, "
                  "and what is measured starts anew");
  }
  BakedScene fewer = test::bake(test::random_cloud(500, 7, 0));
  refine_extents(fewer, 2, kept, workers);
  BakedScene again = test::bake(test::random_cloud(500, 7, 0));
  try {
    refine_extents(again, 1, kept, workers);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              kept + ": found 2 views, expected at most 1: ask for as many, or remove it");
  }
  std::fstream file(kept, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(100);
  file.put('\x5a');
  file.close();
  const auto refusal = [&] {
    try {
      refine_extents(again, 2, kept, workers);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal().find(kept + ": found checksum "), std::string::npos) << refusal();
  std::filesystem::resize_file(kept, 50);
  EXPECT_NE(refusal().find(kept + ": found 50 bytes, expected "), std::string::npos) << refusal();
  std::filesystem::resize_file(kept, 0);
  EXPECT_NE(refusal().find(kept + ": found 0 bytes, expected "), std::string::npos) << refusal();
}

// Scenes of nothing to merge, of one place, of colours beyond all bounds.
TEST(Refine, DegenerateScenesStayAsTheyAre) {
  Workers workers;
  const test::TempFolder folder;
  for (test::NamedCloud& named : test::degenerate_clouds()) {
    SCOPED_TRACE(named.name);
    BakedScene baked = test::bake(std::move(named.cloud));
    refine_extents(baked, 2, folder.file(named.name), workers);
    EXPECT_TRUE(validate(baked).empty());
    for (const NodeRecord& r : baked.tree.records) ASSERT_FALSE(std::isnan(r.extent));
  }
  for (const size_t count : {0, 1, 2}) {
    BakedScene baked = test::bake(test::random_cloud(count, 8, 0));
    refine_extents(baked, 2, folder.file(std::to_string(count)), workers);
    EXPECT_TRUE(validate(baked).empty());
  }
}

TEST(Refine, ViewpointsDoNotDependOnOneAnother) {
  const BakedScene baked = test::bake(test::random_cloud(2000, 9, 0));
  const Viewpoints all(baked), again(baked);
  for (const uint32_t k : {0u, 3u, 1000u}) {
    const Viewpoint view = all(k), alone = again(k);
    EXPECT_EQ(std::memcmp(&view, &alone, sizeof view), 0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(dot(view.world_to_view.row[i], view.world_to_view.row[j]), i == j, 1e-12);
  }
  EXPECT_FALSE(all(0).eye == all(1).eye);
}

}  // namespace
}  // namespace voyager::refine_test
