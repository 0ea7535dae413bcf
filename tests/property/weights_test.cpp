// The draw list: the cut in order, its weights against METHOD §4 in double, and
// what a damaged chunk does to a frame.
#include <algorithm>

#include "runtime/frame/draw_list.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/whole_tree.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_rules.h"

namespace voyager::weights_test {
namespace {

using test::frame_input;
using test::look;

std::vector<FrameInput> frames() {
  std::vector<FrameInput> all;
  for (const double tau : {0.0, 2.0, 10.0, 30.0, 200.0})
    for (const Vec3d& eye : {Vec3d{3, -6, -24}, Vec3d{0, 1, 0}, Vec3d{-200, 10, 5}})
      all.push_back(frame_input(look(eye, {0.5, 0, 0}, 200, 120), tau));
  return all;
}

double exact_size(const NodeRecord& r, const Vec3d& c) {
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = c[k] - std::clamp(c[k], double{r.box_min[k]}, double{r.box_max[k]});
    squared += d * d;
  }
  return squared == 0 ? INFINITY : double{r.extent} / std::sqrt(squared);
}

// Returns how many nodes lie between themselves and their parents.
size_t check_weights(const TreeRule& rule) {
  const auto scene = test::baked_scene(test::random_cloud(5000, 1, 0), Quality::lossless, rule);
  const auto whole = whole_tree(*scene);
  const LodTree& tree = *whole;
  Workers workers(2);
  DrawList draws(scene, Lod::cut, Search::temporal, std::pmr::get_default_resource(), workers);
  size_t between = 0;
  for (const FrameInput& input : frames()) {
    draws.update(cut_query(input, 0, scene->origin), workers);
    std::pmr::vector<uint32_t> cut;
    draws.read_cut(cut);
    EXPECT_EQ(draws.items().size(), cut.size());
    const Vec3f eye = cut_centre(input.eyes[0].camera.eye, scene->origin);
    const double target = (2 * input.tau + 1) / input.eyes[0].camera.fx;
    for (size_t i = 0; i < draws.items().size(); ++i) {
      const DrawItem& item = draws.items()[i];
      EXPECT_EQ(item.gaussian, cut[i]);
      EXPECT_TRUE(i == 0 || draws.items()[i - 1].gaussian < item.gaussian);
      const uint32_t parent = tree.parent[item.gaussian];
      if (item.t == 1.0f) {
        EXPECT_EQ(item.parent, kNoNode);
      } else {
        EXPECT_EQ(item.parent, parent);
        EXPECT_EQ(item.inverse_k, 1.0f / static_cast<float>(tree.records[parent].child_count));
        ++between;
      }
      if (parent == kNoNode) continue;
      const Vec3d c{double{eye.x}, double{eye.y}, double{eye.z}};
      const double above = exact_size(tree.records[parent], c),
                   own = exact_size(tree.records[item.gaussian], c);
      const double share = tree.blend_share;
      const double start = std::max(share * above, own), span = above - start;
      double t = 1;
      if (share * above <= target && span > 0)
        t = std::clamp(1 - (target - start) / span, 0.0, 1.0);
      EXPECT_NEAR(double{item.t}, t, span > 0 && above < INFINITY ? 1e-6 * above / span : 0)
          << item.gaussian;
    }
  }
  return between;
}

TEST(Weights, FollowTheMethodInDouble) {
  EXPECT_GT(check_weights(test::kHierarchicalGs), 1000u);
  EXPECT_GT(check_weights({}), 200u);
}

TEST(Weights, BothBackendsDrawTheSameCut) {
  const auto scene = test::baked_scene(test::random_cloud(5000, 2, 0));
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  for (FrameInput input : frames()) {
    input.eyes[0].camera.width = input.eyes[0].camera.height = 8;
    const test::Frame a = test::render(*cpu, scene, {}, input),
                      b = test::render(*reference, scene, {}, input);
    EXPECT_EQ(a.cut, b.cut);
    EXPECT_EQ(a.stats.cut_size, a.cut.size());
    EXPECT_EQ(a.stats.tau_star, b.stats.tau_star);
  }
}

TEST(Weights, AllLeavesAreDrawnInTheInputsOrder) {
  const GaussianCloud cloud = test::random_cloud(3000, 3, 0);
  const auto scene = test::baked_scene(cloud);
  Workers workers(2);
  DrawList draws(scene, Lod::all_leaves, Search::temporal, std::pmr::get_default_resource(),
                 workers);
  draws.update(cut_query(frames()[0], 0, scene->origin), workers);
  ASSERT_EQ(draws.items().size(), cloud.size());
  for (size_t i = 0; i < cloud.size(); ++i) {
    const DrawItem& item = draws.items()[i];
    EXPECT_EQ(item.t, 1.0f);
    EXPECT_EQ(scene->gaussians[item.gaussian].mean.x, cloud.position[3 * i]);
  }
}

// A frame throws exactly where the cut or what is above it lies in the damage.
bool needs(const LodTree& tree, const std::vector<uint32_t>& cut,
           const std::vector<NodeRange>& damage) {
  for (uint32_t node : cut)
    for (; node != kNoNode; node = tree.parent[node])
      if (test::holds(damage, node)) return true;
  return false;
}

TEST(Weights, DamageStopsOnlyTheFramesThatNeedIt) {
  const test::Bytes bytes =
      test::scene_bytes(test::bake(test::random_cloud(6000, 4, 1)), Quality::lossless, 0, 32768);
  Workers workers(2);
  const auto whole = load_scene(test::source_of(bytes), std::pmr::get_default_resource(), workers);
  const SceneFile file(test::source_of(bytes));
  const auto cpu = create_cpu_backend();
  size_t stopped = 0, drawn = 0;
  std::vector<FrameInput> inputs = frames();
  for (const double tau : {1000.0, 1e5})
    inputs.push_back(frame_input(look({3, -6, -50}, {0, 0, 0}, 60, 40), tau));
  for (uint32_t index = 0; index < file.chunks().size(); ++index) {
    const ChunkEntry& chunk = file.chunks()[index];
    const auto source =
        std::make_shared<test::FlippedSource>(bytes, chunk.offset + chunk.bytes / 3, std::byte{4});
    const auto damaged = load_scene(source, std::pmr::get_default_resource(), workers);
    ASSERT_EQ(damaged->damaged_chunks.size(), 1u);
    for (const FrameInput& input : inputs) {
      const test::Frame expected = test::render(*cpu, whole, {}, input);
      if (needs(*whole_tree(*whole), expected.cut, file.nodes_of(index))) {
        ++stopped;
        EXPECT_EQ(test::error_code([&] { test::render(*cpu, damaged, {}, input); }),
                  ErrorCode::damaged_chunk);
      } else {
        ++drawn;
        const test::Frame found = test::render(*cpu, damaged, {}, input);
        test::expect_same_bits(expected, found);
        EXPECT_EQ(expected.cut, found.cut);
      }
    }
    const Chunk lost = file.read_chunk(index);
    const bool leaves = std::any_of(lost.records.begin(), lost.records.end(),
                                    [](const NodeRecord& r) { return r.child_count == 0; });
    const auto draw_leaves = [&] {
      test::render(*cpu, damaged, {.lod = Lod::all_leaves}, inputs[0]);
    };
    if (leaves) {
      EXPECT_EQ(test::error_code(draw_leaves), ErrorCode::damaged_chunk);
    } else {
      EXPECT_NO_THROW(draw_leaves());
    }
  }
  EXPECT_GT(stopped, 20u);
  EXPECT_GT(drawn, 5u);
}

constexpr Search kSearches[] = {Search::exhaustive, Search::streaming, Search::temporal,
                                Search::temporal_visit};

// The searches that keep their cut count what entered and left; the view does it for
// the others, from the lists.
TEST(Weights, EverySearchDrawsAndCountsTheSame) {
  const auto scene = test::baked_scene(test::random_cloud(5000, 5, 0));
  const auto cpu = create_cpu_backend();
  Workers workers(2);
  std::vector<std::unique_ptr<View>> views;
  for (const Search search : kSearches)
    views.push_back(std::make_unique<View>(scene, *cpu, PipelineDesc{.search = search},
                                           std::pmr::get_default_resource(), workers));
  uint64_t entered = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const Vec3d eye{3 + 0.05 * frame, -6, -24};
    const FrameInput input = frame_input(look(eye, {0.5, 0, 0}, 60, 40), frame < 20 ? 10 : 30);
    const test::Frame expected = test::render(*views[0], input);
    EXPECT_EQ(expected.stats.search, Search::exhaustive);
    for (size_t k = 1; k < views.size(); ++k) {
      const test::Frame found = test::render(*views[k], input);
      test::expect_same_bits(expected, found);
      ASSERT_EQ(expected.cut, found.cut);
      ASSERT_EQ(expected.stats.entered, found.stats.entered) << frame;
      ASSERT_EQ(expected.stats.left, found.stats.left) << frame;
      EXPECT_LE(found.stats.nodes_tested, expected.stats.nodes_tested);
      if (frame == 0 || kSearches[k] == Search::streaming) {
        EXPECT_EQ(found.stats.search, Search::streaming);
      }
      if (frame == 1) {
        EXPECT_EQ(found.stats.search, kSearches[k]);
      }
    }
    entered += expected.stats.entered;
  }
  EXPECT_GT(entered, 500u);
}

