// METHOD §12 where footprints differ: the CPU against the float64 reference.
#include "runtime/frame/draw_list.h"
#include "runtime/frame/frame_search.h"
#include "tests/support/mixed_footprints.h"
#include "tests/support/render_scene.h"

namespace voyager::footprint_parity_test {
namespace {

using test::frame_input;
using test::look;
using test::render;

// Nodes that are drawn between their parent and themselves, with another footprint than it.
size_t between_footprints(const std::shared_ptr<const Scene>& scene, const FrameInput& input) {
  Workers workers;
  DrawList draws(scene, Lod::cut, Search::temporal, std::pmr::get_default_resource(), workers);
  draws.update(cut_query(input, 0, scene->origin), workers);
  size_t count = 0;
  for (const DrawItem& item : draws.items())
    count += item.t < 1 && footprint_level_of(scene->node_code[item.gaussian]) !=
                               footprint_level_of(scene->node_code[item.parent]);
  return count;
}

TEST(FootprintParity, CpuAgreesWithTheReference) {
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  size_t rough = 0, pixels = 0, between = 0;
  for (const TreeRule& rule : test::kMixedRules) {
    const auto scene = test::loaded(
        test::bake_by_cameras(test::random_cloud(4000, 21, 1), test::close_camera(), rule));
    ASSERT_GT(scene->native.levels, 3);
    for (const double tau : {0.0, 3.0, 12.0, 30.0, 60.0, 100.0, 160.0})
      for (const Lod lod : {Lod::cut, Lod::all_leaves}) {
        const FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 160, 100), tau);
        const test::Frame a = render(*cpu, scene, {.lod = lod}, input),
                          b = render(*reference, scene, {.lod = lod}, input);
        const test::Difference d = compare(a, b);
        EXPECT_GE(d.psnr, 60) << tau;
        rough += d.rough;
        pixels += a.depth.size();
        between += between_footprints(scene, input);
      }
  }
  EXPECT_LE(rough, pixels / 2000);
  EXPECT_GT(between, 20u);
}

// What a largest footprint bounds is not what is drawn: a picture must not change where the header
// has a larger one that no node uses.
TEST(FootprintParity, ALargerFootprintThatNoNodeHasChangesNothing) {
  const BakedScene baked =
      test::bake_by_cameras(test::random_cloud(2000, 22, 0), test::close_camera());
  BakedScene other = test::bake_by_cameras(test::random_cloud(2000, 22, 0), test::close_camera());
  ASSERT_LT(other.leaves.native.levels, kFootprintLevels - 1);
  other.leaves.native.pixel *= 2;
  other.leaves.native.levels += 2;
  for (uint8_t& code : other.node_code)
    code = node_code(axis_code_of(code), footprint_level_of(code) + 2);
  const auto cpu = create_cpu_backend();
  for (const double tau : {0.0, 20.0, 80.0}) {
    const FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 160, 100), tau);
    test::expect_same_bits(render(*cpu, test::loaded(baked), {}, input),
                           render(*cpu, test::loaded(other), {}, input));
  }
}

}  // namespace
}  // namespace voyager::footprint_parity_test
