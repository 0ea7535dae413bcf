// Files of version 4 have doubles: nodes that repeat their only child (docs/lod-tree.md). They are
// not interpolated: nothing but rounding may show it.
#include <algorithm>

#include "runtime/frame/draw_list.h"
#include "runtime/frame/frame_search.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"

namespace voyager::doubles_test {
namespace {

std::shared_ptr<Scene> kept_scene(Workers& workers) {
  return std::const_pointer_cast<Scene>(load_scene(
      open_file_source(VOYAGER_SOURCE_DIR "/tests/fuzz/corpus/voy/version4_lossless.voy"),
      std::pmr::get_default_resource(), workers));
}

TEST(Doubles, ThePictureIsThatOfATreeWhoseNodesAllBlendWithTheirParents) {
  Workers workers(2);
  const auto doubled = kept_scene(workers), blended = kept_scene(workers);
  ASSERT_TRUE(doubled->doubles);
  ASSERT_EQ(doubled->tree.blend_share, kHalfShare);
  blended->doubles = false;
  const auto cpu = create_cpu_backend();
  const auto reference = create_reference_backend();
  size_t of_doubles = 0;
  for (const double tau : {3.0, 12.0, 40.0, 100.0}) {
    const FrameInput input = test::frame_input(test::look({60, -90, 60}, {0, 0, 0}, 160, 100), tau);
    DrawList draws(doubled, Lod::cut, Search::exhaustive, std::pmr::get_default_resource(),
                   workers);
    draws.update(cut_query(input, 0, doubled->origin), workers);
    of_doubles += static_cast<size_t>(std::count_if(
        draws.items().begin(), draws.items().end(),
        [](const DrawItem& item) { return item.t < 1 && item.t > 0 && item.inverse_k == 1; }));
    for (Backend* backend : {cpu.get(), reference.get()}) {
      View with(doubled, *backend, {}, std::pmr::get_default_resource(), workers),
          without(blended, *backend, {}, std::pmr::get_default_resource(), workers);
      const test::Frame found = test::render(with, input), expected = test::render(without, input);
      ASSERT_EQ(found.cut, expected.cut);
      const test::Difference d = test::compare(found, expected);
      EXPECT_GE(d.psnr, 100) << tau;
      EXPECT_EQ(d.rough, 0u) << tau << ", largest " << d.largest;
    }
  }
  EXPECT_GT(of_doubles, 20u);
}

}  // namespace
}  // namespace voyager::doubles_test
