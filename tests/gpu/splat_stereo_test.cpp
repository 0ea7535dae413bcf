// Two eyes of one view on the device.
#include "runtime/base/error.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/depth_limits.h"
#include "tests/support/stereo.h"

namespace voyager::test {
namespace splat_stereo_test {
namespace {

class SplatStereo : public SplatTest {
 protected:
  EyeFrames draw_pair(const std::shared_ptr<const Scene>& scene, const PipelineDesc& desc,
                      const FrameInput& pair) {
    return render_stereo(*cuda, scene, desc, pair);
  }
  void expect_as_alone(const std::shared_ptr<const Scene>& scene, const PipelineDesc& desc,
                       const FrameInput& pair) {
    const EyeFrames found = draw_pair(scene, desc, pair);
    uint64_t splats = 0, pairs = 0;
    for (size_t eye = 0; eye < 2; ++eye) {
      SCOPED_TRACE(eye == 0 ? "left" : "right");
      const Frame alone = draw(scene, desc, one_eye(pair, eye));
      expect_same_bits(found[eye], alone);
      EXPECT_EQ(found[eye].cut, alone.cut);
      splats += alone.stats.splats, pairs += alone.stats.pairs_after;
    }
    EXPECT_EQ(found[0].stats.splats, splats);
    EXPECT_EQ(found[0].stats.pairs_after, pairs);
    EXPECT_EQ(found[0].stats.pairs_dropped, 0u);
  }
};

// Where there is no cut that the other eye could change: every kernel of one eye against that
// of two.
TEST_F(SplatStereo, EyesOfAFlatSceneAreToTheBitAsAlone) {
  for (const int degree : {0, 1, 2, 3}) {
    const auto scene = flat_scene(random_cloud(share_of(6000), 61, degree));
    for (const FrameInput& pair : varied_pairs())
      for (const NamedDesc& named : all_exponentials(std::array{32u})) {
        SCOPED_TRACE(named.name + ", degree " + std::to_string(degree));
        expect_as_alone(scene, named.desc, pair);
      }
  }
}

TEST_F(SplatStereo, EyesInOnePlaceAreToTheBitAsAloneWithATree) {
  Camera ahead = look({3, -6, -24}, {0, 0, 0}, 233, 177);
  Camera aside = look({3, -6, -24}, {4, 1, 3}, 160, 190);
  aside.fx = ahead.fx;
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const auto scene = baked_scene(random_cloud(share_of(6000), 62, 3), quality);
    for (const double tau : {0.0, 3.0, 12.0, 40.0})
      expect_as_alone(scene, {}, stereo_input(ahead, aside, tau));
    expect_as_alone(scene, {.lod = Lod::all_leaves}, stereo_input(ahead, aside, 3));
  }
}

// More tiles an eye than a block of bin counts at once.
TEST_F(SplatStereo, EyesOfSeveralBandsAreToTheBitAsAlone) {
  Camera wide = look({3, -6, -24}, {0, 0, 0}, 8192, 1024),
         high = look({3.1, -6, -24}, {0, 0, 0}, 4096, 2048);
  wide.fx = wide.fy = 5000, high.fx = high.fy = 3000;
  expect_as_alone(flat_scene(random_cloud(share_of(6000), 66, 1)), {}, stereo_input(wide, high, 3));
}

TEST_F(SplatStereo, IsAsTheCpuAndTheReferenceDrawIt) {
  Agreement with_cpu("stereo, CUDA against the CPU"),
      with_reference("stereo, CUDA against the reference");
  const auto scene = baked_scene(random_cloud(share_of(6000), 63, 3));
  for (const FrameInput& pair : varied_pairs()) {
    const EyeFrames on_cpu = render_stereo(*cpu, scene, {}, pair);
    const EyeFrames on_reference = render_stereo(*reference, scene, {}, pair);
    for (const Exponential e : {Exponential::exact, Exponential::ex2}) {
      const EyeFrames found = draw_pair(scene, {.exponential = e}, pair);
      for (size_t eye = 0; eye < 2; ++eye) {
        with_cpu.add(found[eye], on_cpu[eye]);
        with_reference.add(found[eye], on_reference[eye]);
      }
    }
  }
  with_cpu.expect();
  with_reference.expect();
}

TEST_F(SplatStereo, TheFilterChangesNoBit) {
  const auto scene = baked_scene(random_cloud(share_of(6000), 64, 2));
  for (const FrameInput& pair : varied_pairs())
    for (NamedDesc named : all_exponentials(std::array{32u})) {
      SCOPED_TRACE(named.name);
      const EyeFrames on = draw_pair(scene, named.desc, pair);
      named.desc.alpha_filter = false;
      const EyeFrames off = draw_pair(scene, named.desc, pair);
      for (size_t eye = 0; eye < 2; ++eye) expect_same_bits(on[eye], off[eye]);
    }
}

TEST_F(SplatStereo, DepthAndLimitsAreAnEyesOwn) {
  const auto scene = flat_scene(random_cloud(share_of(6000), 65, 1));
  for (FrameInput pair : varied_pairs()) {
    const LimitImage limits(pair.eyes[1].camera, 18);
    pair.eyes[0].depth_wanted = false;
    pair.eyes[1].limits = limits.limits();
    expect_as_alone(scene, {}, pair);
    std::swap(pair.eyes[0], pair.eyes[1]);
    expect_as_alone(scene, {}, pair);
  }
}

// More than the first buffers hold, so that they grow in the middle of a frame.
TEST_F(SplatStereo, BuffersGrowForBothEyes) {
  const auto scene = flat_scene(random_cloud(300'000, 66, 0));
  Camera left = look({0, 0, -14}, {0, 0, 0}, 1500, 1100), right = left;
  right.eye.x += 0.065;
  expect_as_alone(scene, {.exponential = Exponential::ex2}, stereo_input(left, right, 3));
}

TEST_F(SplatStereo, InstancesOverlapInBothEyes) {
  const GaussianCloud cloud = random_cloud(share_of(3000), 67, 1);
  const auto scene = baked_scene(cloud);
  PipelineDesc desc;
  desc.eyes = 2;
  for (FrameInput pair : varied_pairs()) {
    pair.instances = {{}, {.position = {1, 0.5, -1}, .scale = 1.5}};
    View on_cuda({scene, scene}, *cuda, desc, std::pmr::get_default_resource(), workers);
    View on_cpu({scene, scene}, *cpu, desc, std::pmr::get_default_resource(), workers);
    const EyeFrames found = render_stereo(on_cuda, pair), expected = render_stereo(on_cpu, pair);
    for (size_t eye = 0; eye < 2; ++eye) {
      EXPECT_EQ(found[eye].cut, expected[eye].cut);
      EXPECT_GE(compare(found[eye], expected[eye]).psnr, 60);
    }
  }
}

TEST_F(SplatStereo, AnEmptySceneAndEyesThatLookAway) {
  const auto pair = varied_pairs()[0];
  for (const auto& scene : {empty_scene(), flat_scene(random_cloud(share_of(500), 68, 1))}) {
    FrameInput away = pair;
    for (FrameEye& eye : away.eyes)
      for (double* axis : {&eye.camera.world_to_view.row[0].x, &eye.camera.world_to_view.row[2].x})
        for (int k = 0; k < 3; ++k) axis[k] = -axis[k];
    const EyeFrames found = draw_pair(scene, {}, away);
    for (const Frame& frame : found) {
      expect_no_nan(frame);
      for (size_t i = 3; i < frame.rgba.size(); i += 4) ASSERT_EQ(frame.rgba[i], 0.0f);
    }
  }
}

TEST_F(SplatStereo, TheBaselineDrawsOneEye) {
  PipelineDesc desc;
  desc.splatting = Splatting::baseline_3dgs;
  EXPECT_THROW(draw_pair(flat_scene(random_cloud(10, 69, 0)), desc, varied_pairs()[0]), Error);
}

}  // namespace
}  // namespace splat_stereo_test
}  // namespace voyager::test