// After a frame that failed a view still has its last cut and statistics, and
// draws the next frame as if nothing had been.
TEST(Weights, AViewSurvivesAFrameThatFailed) {
  const test::Bytes bytes =
      test::scene_bytes(test::bake(test::random_cloud(6000, 4, 1)), Quality::lossless);
  Workers workers(2);
  const SceneFile file(test::source_of(bytes));
  const auto& last = file.chunks().back();
  const auto scene =
      load_scene(std::make_shared<test::FlippedSource>(bytes, last.offset + 200, std::byte{1}),
                 std::pmr::get_default_resource(), workers);
  const auto cpu = create_cpu_backend();
  const FrameInput good = frame_input(look({3, -6, -50}, {0, 0, 0}, 60, 40), 1e5),
                   bad = frame_input(look({0, 1, 0}, {1, 0, 0}, 60, 40), 0);
  for (const Search search : kSearches) {
    View view(scene, *cpu, {.search = search}, std::pmr::get_default_resource(), workers);
    const test::Frame before = test::render(view, good);
    for (int attempt = 0; attempt < 2; ++attempt) {
      EXPECT_EQ(test::error_code([&] { test::render(view, bad); }), ErrorCode::damaged_chunk);
      EXPECT_TRUE(
          std::equal(view.cut().begin(), view.cut().end(), before.cut.begin(), before.cut.end()));
      EXPECT_EQ(view.stats().cut_size, before.cut.size());
    }
    const test::Frame after = test::render(view, good);
    test::expect_same_bits(before, after);
    EXPECT_EQ(after.stats.entered, 0u);
    EXPECT_EQ(after.stats.left, 0u);
  }
}

