// METHOD §7 on the device: the α-filter changes how much is done, and no bit of the image.
#include "tests/gpu/splat_test.h"

namespace voyager::test {
namespace splat_filter_test {
namespace {

constexpr uint32_t kLutSizes[] = {1, 8, 16, 32, 100, 128, 4096};

class SplatFilter : public SplatTest {
 protected:
  void expect_no_change(const std::shared_ptr<const Scene>& scene, PipelineDesc desc,
                        const FrameInput& input) {
    desc.alpha_filter = true;
    const Frame on = draw(scene, desc, input);
    desc.alpha_filter = false;
    const Frame off = draw(scene, desc, input);
    expect_same_bits(on, off);
    expect_no_nan(on);
    EXPECT_TRUE(on.cut == off.cut);
    EXPECT_EQ(on.stats.splats, off.stats.splats);
    EXPECT_EQ(on.stats.pairs_before, off.stats.pairs_before);
    EXPECT_EQ(off.stats.pairs_after, off.stats.pairs_before);
    EXPECT_LE(on.stats.pairs_after, off.stats.pairs_after);
    fewer += off.stats.pairs_after - on.stats.pairs_after;
  }

  uint64_t fewer = 0;  // pairs
};

TEST_F(SplatFilter, ChangesNoBitWithAnyExponential) {
  const auto scene = baked_scene(random_cloud(share_of(6000), 5, 2));
  for (const FrameInput& input : varied_frames())
    for (const NamedDesc& named : all_exponentials(kLutSizes)) {
      SCOPED_TRACE(named.name + ", tau " + std::to_string(input.tau));
      expect_no_change(scene, named.desc, input);
    }
  EXPECT_GT(fewer, 1000u);
}

TEST_F(SplatFilter, ChangesNoBitOfALargeFrame) {
  const GaussianCloud cloud = random_cloud(share_of(100000), 6, 1);
  const FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 1283, 717), 3);
  const auto baked = baked_scene(cloud);
  const std::shared_ptr<const Scene> flat = flat_scene(cloud);
  for (const NamedDesc& named : all_exponentials(std::array{32u})) {
    SCOPED_TRACE(named.name);
    expect_no_change(baked, named.desc, input);
    expect_no_change(flat, named.desc, input);
  }
}

// Long thin ellipses across many tiles, where the two lists differ most.
TEST_F(SplatFilter, ChangesNoBitOfNeedles) {
  GaussianCloud cloud = random_cloud(share_of(3000), 7, 0);
  for (size_t i = 0; i < cloud.size(); ++i) {
    cloud.log_scale[3 * i] = std::log(8.0f);
    cloud.log_scale[3 * i + 1] = cloud.log_scale[3 * i + 2] = std::log(1e-4f);
  }
  const auto scene = baked_scene(cloud);
  for (const FrameInput& input : varied_frames())
    for (const NamedDesc& named : all_exponentials(std::array{32u})) {
      SCOPED_TRACE(named.name + ", tau " + std::to_string(input.tau));
      expect_no_change(scene, named.desc, input);
    }
  EXPECT_GT(fewer, 100000u);
}

TEST_F(SplatFilter, CountingPixelsChangesNoBit) {
  const auto scene = baked_scene(random_cloud(share_of(6000), 8, 1));
  for (const FrameInput& input : varied_frames()) {
    const Frame plain = draw(scene, {}, input),
                counted = draw(scene, {.count_pixels = true}, input);
    expect_same_bits(plain, counted);
    EXPECT_GT(counted.stats.pixels_blended, 0u);
    EXPECT_GT(counted.stats.pixels_evaluated, counted.stats.pixels_blended);
    EXPECT_EQ(plain.stats.pixels_evaluated, 0u);
  }
}

}  // namespace
}  // namespace splat_filter_test
}  // namespace voyager::test
