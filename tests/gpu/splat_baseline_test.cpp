// `--splat 3dgs`: 3DGS's boxes and thresholds, the baseline of measurements.
#include <algorithm>

#include "runtime/base/error.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"

namespace voyager::test {
namespace splat_baseline_test {
namespace {

class SplatBaseline : public SplatTest {
 protected:
  void SetUp() override {
    SplatTest::SetUp();
    if (IsSkipped()) return;
    try {
      view(flat_scene(GaussianCloud()), {.splatting = Splatting::baseline_3dgs});
    } catch (const Error& error) {
      if (error.code() != ErrorCode::unsupported) throw;
      VOYAGER_SKIP_WITHOUT(CUDA, error.what());
    }
  }
};

TEST_F(SplatBaseline, IsNearOursAndTheSameTwice) {
  const GaussianCloud cloud = random_cloud(20000, 13, 2);
  const auto baked = baked_scene(cloud);
  const std::shared_ptr<const Scene> flat = flat_scene(cloud);
  double least = INFINITY;
  uint64_t base_pairs = 0, our_pairs = 0;
  for (const auto& [scene, lod] :
       {std::pair(baked, Lod::cut), {baked, Lod::all_leaves}, {flat, Lod::cut}}) {
    const PipelineDesc base{
        .lod = lod, .search = Search::exhaustive, .splatting = Splatting::baseline_3dgs};
    const auto one = view(scene, base), ours = view(scene, {.lod = lod});
    for (const FrameInput& input : varied_frames()) {
      const Frame frame = render(*one, input), expected = render(*ours, input);
      expect_no_nan(frame);
      expect_same_bits(frame, render(*one, input));
      expect_same_bits(frame, draw(scene, base, input));
      EXPECT_TRUE(frame.cut == expected.cut);
      EXPECT_EQ(frame.stats.pairs_dropped, 0u);
      least = std::min(least, compare(frame, expected).psnr);
      EXPECT_GT(different_bits(frame.rgba, expected.rgba), 0u);  // its support ends at 3σ
      base_pairs += frame.stats.pairs_after, our_pairs += expected.stats.pairs_after;
    }
  }
  std::printf("3dgs against ours: at least %.1f dB\n", least);
  EXPECT_GE(least, 35);
  EXPECT_GT(base_pairs, our_pairs);
}

TEST_F(SplatBaseline, GrowsLikeOurs) {
  const std::shared_ptr<const Scene> scene = flat_scene(random_cloud(500000, 14, 0));
  const FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 960, 540));
  const auto one = view(scene, {.splatting = Splatting::baseline_3dgs});
  const Frame first = render(*one, input);
  EXPECT_EQ(first.stats.pairs_dropped, 0u);
  expect_same_bits(first, render(*one, input));
  EXPECT_GE(compare(first, draw(scene, {}, input)).psnr, 35);
}

}  // namespace
}  // namespace splat_baseline_test
}  // namespace voyager::test
