// A bake in parts gives the file of the whole tree for cells of any topology: every cell
// is laid out at random here, so that those of one size differ in shape and in depth.
#include <bit>

#include "runtime/bake/bake.h"
#include "runtime/bake/cell_sizes.h"
#include "runtime/lod/kd_order.h"
#include "runtime/lod/levels.h"
#include "tests/support/random_layouts.h"
#include "tests/support/scene_files.h"

namespace voyager {
namespace {

// The same for the same cloud.
TreeLayout random_layout(const GaussianCloud& cloud, const std::array<double, 3>&, Workers&) {
  return test::random_cell(static_cast<uint32_t>(cloud.size()),
                           std::bit_cast<uint32_t>(cloud.position[0]));
}

GaussianCloud chosen(const GaussianCloud& cloud, std::span<const uint32_t> indices) {
  GaussianCloud some;
  for (const uint32_t i : indices)
    some.position.insert(some.position.end(), &cloud.position[3 * size_t{i}],
                         &cloud.position[3 * size_t{i}] + 3);
  some.opacity.resize(indices.size());
  return some;
}

// The layout of the whole tree whose cells are on a level. A cell has its Gaussians in
// the input's order.
TreeLayout whole_layout(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                        uint32_t level, Workers& workers) {
  std::vector<uint32_t> order = kd_order(cloud, origin, workers);
  std::vector<TreeLayout> cells;
  std::span<uint32_t> rest(order);
  for (const uint32_t size : cell_sizes(static_cast<uint32_t>(cloud.size()), level)) {
    const std::span<uint32_t> cell = rest.first(size);
    rest = rest.subspan(size);
    std::sort(cell.begin(), cell.end());
    cells.push_back(random_layout(chosen(cloud, cell), origin, workers));
    for (uint32_t& leaf : cells.back().leaf) leaf = cell[leaf];
  }
  return test::joined(cells);
}

test::Bytes in_memory(const GaussianCloud& cloud, uint32_t level, Quality quality) {
  Workers workers;
  BakedScene baked;
  baked.leaves = cloud;
  baked.leaves.report.read = cloud.size();
  baked.origin = scene_origin(cloud);
  const std::vector<uint32_t> levels =
      lay_out_scene(whole_layout(cloud, baked.origin, level, workers), baked);
  summarise_levels(levels, baked, workers);
  align_levels(levels, baked, workers);
  return test::scene_bytes(baked, quality);
}

class BakeLayouts : public ::testing::Test {
 protected:
  BakeInParts request(const GaussianCloud& cloud, Quality quality) {
    const test::Bytes ply = test::ply_bytes(cloud);
    std::ofstream(input, std::ios::binary)
        .write(reinterpret_cast<const char*>(ply.data()), static_cast<std::streamsize>(ply.size()));
    BakeInParts bake;
    bake.request = bake_request({input}, quality, kDefaultChunkBytes);
    bake.output = folder.file("parts.voy");
    bake.work = folder.file("work");
    bake.quality = quality;
    bake.memory = 100'000'000;
    bake.most_in_cell = 1300;
    return bake;
  }

  BakeSummary run(const BakeInParts& bake) {
    Workers workers;
    const OpenInputs open = [&] {
      std::vector<std::unique_ptr<BlockReader>> readers;
      readers.push_back(open_blocks(open_file_source(input)));
      return readers;
    };
    return bake_in_parts(bake, open, workers, {});
  }

  test::TempFolder folder;
  const std::string input = folder.file("input.ply");
};

TEST_F(BakeLayouts, GivesTheFileOfTheWholeTree) {
  for (const size_t count : {size_t{4160}, size_t{4 * 4160}, size_t{20011}}) {
    const GaussianCloud cloud = test::random_cloud(count, 31, 1);
    BakeInParts bake = request(cloud, Quality::lossless);
    bake.lay_out_cell = random_layout;
    const BakeSummary summary = run(bake);
    const uint32_t level = summary.cells == 4 ? 1 : 2;
    ASSERT_EQ(summary.cells, 1u << (2 * level));
    EXPECT_TRUE(test::file_bytes(bake.output) == in_memory(cloud, level, Quality::lossless));
  }
}

TEST_F(BakeLayouts, SaysWhatIsKnownAfterEachStep) {
  BakeInParts bake = request(test::random_cloud(6000, 32, 0), Quality::compact);
  for (const BakeStep step : {BakeStep::split, BakeStep::cells, BakeStep::encode}) {
    bake.step = step;
    const BakeSummary summary = run(bake);
    EXPECT_EQ(summary.gaussians, 6000u);
    EXPECT_EQ(summary.cells, 4u);
    const bool planned = step == BakeStep::encode;
    EXPECT_EQ(summary.nodes > 6000, planned);
    EXPECT_EQ(summary.subtrees > 0, planned);
    EXPECT_EQ(summary.chunks > 0, planned);
  }
}

TEST_F(BakeLayouts, ACellThatNoPlanTakesIsRefusedBeforeItIsMerged) {
  BakeInParts bake = request(test::random_cloud(6000, 33, 0), Quality::compact);
  bake.lay_out_cell = [](const GaussianCloud& cloud, const auto&, Workers&) {
    TreeLayout star;  // a root over nothing but leaves
    star.child_count.assign(cloud.size() + 1, 0);
    star.child_count[0] = 4;
    star.leaf.resize(cloud.size());
    return star;
  };
  EXPECT_EQ(test::error_code([&] { run(bake); }), ErrorCode::internal);
}

}  // namespace
}  // namespace voyager
