// The searches on the device against the exhaustive search on the host: the same node
// ids and the same weights, to the bit, whatever the camera does.
#include <array>
#include <cstdlib>
#include <cstring>
#include <map>

#include "cuda/search/cut_state.h"
#include "cuda/search/search.h"
#include "runtime/base/error.h"
#include "runtime/math/lerp.h"
#include "tests/gpu/device_test.h"
#include "tests/gpu/test_share.h"
#include "tests/support/random_trees.h"
#include "tests/support/render_scene.h"
#include "tests/support/rounded_tree.h"

namespace voyager::test {
namespace search_test {
namespace {

constexpr Search kSearches[] = {Search::exhaustive, Search::streaming, Search::temporal,
                                Search::temporal_visit, Search::sweep};
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::shared_ptr<Scene> scene_of(LodTree tree, uint32_t chunk_bytes = kDefaultChunkBytes) {
  Workers workers;
  auto scene = std::make_shared<Scene>(std::pmr::get_default_resource());
  scene->storage = Storage::lossless;
  scene->tree = rounded(std::move(tree));
  scene->leaf_count =
      static_cast<uint64_t>(std::count_if(scene->tree.records.begin(), scene->tree.records.end(),
                                          [](const NodeRecord& r) { return r.child_count == 0; }));
  scene->partition = partition_tree(scene->tree, chunk_bytes);
  scene->search = make_search_tree(scene->tree, scene->partition, {}, workers);
  return scene;
}

struct Result {
  std::vector<uint32_t> cut;
  std::vector<float> weights;
};

bool same(const Result& a, const Result& b) {
  return a.cut == b.cut && a.weights.size() == b.weights.size() &&
         (a.weights.empty() ||
          std::memcmp(a.weights.data(), b.weights.data(), a.weights.size() * sizeof(float)) == 0);
}

class Oracle {
 public:
  explicit Oracle(const Scene& scene) : scene_(scene) {}

  Result at(const CutQuery& query) {
    search_.run(scene_.tree, {}, query, workers_);
    Result result;
    result.cut.assign(search_.cut().begin(), search_.cut().end());
    for (const uint32_t n : result.cut) {
      const uint32_t p = scene_.tree.parent[n];
      result.weights.push_back(
          interpolation_weight(p != kNoNode, p == kNoNode ? 0.0f : search_.sizes()[p],
                               search_.sizes()[n], query.target_size, scene_.tree.blend_share));
    }
    return result;
  }

 private:
  const Scene& scene_;
  ExhaustiveSearch search_;
  Workers workers_;
};

class SearchTest : public DeviceTest {
 protected:
  static std::unique_ptr<SceneSearch> create(const std::shared_ptr<Scene>& scene, Search kind,
                                             unsigned multiprocessors = 0) {
    const auto on = device(multiprocessors);
    return cuda::create_timed_search(on, search_of(on, scene, kind), {kind, true});
  }

  // As the backend chooses: where leaves have an extent, temporal runs in place of a sweep.
  static std::unique_ptr<cuda::CutSearch> search_of(const std::shared_ptr<const cuda::Device>& on,
                                                    const std::shared_ptr<Scene>& scene,
                                                    Search kind) {
    if (kind == Search::exhaustive)
      return cuda::create_exhaustive_search(on, *scene, scene->tree, true);
    if (kind == Search::sweep && !scene->search.leaves_have_extent)
      return cuda::create_sweep_search(on, std::make_shared<cuda::SweepTree>(scene->tree), *scene,
                                       true);
    Workers workers(1);
    return cuda::create_partitioned_search(on, cuda::upload_tree(*scene), scene, kind, true,
                                           workers);
  }

  static Result run(SceneSearch& search, const CutQuery& query) {
    Result result;
    search.run(query);
    search.read(result.cut, result.weights);
    return result;
  }

