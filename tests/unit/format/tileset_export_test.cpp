// A tree as a tileset, read back as a client and as our own reader would.
#include "runtime/format/export_tileset.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "runtime/format/export_flat.h"
#include "runtime/format/tile_plan.h"
#include "runtime/math/affine.h"
#include "tests/support/import_file.h"
#include "tests/support/scene_files.h"

namespace voyager::tileset_export_test {
namespace {

using Json = nlohmann::json;

constexpr uint64_t kTileBytes = 200 * 92;  // 200 Gaussians of SH degree 1

struct Written {
  Written(const GaussianCloud& cloud, TilesetOptions options = {})
      : voy(test::scene_bytes(test::bake(cloud), Quality::lossless)) {
    if (options.tile_bytes == TilesetOptions().tile_bytes) options.tile_bytes = kTileBytes;
    const SceneFile scene(test::source_of(voy));
    summary = export_tileset(
        scene, [&](const std::string& name) { return folder.file(name); }, options);
    std::ifstream(folder.file("tileset.json")) >> json;
  }

  GaussianCloud leaves() const { return read_leaves(SceneFile(test::source_of(voy))); }
  GaussianCloud tile(const Json& tile) const {
    return test::import_file(folder.file(tile["content"]["uri"].get<std::string>()));
  }

  test::TempFolder folder;
  test::Bytes voy;
  TilesetSummary summary;
  Json json;
};

struct Box {
  explicit Box(const Json& volume) {
    const Json& box = volume["box"];
    for (size_t axis = 0; axis < 3; ++axis) {
      const double centre = box[axis], half = box[3 + 4 * axis];
      least[static_cast<int>(axis)] = centre - half;
      most[static_cast<int>(axis)] = centre + half;
      for (size_t k = 0; k < 3; ++k) {
        if (k != axis) {
          EXPECT_EQ(box[3 + 3 * axis + k], 0);
        }
      }
    }
  }
  bool holds(const Vec3d& at) const {
    for (int axis = 0; axis < 3; ++axis)
      if (at[axis] < least[axis] || at[axis] > most[axis]) return false;
    return true;
  }
  bool holds(const Box& other) const { return holds(other.least) && holds(other.most); }
  double distance(const Vec3d& from) const {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = from[axis] - std::clamp(from[axis], least[axis], most[axis]);
      squared += d * d;
    }
    return std::sqrt(squared);
  }
  Vec3d least, most;
};

// z up, of INRIA's axes.
Vec3d to_tiles(const Vec3d& v) {
  return {-v.x, -v.z, -v.y};
}

template <class Visit>
void for_each_tile(const Json& tile, const Json* parent, const Visit& visit) {
  visit(tile, parent);
  if (tile.contains("children"))
    for (const Json& child : tile["children"]) for_each_tile(child, &tile, visit);
}

TEST(TilesetExport, TilesHoldWhatTheyShow) {
  const Written tileset(test::random_cloud(3000, 51, 1));
  EXPECT_EQ(tileset.json["root"]["refine"], "REPLACE");
  uint64_t tiles = 0, gaussians = 0;
  for_each_tile(tileset.json["root"], nullptr, [&](const Json& tile, const Json* parent) {
    ++tiles;
    const Box volume(tile["boundingVolume"]), own(tile["content"]["boundingVolume"]);
    EXPECT_TRUE(volume.holds(own));
    if (parent) {
      EXPECT_TRUE(Box((*parent)["boundingVolume"]).holds(volume));
      EXPECT_LT(tile["geometricError"], (*parent)["geometricError"]);
    }
    EXPECT_EQ(tile["geometricError"] == 0, !tile.contains("children"));
    const GaussianCloud cloud = tileset.tile(tile);
    gaussians += cloud.size();
    EXPECT_LE(cloud.size(), 200u);
    for (size_t i = 0; i < cloud.size(); ++i) {
      const Gaussian g = activate(cloud.words(i), true);
      if (g.opacity <= 1.0f / 255) continue;
      const Mat3d turn = rotation(Quatd{g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z});
      // The ends of the longest axes that alpha reaches 1/255 on.
      const double reach = (1 - 1e-5) * std::sqrt(2 * std::log(255.0 * double{g.opacity}));
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-reach, reach}) {
          Vec3d at{g.mean.x, g.mean.y, g.mean.z};
          for (int k = 0; k < 3; ++k) at[k] += side * double{g.scale[axis]} * turn.row[k][axis];
          EXPECT_TRUE(own.holds(to_tiles(at)));
        }
    }
  });
  EXPECT_EQ(tiles, tileset.summary.tiles);
  EXPECT_EQ(gaussians, tileset.summary.gaussians);
  EXPECT_GT(tiles, 20u);
  EXPECT_LT(gaussians, 2u * 3000);
  EXPECT_GT(tileset.json["geometricError"], tileset.json["root"]["geometricError"]);
}

