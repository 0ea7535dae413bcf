// METHOD §4 on the device: interpolated nodes, and siblings that add up to their parent.
#include <algorithm>
#include <numeric>

#include "runtime/frame/draw_list.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/whole_tree.h"
#include "runtime/lod/merge.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_rules.h"

namespace voyager::test {
namespace splat_sibling_test {
namespace {

std::shared_ptr<const Scene> scene_of(const BakedScene& baked) {
  Workers own;
  return load_scene(source_of(scene_bytes(baked, Quality::lossless)),
                    std::pmr::get_default_resource(), own);
}

// The root's Gaussian, from those of the leaves.
GaussianCloud merged_of(const GaussianCloud& leaves) {
  std::vector<MergeInput> children;
  const auto floats = static_cast<size_t>(leaves.coefficients()) * 3;
  for (size_t i = 0; i < leaves.size(); ++i)
    children.push_back({activate(leaves.words(i), true), &leaves.sh[floats * i]});
  GaussianCloud cloud;
  cloud.sh_degree = leaves.sh_degree;
  cloud.sh.resize(floats);
  const GaussianWords words = merge(children, leaves.coefficients(), cloud.sh.data()).words;
  for (int k = 0; k < 3; ++k) cloud.position.push_back(words.mean[k]);
  for (int k = 0; k < 3; ++k) cloud.log_scale.push_back(words.log_scale[k]);
  cloud.rotation = {words.rotation.w, words.rotation.x, words.rotation.y, words.rotation.z};
  cloud.opacity = {words.opacity};
  return cloud;
}

// A root and `count` leaves.
std::shared_ptr<const Scene> star(uint32_t count) {
  BakedScene baked;
  baked.leaves = random_cloud(count, count, 1, 4.0f);
  for (float& s : baked.leaves.log_scale) s = 0.3f * s - 1;
  baked.merged = merged_of(baked.leaves);
  std::vector<uint32_t> child_counts(count + 1, 0);
  child_counts[0] = count;
  baked.tree = linked_tree(child_counts);
  NodeRecord& root = baked.tree.records[0];
  root.box_min = {-10, -10, -10}, root.box_max = {10, 10, 10};
  root.extent = 20;
  for (uint32_t n = 1; n <= count; ++n) {
    NodeRecord& leaf = baked.tree.records[n];
    leaf.box_min = {-9, -9, -9}, leaf.box_max = {9, 9, 9}, leaf.extent = 0;
  }
  baked.gaussian.resize(count + 1);
  std::iota(baked.gaussian.begin() + 1, baked.gaussian.end(), 0u);
  baked.node_code.resize(count + 1);
  baked.kind = TreeKind::hierarchicalgs;  // an only child is another than its parent
  return scene_of(baked);
}

class SplatSibling : public SplatTest {
 protected:
  static constexpr Vec3d kEye{3, -6, -34};

  // With τ* at `share` of the root's size on screen: t of its children is 2·(1 - share).
  static FrameInput at_share(const Scene& scene, double share) {
    FrameInput input = frame_input(look(kEye, {0, 0, 0}, 200, 160));
    const double size = whole_tree(scene)->screen_size(0, cut_centre(kEye, scene.origin));
    input.tau = (share * size * input.eyes[0].camera.fx - 1) / 2;
    return input;
  }
  // Of the nodes that a frame draws, those between their parent and themselves.
  double interpolated_share(const std::shared_ptr<const Scene>& scene, const FrameInput& input) {
    DrawList draws(scene, Lod::cut, Search::temporal, std::pmr::get_default_resource(), workers);
    draws.update(cut_query(input, 0, scene->origin), workers);
    size_t count = 0;
    for (const DrawItem& item : draws.items()) count += item.t < 1;
    return static_cast<double>(count) / static_cast<double>(draws.items().size());
  }
};

TEST_F(SplatSibling, ThousandsOfSiblingsAsTheReferenceDrawsThem) {
  Agreement with_reference("stars, CUDA against the reference"),
      with_ex2("stars, ex2 against the reference");
  for (const uint32_t count : {1u, 2u, 3u, 63u, 64u, 65u, 1000u, 5000u}) {
    const auto scene = star(count);
    for (const double share : {0.999, 0.9, 0.7, 0.52}) {
      const FrameInput input = at_share(*scene, share);
      EXPECT_EQ(interpolated_share(scene, input), 1);
      const Frame truth = draw(*reference, scene, {}, input);
      with_reference.add(draw(scene, {}, input), truth);
      with_ex2.add(draw(scene, {.exponential = Exponential::ex2}, input), truth);
    }
  }
  with_reference.expect();
  with_ex2.expect();
}

TEST_F(SplatSibling, AtTheirParentsPlaceTheyAddUpToIt) {
  for (const uint32_t count : {1u, 2u, 64u, 65u, 1000u, 5000u})
    for (const Exponential exponential : {Exponential::exact, Exponential::ex2}) {
      const auto scene = star(count);
      const Frame children = draw(scene, {.exponential = exponential}, at_share(*scene, 1)),
                  parent = draw(scene, {.exponential = exponential}, at_share(*scene, 1.001));
      ASSERT_EQ(children.cut.size(), count);
      ASSERT_EQ(parent.cut.size(), 1u);
      const Difference d = compare(children, parent);
      EXPECT_GE(d.psnr, 60) << count;
      EXPECT_LE(d.rough, parent.depth.size() / 1000) << count << ", largest " << d.largest;
    }
}

TEST_F(SplatSibling, MostNodesBetweenTheirParentsAndThemselves) {
  Agreement with_reference("interpolated nodes, CUDA against the reference"),
      with_cpu("interpolated nodes, CUDA against the CPU");
  double most = 0;
  for (const TreeRule& rule : {kHierarchicalGs, TreeRule{}}) {
    const auto scene = baked_scene(random_cloud(share_of(20000), 4, 2), Quality::lossless, rule);
    for (const double tau : {0.5, 2.0, 5.0, 10.0, 20.0, 40.0}) {
      const FrameInput input = frame_input(look({3, -6, -34}, {0, 0, 0}, 240, 160), tau);
      most = std::max(most, interpolated_share(scene, input));
      const Frame found = draw(scene, {}, input);
      with_reference.add(found, draw(*reference, scene, {}, input));
      with_cpu.add(found, draw(*cpu, scene, {}, input));
    }
  }
  with_reference.expect();
  with_cpu.expect();
  EXPECT_GT(most, 0.9);  // HierarchicalGS's leaves blend over a whole octave
}

TEST_F(SplatSibling, TreesOfEveryShape) {
  Agreement with_reference("trees, CUDA against the reference");
  for (const TreeShape shape : kTreeShapes) {
    const auto scene = scene_of(baked_of(random_tree(shape, share_of(3000), 6, Extents::any)));
    for (const double tau : {1.0, 10.0, 100.0})
      for (const Vec3d& eye : {Vec3d{3, -6, -24}, Vec3d{-150, 2, 9}}) {
        const FrameInput input = frame_input(look(eye, {0, 0, 0}, 160, 100), tau);
        with_reference.add(draw(scene, {}, input), draw(*reference, scene, {}, input));
      }
  }
  with_reference.expect();
}

}  // namespace
}  // namespace splat_sibling_test
}  // namespace voyager::test