  // Every search over the whole path, against the oracle.
  static void expect_equal(const std::shared_ptr<Scene>& scene, const std::vector<CutQuery>& path,
                           const std::string& name) {
    std::vector<std::unique_ptr<SceneSearch>> searches;
    for (const Search kind : kSearches) searches.push_back(create(scene, kind));
    Oracle oracle(*scene);
    for (size_t i = 0; i < path.size(); ++i) {
      const Result expected = oracle.at(path[i]);
      for (size_t k = 0; k < searches.size(); ++k) {
        const Result found = run(*searches[k], path[i]);
        ASSERT_EQ(found.cut.size(), expected.cut.size())
            << name << ", frame " << i << ", search " << k;
        ASSERT_TRUE(same(found, expected)) << name << ", frame " << i << ", search " << k;
      }
    }
  }
};

Vec3f anywhere(std::mt19937& random, float reach) {
  return {reach * (2 * unit(random) - 1), reach * (2 * unit(random) - 1),
          reach * (2 * unit(random) - 1)};
}

// Of the baselines of detail, through the backend.
TEST_F(SearchTest, BaselinesOfDetailAsOnTheHost) {
  const auto scene = baked_scene(random_cloud(share_of(20000), 35, 0));
  const auto on_device = create_backend(), host = create_cpu_backend();
  Workers workers;
  std::mt19937 random(36);
  for (const Lod lod : {Lod::blocks, Lod::levels})
    for (const Search kind : kSearches) {
      const SearchDesc desc{kind, true, lod};
      const auto memory = std::pmr::get_default_resource();
      const auto found = on_device->create_search(scene, desc, memory, workers);
      const auto expected = host->create_search(scene, desc, memory, workers);
      for (int i = 0; i < 20; ++i) {
        const CutQuery query{anywhere(random, 30), 0.02f + 0.1f * unit(random)};
        Result of_host;
        expected->run(query);
        expected->read(of_host.cut, of_host.weights);
        ASSERT_TRUE(same(run(*found, query), of_host));
        ASSERT_EQ(std::count(of_host.weights.begin(), of_host.weights.end(), 1.0f),
                  std::ssize(of_host.cut));
      }
    }
}

// Inside, on faces, an ulp beside them, far away; every kind of target size.
std::vector<CutQuery> jumps(const LodTree& tree, std::mt19937& random, int count) {
  std::vector<CutQuery> path;
  const float targets[] = {1e-30f, 1e-4f, 0.003f, 0.02f, 0.3f, 5.0f, kInfinity};
  for (int i = 0; i < share_of(count); ++i) {
    const NodeRecord& r = tree.records[random() % tree.size()];
    const Vec3f middle = 0.5f * (r.box_min + r.box_max);
    const Vec3f centres[] = {middle,
                             {r.box_min.x, middle.y, middle.z},
                             {middle.x, std::nextafter(r.box_max.y, 1e30f), middle.z},
                             anywhere(random, 150.0f),
                             anywhere(random, 1e4f),
                             anywhere(random, 1e17f)};
    const Vec3f c = centres[random() % 6];
    const float size = tree.screen_size(static_cast<uint32_t>(random() % tree.size()), c);
    const float target = random() % 3 == 0 && size > 0 ? size : targets[random() % 7];
    path.push_back({c, target});
  }
  return path;
}

// Steps of very different lengths, τ* changing a little in every frame.
std::vector<CutQuery> walk(std::mt19937& random, int count, float target) {
  std::vector<CutQuery> path;
  Vec3f c = anywhere(random, 60.0f);
  float step = 0.02f;
  for (int i = 0; i < share_of(count); ++i) {
    if (i % 40 == 0) step = std::pow(10.0f, -7.0f + 8.0f * unit(random));
    if (i % 97 == 96) c = anywhere(random, 100.0f);
    c = c + step * anywhere(random, 1.0f);
    path.push_back({c, target * (1.0f + 0.02f * unit(random))});
  }
  return path;
}

TEST_F(SearchTest, EqualTheHostsOnTreesOfEveryShapeAfterEveryJump) {
  std::mt19937 random(1);
  for (const TreeShape shape : kTreeShapes)
    for (const uint32_t nodes : {1u, 2u, 5u, 40u, 3000u, 60000u})
      for (const Extents extents : {Extents::longest_side, Extents::any}) {
        const auto scene = scene_of(random_tree(shape, share_of(nodes), 7 + nodes, extents),
                                    nodes % 2 ? kMinChunkBytes : kDefaultChunkBytes);
        expect_equal(scene, jumps(scene->tree, random, nodes > 10000 ? 12 : 20),
                     name_of(shape) + " of " + std::to_string(nodes));
      }
}

TEST_F(SearchTest, EqualTheHostsAlongWalksThatOutlastTheReferences) {
  std::mt19937 random(2);
  for (const TreeShape shape : {TreeShape::four_way, TreeShape::mixture, TreeShape::binary}) {
    const auto scene = scene_of(random_tree(shape, share_of(100000), 11));
    for (const float target : {0.004f, 0.05f, 0.5f})
      expect_equal(scene, walk(random, 700, target), name_of(shape));
  }
}

TEST_F(SearchTest, EqualTheHostsOnAMillionNodes) {
  std::mt19937 random(3);
  for (const TreeShape shape :
       {TreeShape::four_way, TreeShape::mixture, TreeShape::star, TreeShape::star_of_stars}) {
    const auto scene = scene_of(random_tree(shape, share_of(1000000), 5));
    std::vector<CutQuery> path = walk(random, 60, 0.01f);
    for (const CutQuery& q : jumps(scene->tree, random, 20)) path.push_back(q);
    expect_equal(scene, path, name_of(shape));
  }
}

// A fast flight: more subtrees are due than a part of the device has lanes, and not yet so many
// that streaming takes over.
TEST_F(SearchTest, EqualTheHostsWhereEachLaneHasASubtree) {
  const auto scene = scene_of(random_tree(TreeShape::recursive, share_of(1500000), 21));
  constexpr unsigned kMultiprocessors = 16, kMostLanes = 2048 * kMultiprocessors;
  const auto search = create(scene, Search::temporal, kMultiprocessors);
  Oracle oracle(*scene);
  Vec3f centre{5, -3, 8};
  float step = 1e-4f;
  int frames = 0;
  for (int i = 0; i < 40; ++i, step *= 1.35f) {
    const CutQuery query{centre = centre + Vec3f{step, 0.3f * step, -0.2f * step}, 0.004f};
    ASSERT_TRUE(same(run(*search, query), oracle.at(query))) << "frame " << i;
    const SearchStats stats = search->stats();
    frames += stats.ran == Search::temporal && stats.subtrees_visited > kMostLanes;
  }
  EXPECT_GT(frames, 0) << "no frame had so many due";
}

// How many nodes of the cut each segment of the list holds; no entry for none.
std::map<std::pair<uint32_t, uint32_t>, uint32_t> segments_of(const Scene& scene,
                                                              const std::vector<uint32_t>& cut) {
  std::vector<uint32_t> owner(scene.tree.size()), level(scene.tree.size());
  const auto& subtrees = scene.partition.subtrees;
  const auto& begin = scene.search.tier_begin;
  std::vector<uint32_t> block(subtrees.size());
  uint32_t blocks = 0;
  for (size_t tier = 0; tier + 1 < begin.size(); ++tier)
    for (uint32_t s = begin[tier]; s < begin[tier + 1]; ++s)
      block[s] = blocks += (s - begin[tier]) % cuda::kBlockSubtrees == 0;
  for (uint32_t s = 0; s < subtrees.size(); ++s)
    for (uint32_t slot = 0; slot < subtrees[s].node_count(); ++slot)
      owner[subtrees[s].node(slot)] = block[s];
  for (uint32_t n = 1; n < level.size(); ++n) level[n] = level[scene.tree.parent[n]] + 1;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> segments;
  for (const uint32_t n : cut) ++segments[{owner[n], level[n]}];
  return segments;
}

// A list has room for whole rows of places where there are many nodes to a segment. Here each has a
// few: rows for all would take more than there is, and segments share them, also those of several
// blocks of which few change.
TEST_F(SearchTest, EqualTheHostsWhereAListHasNoRoomForRows) {
  std::mt19937 random(4);
  for (LodTree& tree :
       std::array{random_tree(TreeShape::uneven, 3000, 9), tree_of_chains(2000, 30, 9)}) {
    const auto scene = scene_of(std::move(tree));
    std::vector<CutQuery> path = walk(random, 60, 0.02f);
    for (const CutQuery& q : jumps(scene->tree, random, 20)) path.push_back(q);
    for (const CutQuery& q : walk(random, 20, 1e-9f)) path.push_back(q);
    const cuda::CutState state(scene->search, 1, 1, scene->leaf_count);
    size_t shared = 0;
    Oracle oracle(*scene);
    for (const CutQuery& query : path)
      shared +=
          cuda::kRowPlaces * segments_of(*scene, oracle.at(query).cut).size() > state.list_room();
    EXPECT_GT(shared, path.size() / 4) << "of " << path.size();
    expect_equal(scene, path, "few nodes to a segment");
  }
}

// In a step more than 100 segments have more nodes than a list that had just moved would have room
// for.
TEST_F(SearchTest, EqualTheHostsWhereManySegmentsOutgrowTheirRoom) {
  std::mt19937 random(12);
  const auto scene = scene_of(random_tree(TreeShape::binary, share_of(1000000), 13));
  std::vector<CutQuery> path;
  Vec3f centre = anywhere(random, 40.0f);
  const Vec3f step = 20.0f * anywhere(random, 1.0f);
  for (int i = 0; i < 12; ++i) path.push_back({centre + static_cast<float>(i) * step, 0.01f});
  for (int i = 11; i >= 0; --i) path.push_back(path[i]);
  size_t most = 0;
  Oracle oracle(*scene);
  auto before = segments_of(*scene, oracle.at(path[0]).cut);
  for (const CutQuery& query : path) {
    const auto now = segments_of(*scene, oracle.at(query).cut);
    most = std::max<size_t>(
        most, std::count_if(now.begin(), now.end(), [&](const auto& segment) {
          const auto was = before.find(segment.first);
          const uint32_t room =
              was == before.end() ? 0 : cuda::segment_room(was->second, cuda::SegmentFit::roomy);
          return segment.second > room;
        }));
    before = now;
  }
  EXPECT_GT(most, 100u);
  expect_equal(scene, path, "many outgrow");
}

TEST_F(SearchTest, ASweepOfGranularityThereAndBackGivesTheSameCuts) {
  const auto scene = scene_of(random_tree(TreeShape::four_way, share_of(200000), 3));
  std::vector<CutQuery> path;
  for (int i = 0; i < 120; ++i) {
    const int k = i < 60 ? i : 119 - i;
    path.push_back({{10, -2, 30}, 1e-4f * std::pow(1.2f, static_cast<float>(k))});
  }
  expect_equal(scene, path, "sweep");
}

TEST_F(SearchTest, NothingIsVisitedAndNothingDriftsWhileTheViewerStands) {
  const auto scene = scene_of(random_tree(TreeShape::four_way, share_of(200000), 4));
  const auto search = create(scene, Search::temporal);
  const CutQuery query{{3, -2, 5}, 0.01f};
  const Result first = run(*search, query);
  ASSERT_FALSE(first.cut.empty());
  // Each run waits for 50 µs first, so that 1e5 of them take seconds.
  for (int i = 0; i < share_of(100000); ++i) search->run(query);
  EXPECT_TRUE(same(run(*search, query), first));
  EXPECT_EQ(search->stats().nodes_tested, 0u);
  EXPECT_EQ(search->stats().entered + search->stats().left, 0u);
}

// Where a list has no room for what enters, its neighbours make some: the rest stays where it is.
TEST_F(SearchTest, AStepMovesAPartOfTheList) {
  std::mt19937 random(12);
  const auto scene = scene_of(random_tree(TreeShape::four_way, share_of(1000000), 13));
  const auto on = device();
  const auto search = search_of(on, scene, Search::temporal);
  constexpr uint32_t kNone = 0xffffffffu;
  std::vector<uint32_t> before(scene->tree.size(), kNone);  // places of nodes
  size_t moving_frames = 0;
  Vec3f centre = anywhere(random, 40.0f);
  const Vec3f step = 0.05f * anywhere(random, 1.0f);
  for (int frame = 0; frame < share_of(100); ++frame, centre = centre + step) {
    search->find({centre, 0.01f}, nullptr);
    const cuda::CutList list = search->list();
    uint32_t size = 0;
    cuda::check(cudaMemcpy(&size, list.size, sizeof size, cudaMemcpyDeviceToHost), "size");
    std::vector<uint32_t> nodes(size);
    cuda::check(
        cudaMemcpy(nodes.data(), list.nodes, size * sizeof(uint32_t), cudaMemcpyDeviceToHost),
        "list");
    std::vector<uint32_t> now(before.size(), kNone);
    size_t moved = 0, stayed = 0;
    for (uint32_t place = 0; place < size; ++place) {
      if (nodes[place] == kNoNode) continue;
      now[nodes[place]] = place;
      if (before[nodes[place]] != kNone) (before[nodes[place]] == place ? stayed : moved) += 1;
    }
    ASSERT_TRUE(frame == 0 || stayed > moved) << "frame " << frame << ", " << moved << " moved";
    moving_frames += moved > stayed / 20;
    before = std::move(now);
  }
  EXPECT_GT(moving_frames, 0u);
}

TEST_F(SearchTest, ViewsOfOneSceneAreIndependent) {
  const auto scene = scene_of(random_tree(TreeShape::four_way, share_of(50000), 6));
  const auto here = create(scene, Search::temporal), there = create(scene, Search::temporal);
  Oracle oracle(*scene);
  std::mt19937 random(6);
  const auto a = walk(random, 100, 0.02f), b = walk(random, 100, 0.1f);
  for (size_t i = 0; i < a.size(); ++i) {
    here->run(a[i]);
    there->run(b[i]);
    Result found;
    here->read(found.cut, found.weights);
    ASSERT_TRUE(same(found, oracle.at(a[i]))) << i;
    there->read(found.cut, found.weights);
    ASSERT_TRUE(same(found, oracle.at(b[i]))) << i;
  }
}

TEST_F(SearchTest, CountsWhatEntersAndLeaves) {
  const auto scene = scene_of(random_tree(TreeShape::four_way, share_of(50000), 8));
  std::mt19937 random(8);
  ASSERT_FALSE(scene->search.leaves_have_extent);
  for (const Search kind :
       {Search::streaming, Search::temporal, Search::temporal_visit, Search::sweep}) {
    const auto search = create(scene, kind);
    std::vector<uint32_t> before;
    for (const CutQuery& query : walk(random, 60, 0.03f)) {
      const Result now = run(*search, query);
      std::vector<uint32_t> difference;
      std::set_difference(now.cut.begin(), now.cut.end(), before.begin(), before.end(),
                          std::back_inserter(difference));
      EXPECT_EQ(search->stats().entered, difference.size());
      difference.clear();
      std::set_difference(before.begin(), before.end(), now.cut.begin(), now.cut.end(),
                          std::back_inserter(difference));
      EXPECT_EQ(search->stats().left, difference.size());
      before = now.cut;
    }
  }
}

TEST_F(SearchTest, APartOfTheMultiprocessorsGivesTheSame) {
  const auto scene = scene_of(random_tree(TreeShape::four_way, share_of(50000), 9));
  Oracle oracle(*scene);
  std::mt19937 random(9);
  for (const Search kind : kSearches) {
    std::unique_ptr<SceneSearch> search;
    try {
      search = create(scene, kind, 16);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::unsupported) throw;
      VOYAGER_SKIP_WITHOUT(CUDA, error.what());  // a driver without green contexts
    }
    for (const CutQuery& query : walk(random, 30, 0.02f))
      ASSERT_TRUE(same(run(*search, query), oracle.at(query)));
  }
}

TEST_F(SearchTest, AnEmptyTreeHasAnEmptyCut) {
  const auto scene = scene_of(LodTree());
  for (const Search kind : kSearches)
    EXPECT_TRUE(run(*create(scene, kind), {{0, 0, 0}, 1.0f}).cut.empty());
}

}  // namespace
}  // namespace search_test
}  // namespace voyager::test