// Of a cloud, in an order that does not depend on the file's.
std::vector<size_t> by_place(const GaussianCloud& cloud) {
  std::vector<size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::lexicographical_compare(&cloud.position[3 * a], &cloud.position[3 * a] + 3,
                                        &cloud.position[3 * b], &cloud.position[3 * b] + 3);
  });
  return order;
}

// A Gaussian is the same with an axis the other way round.
void expect_same_axes(const Quatf& a, const Quatf& b) {
  const Mat3d p = transposed(rotation(normalise(Quatd{a.w, a.x, a.y, a.z})));
  const Mat3d q = transposed(rotation(normalise(Quatd{b.w, b.x, b.y, b.z})));
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(std::fabs(dot(p.row[axis], q.row[axis])), 1, 1e-6);
}

void expect_leaves(const GaussianCloud& read, const GaussianCloud& leaves) {
  ASSERT_EQ(read.size(), leaves.size());
  ASSERT_EQ(read.sh_degree, leaves.sh_degree);
  const std::vector<size_t> a = by_place(read), b = by_place(leaves);
  const auto floats = static_cast<size_t>(3 * read.coefficients());
  for (size_t n = 0; n < a.size(); ++n) {
    const size_t i = a[n], j = b[n];
    expect_same_axes(read.words(i).rotation, leaves.words(j).rotation);
    EXPECT_NEAR(sigmoid(read.opacity[i]), sigmoid(leaves.opacity[j]), 1e-6);
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(read.origin[k] + double{read.position[3 * i + k]},
                leaves.origin[k] + double{leaves.position[3 * j + k]});
      EXPECT_NEAR(read.log_scale[3 * i + k], leaves.log_scale[3 * j + k], 1e-5);
    }
    for (size_t k = 0; k < floats; ++k)
      EXPECT_EQ(read.sh[floats * i + k], leaves.sh[floats * j + k]);
  }
}

TEST(TilesetExport, OurReaderFindsTheLeaves) {
  for (const double origin : {0.0, 1024.0 * 5000}) {
    GaussianCloud cloud = test::random_cloud(1500, 52, 1);
    cloud.origin = {origin, -origin, origin};
    const Written tileset(cloud);
    EXPECT_EQ(tileset.json["root"].contains("transform"), origin != 0);
    expect_leaves(test::import_file(tileset.folder.file("tileset.json")), tileset.leaves());
  }
}