// A search by itself, as measurements run it.
TEST(Weights, ASceneSearchGivesTheCutAndItsWeights) {
  const auto scene = test::baked_scene(test::random_cloud(5000, 6, 0));
  Workers workers(2);
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  const CutQuery query{{3, -6, -24}, 0.05f};
  std::vector<uint32_t> expected_cut, cut;
  std::vector<float> expected_weights, weights;
  cpu->create_search(scene, {Search::exhaustive}, std::pmr::get_default_resource(), workers)
      ->read(cut, weights);
  EXPECT_TRUE(cut.empty()) << "before any run";
  for (const auto* backend : {&cpu, &reference})
    for (const Search kind : kSearches)
      for (const bool wanted : {true, false}) {
        const auto search = (*backend)->create_search(scene, {kind, wanted},
                                                      std::pmr::get_default_resource(), workers);
        search->run(query);
        search->read(cut, weights);
        if (expected_cut.empty()) expected_cut = cut, expected_weights = weights;
        ASSERT_EQ(cut, expected_cut);
        ASSERT_EQ(weights, wanted ? expected_weights : std::vector<float>());
        EXPECT_GT(search->stats().nodes_tested, 0u);
        EXPECT_GE(search->times().search, 0.0);
      }
}

}  // namespace
}  // namespace voyager::weights_test
