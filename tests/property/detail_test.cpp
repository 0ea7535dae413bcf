// Detail chosen as CityGaussian and Octree-GS choose it: cuts of the same tree, found by every
// search.
#include "runtime/select/detail.h"

#include <tbb/task_scheduler_observer.h>

#include <atomic>
#include <cmath>

#include "runtime/frame/draw_list.h"
#include "tests/support/is_cut.h"
#include "tests/support/render_scene.h"
#include "tests/support/rounded_tree.h"
#include "tests/support/search_rig.h"
#include "tests/support/stream_rig.h"
#include "tests/support/tree_clouds.h"

namespace voyager::detail_test {
namespace {

using test::SearchRig;
using test::TreeShape;

constexpr Lod kBaselines[] = {Lod::blocks, Lod::levels};

struct Baseline {
  Baseline(const LodTree& tree, Lod lod)
      : partition(partition_tree(tree, kDefaultChunkBytes)),
        detail(make_detail_tree(tree, partition, lod, workers, std::pmr::get_default_resource())) {}

  std::vector<uint32_t> cut(const CutQuery& query) {
    search.run(detail.tree, {}, query, workers);
    return {search.cut().begin(), search.cut().end()};
  }

  Workers workers{2};
  Partition partition;
  DetailTree detail;
  ExhaustiveSearch search;
};

// In and about the tree, at every granularity.
std::vector<CutQuery> queries(uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<CutQuery> found;
  for (const float target : {1e-4f, 0.01f, 0.05f, 0.3f, 2.0f})
    for (int i = 0; i < 8; ++i) {
      CutQuery query{{0, 0, 0}, target};
      for (int axis = 0; axis < 3; ++axis) query.centre[axis] = 300 * test::unit(random) - 150;
      found.push_back(query);
    }
  return found;
}

// Whether each node of `finer` is in `cut` or hangs from a node of it.
bool is_below(const LodTree& tree, const std::vector<uint32_t>& finer,
              const std::vector<uint32_t>& cut) {
  return std::all_of(finer.begin(), finer.end(), [&](uint32_t node) {
    for (; node != kNoNode; node = tree.parent[node])
      if (std::binary_search(cut.begin(), cut.end(), node)) return true;
    return false;
  });
}

TEST(Detail, BaselinesAreCutsAndLevelsNowhereCoarser) {
  for (const TreeShape shape : test::kTreeShapes)
    for (const uint32_t nodes : {1u, 70u, 4000u}) {
      SCOPED_TRACE(test::name_of(shape) + " " + std::to_string(nodes));
      const LodTree tree = test::random_tree(shape, nodes, 3);
      Workers workers(2);
      ExhaustiveSearch own;
      for (const Lod lod : kBaselines) {
        Baseline baseline(tree, lod);
        for (const CutQuery& query : queries(nodes)) {
          own.run(tree, {}, query, workers);
          const std::vector<uint32_t> cut = baseline.cut(query);
          ASSERT_TRUE(test::is_cut(tree, cut));
          if (lod == Lod::levels) {
            ASSERT_TRUE(is_below(tree, cut, {own.cut().begin(), own.cut().end()}));
          }
        }
      }
    }
}

TEST(Detail, EverySearchFindsThem) {
  for (const TreeShape shape : test::kTreeShapes)
    for (const Lod lod : kBaselines) {
      const LodTree tree = test::random_tree(shape, 5000, 4);
      SearchRig rig(Baseline(tree, lod).detail.tree);
      for (const CutQuery& query : queries(5)) ASSERT_TRUE(rig.agree(query));
    }
}

TEST(Detail, ABlockIsDrawnAtOneDepth) {
  const LodTree tree = test::random_tree(TreeShape::binary, 4095, 6);
  Baseline baseline(tree, Lod::blocks);
  const auto& begin = baseline.partition.level_begin;
  ASSERT_EQ(begin[7] - begin[6], kBlocks) << "what hangs from the seventh level are the blocks";
  const auto depth_of = [&](uint32_t node) {
    return std::upper_bound(begin.begin(), begin.end(), node) - begin.begin() - 1;
  };
  size_t depths_seen = 0;
  for (const CutQuery& query : queries(7)) {
    std::vector<std::ptrdiff_t> depth(kBlocks, -1);
    for (const uint32_t node : baseline.cut(query)) {
      ASSERT_GE(depth_of(node), 6) << "no node is coarser than a block";
      uint32_t root = node;
      while (root >= begin[7]) root = tree.parent[root];
      std::ptrdiff_t& of_block = depth[root - begin[6]];
      if (of_block < 0) of_block = depth_of(node);
      ASSERT_EQ(depth_of(node), of_block);
    }
    std::sort(depth.begin(), depth.end());
    depths_seen += static_cast<size_t>(std::unique(depth.begin(), depth.end()) - depth.begin());
  }
  EXPECT_GT(depths_seen, queries(7).size()) << "blocks differ";
}

// By the definition, in double: the extent's level is that of the distance, or above.
TEST(Detail, LevelsAreLogarithmsToBaseTwo) {
  const LodTree tree = test::rounded(test::random_tree(TreeShape::mixture, 4000, 8));
  Baseline baseline(tree, Lod::levels);
  for (const CutQuery& query : queries(9)) {
    const std::vector<uint32_t> cut = baseline.cut(query);
    std::vector<uint8_t> refined(tree.size());
    for (uint32_t node : cut)
      while ((node = tree.parent[node]) != kNoNode) refined[node] = 1;
    for (uint32_t n = 0; n < tree.size(); ++n) {
      const NodeRecord& r = tree.records[n];
      const uint32_t parent = tree.parent[n];
      if (r.child_count == 0 || (parent != kNoNode && refined[parent] == 0)) continue;
      const double distance =
          std::sqrt(double{squared_distance(query.centre, r.box_min, r.box_max)});
      const double level = std::ceil(std::log2(double{r.extent}));
      const double asked = std::log2(double{query.target_size} * distance);
      if (std::abs(level - asked) < 1e-6) continue;  // rounding decides
      ASSERT_EQ(refined[n] != 0, level > asked) << n;
    }
  }
}

TEST(Detail, BaselinesDrawNodesAsTheyAre) {
  const auto scene = test::baked_scene(test::random_cloud(5000, 1, 0));
  Workers workers(2);
  for (const Lod lod : kBaselines)
    for (const Search search : {Search::exhaustive, Search::temporal}) {
      DrawList draws(scene, lod, search, std::pmr::get_default_resource(), workers);
      draws.update({{0, 0, -20}, 0.05f}, workers);
      std::pmr::vector<uint32_t> cut;
      draws.read_cut(cut);
      ASSERT_EQ(draws.items().size(), cut.size());
      ASSERT_GT(cut.size(), 10u);
      for (size_t i = 0; i < cut.size(); ++i) {
        ASSERT_EQ(draws.items()[i].gaussian, cut[i]);
        ASSERT_EQ(draws.items()[i].t, 1.0f);
      }
    }
}

// How often a thread took up work of these workers.
class Entries final : public tbb::task_scheduler_observer {
 public:
  explicit Entries(Workers& workers) {
    workers.run([this] { observe(true); });
  }
  ~Entries() override { observe(false); }
  void on_scheduler_entry(bool) override { ++count_; }
  int count() const { return count_; }

 private:
  std::atomic<int> count_{0};
};

// A device's limit of threads binds what its views do, this as all else.
TEST(Detail, ABaselinesTreeIsMadeByTheViewsWorkers) {
  const auto scene = test::baked_scene(test::specks(20000, 4, 0));
  for (const Lod lod : kBaselines) {
    Workers workers(1);
    const Entries entries(workers);
    const int before = entries.count();
    const DrawList draws(scene, lod, Search::temporal, std::pmr::get_default_resource(), workers);
    EXPECT_GT(entries.count(), before);
  }
}

TEST(Detail, AStreamedSceneHasNoBaselines) {
  test::StreamRig rig(test::bake(test::random_cloud(2000, 3, 1)), 1.0);
  for (const Lod lod : {Lod::all_leaves, Lod::blocks, Lod::levels}) try {
      View(rig.streamed, *rig.backend, {.lod = lod}, rig.memory(), rig.workers);
      ADD_FAILURE() << "drew what is not there";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::unsupported);
    }
}

}  // namespace
}  // namespace voyager::detail_test