TEST(TilesetExport, CompressedTilesSayWhatClientsAskFor) {
  TilesetOptions options;
  options.flat.spz_inside = true;
  options.flat.spz_version = 3;
  options.tile_bytes = 10'000;
  const Written tileset(test::random_cloud(1500, 53, 1), options);
  const Json& content = tileset.json["extensions"]["3DTILES_content_gltf"];
  EXPECT_EQ(content["extensionsRequired"], content["extensionsUsed"]);
  EXPECT_EQ(content["extensionsRequired"].size(), 2u);
  EXPECT_EQ(test::import_file(tileset.folder.file("tileset.json")).size(), 1500u);
  for_each_tile(tileset.json["root"], nullptr, [&](const Json& tile, const Json*) {
    const Box own(tile["content"]["boundingVolume"]);
    const GaussianCloud cloud = tileset.tile(tile);
    for (size_t i = 0; i < cloud.size(); ++i)
      EXPECT_TRUE(own.holds(
          to_tiles({cloud.position[3 * i], cloud.position[3 * i + 1], cloud.position[3 * i + 2]})));
  });
  EXPECT_LT(tileset.summary.largest, 12'000u);
}

TEST(TilesetExport, ASmallSceneIsOneTile) {
  const Written tileset(test::random_cloud(100, 54, 1));
  EXPECT_EQ(tileset.summary.tiles, 1u);
  EXPECT_FALSE(tileset.json["root"].contains("children"));
  EXPECT_EQ(test::error_code([] { const Written none(test::random_cloud(0, 1, 0)); }),
            ErrorCode::unsupported);
}

TileTree tile_tree(const BakedScene& baked) {
  TileTree tree(baked.tree.size());
  for (size_t n = 0; n < tree.size(); ++n) {
    tree.extent[n] = baked.tree.records[n].extent;
    tree.child_count[n] = baked.tree.records[n].child_count;
  }
  EXPECT_TRUE(link_tiles(tree));
  return tree;
}

// What a client shows at 16 pixels of screen-space error is nowhere coarser than the cut of tau 3.
TEST(TilesetExport, AClientShowsNothingCoarserThanOurCut) {
  const GaussianCloud cloud = test::random_cloud(3000, 55, 1);
  const BakedScene baked = test::bake(cloud);
  const Written tileset(cloud);
  const TileTree tree = tile_tree(baked);
  const std::vector<Tile> plan = plan_tiles(tree, 200);
  ASSERT_EQ(plan.size(), tileset.summary.tiles);
  std::map<std::string, Json> by_name;
  for_each_tile(tileset.json["root"], nullptr,
                [&](const Json& tile, const Json*) { by_name[tile["content"]["uri"]] = tile; });
  constexpr double kFocal = 800, kScreenError = 16, kTau = 3;
  size_t refined = 0;
  for (const double far : {2.0, 20.0, 200.0, 2000.0}) {
    const Vec3d eye{far, 3, -far};
    std::vector<size_t> open{0};
    while (!open.empty()) {
      const size_t i = open.back();
      open.pop_back();
      char name[32];
      std::snprintf(name, sizeof name, "tile_%05zu.glb", i);
      const Json& tile = by_name.at(name);
      const double distance = Box(tile["boundingVolume"]).distance(to_tiles(eye));
      const double error = tile["geometricError"];
      if (error * kFocal > kScreenError * distance) {
        ++refined;
        open.insert(open.end(), plan[i].children.begin(), plan[i].children.end());
        continue;
      }
      for (const uint32_t n : nodes_of_tile(tree, plan[i])) {
        if (tree.child_count[n] == 0) continue;
        EXPECT_LE(double{tree.extent[n]} * kFocal, (2 * kTau + 1) * distance * (1 + 1e-9));
      }
    }
  }
  EXPECT_GT(refined, 5u);
}

// Every node but the last has a leaf and the rest as children.
TEST(TilePlan, ATreeOfOneSideIsCutInPartsOfAnEighth) {
  TileTree tree(2001);
  for (size_t n = 0; n < 2000; ++n) {
    tree.extent[n] = n % 2 == 0 ? static_cast<float>(2000 - n) : 0;
    tree.child_count[n] = n % 2 == 0 ? 2 : 0;
  }
  ASSERT_TRUE(link_tiles(tree));
  const std::vector<Tile> plan = plan_tiles(tree, 50);
  std::vector<uint32_t> leaves;
  for (const Tile& tile : plan) {
    const std::vector<uint32_t> nodes = nodes_of_tile(tree, tile);
    EXPECT_LE(nodes.size(), 50u);
    EXPECT_EQ(tile.children.empty(), tile.error == 0);
    if (tile.parent != kNoTile) {
      EXPECT_LT(tile.error, plan[tile.parent].error);
    }
    if (tile.children.empty()) leaves.insert(leaves.end(), nodes.begin(), nodes.end());
  }
  std::sort(leaves.begin(), leaves.end());
  EXPECT_EQ(leaves.size(), tree.leaves[0]);
  EXPECT_EQ(std::adjacent_find(leaves.begin(), leaves.end()), leaves.end());
}

TEST(TilePlan, EqualExtentsAndLargeFamiliesEndInLeaves) {
  TileTree tree(1 + 40 + 1600);
  tree.extent[0] = INFINITY;
  tree.child_count[0] = 40;
  for (size_t n = 1; n <= 40; ++n) tree.child_count[n] = 40;  // with extents of 0
  ASSERT_TRUE(link_tiles(tree));
  for (const uint64_t most : {uint64_t{1}, uint64_t{30}, uint64_t{100}}) {
    size_t leaves = 0;
    const std::vector<Tile> plan = plan_tiles(tree, most);
    for (const Tile& tile : plan) {
      EXPECT_TRUE(std::isfinite(tile.error));
      if (tile.parent != kNoTile) {
        EXPECT_LT(tile.error, plan[tile.parent].error);
      }
      EXPECT_LE(nodes_of_tile(tree, tile).size(), most);
      if (tile.children.empty()) leaves += nodes_of_tile(tree, tile).size();
    }
    EXPECT_EQ(leaves, 1600u);
  }
}

TEST(TilePlan, CountsThatAreNoTreeAreFound) {
  for (const std::vector<uint32_t>& counts :
       {std::vector<uint32_t>{2, 0}, {1, 0, 0}, {0, 0}, {4000000000u, 0}}) {
    TileTree tree(counts.size());
    tree.child_count = counts;
    EXPECT_FALSE(link_tiles(tree));
  }
}

}  // namespace
}  // namespace voyager::tileset_export_test
