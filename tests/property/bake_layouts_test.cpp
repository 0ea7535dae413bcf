// A bake in parts gives the file of the whole tree for cells of any topology: every cell
// is laid out at random here, so that those of one size differ in shape and in depth.
#include <bit>

#include "runtime/bake/bake.h"
#include "runtime/bake/cell_sizes.h"
#include "runtime/lod/kd_order.h"
#include "runtime/lod/levels.h"
#include "tests/support/random_layouts.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_rules.h"

namespace voyager {
namespace {

class BakeLayouts : public ::testing::Test {
 protected:
  BakeInParts request(const GaussianCloud& cloud, Quality quality) {
    const test::Bytes ply = test::ply_bytes(cloud);
    std::ofstream(input, std::ios::binary)
        .write(reinterpret_cast<const char*>(ply.data()), static_cast<std::streamsize>(ply.size()));
    BakeInParts bake;
    bake.rule = test::kSmallBlocks;
    bake.request = bake_request({input}, quality, kDefaultChunkBytes, bake.rule);
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

}  // namespace
}  // namespace voyager
