// METHOD §10 on the device: every shot without NaN and with the same bits whether the
// α-filter is on or off, and near the reference where backends can be.
#include "cuda/scene/device_scene.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/extreme_scenes.h"

namespace voyager::test {
namespace splat_extreme_test {
namespace {

class SplatExtreme : public SplatTest {
 protected:
  Frame expect_sound(const ExtremeShot& shot) {
    SCOPED_TRACE(shot.name);
    Frame exact;
    for (const NamedDesc& named : all_exponentials(std::array{32u})) {
      SCOPED_TRACE(named.name);
      PipelineDesc desc = named.desc;
      const Frame on = draw(shot.scene, desc, shot.input);
      expect_no_nan(on);
      desc.alpha_filter = false;
      expect_same_bits(on, draw(shot.scene, desc, shot.input));
      if (desc.exponential == Exponential::exact) exact = on;
    }
    const Frame truth = draw(*reference, shot.scene, {}, shot.input);
    EXPECT_TRUE(exact.cut == truth.cut);
    if (shot.rough == kAnyPixel) return exact;
    const Difference d = compare(exact, truth);
    EXPECT_LE(d.rough, shot.rough + truth.depth.size() / 1000) << "largest " << d.largest;
    return exact;
  }
};

TEST_F(SplatExtreme, SizesAndFrusta) {
  for (const ExtremeShot& shot : size_shots()) expect_sound(shot);
  for (const ExtremeShot& shot : frustum_shots()) expect_sound(shot);
}

TEST_F(SplatExtreme, AnEmptySceneIsTheBackground) {
  for (const ExtremeShot& shot : empty_shots()) {
    const Frame frame = expect_sound(shot);
    for (size_t i = 0; i < frame.rgba.size(); ++i)
      ASSERT_EQ(frame.rgba[i], i % 4 == 3 ? 0.0f : shot.input.background[static_cast<int>(i % 4)]);
    for (const float z : frame.depth) ASSERT_EQ(z, INFINITY);
  }
}

TEST_F(SplatExtreme, FewGaussiansAndMany) {
  expect_sound(single_gaussian_shot());
  expect_sound(sheets_shot());
  for (const float opacity : {0.0042f, 0.3f, 1.0f}) {
    const Frame frame = expect_sound(layers_shot(opacity));
    EXPECT_NEAR(frame.at(2, 2)[3], 1, opacity == 1.0f ? 0.011 : 2e-3);
    EXPECT_NEAR(frame.at(2, 2)[1], 0.7 * double{frame.at(2, 2)[3]}, 1e-4);
  }
}

TEST_F(SplatExtreme, FacadesAndTheNearPlane) {
  expect_sound(facade_shot());
  expect_sound(turned_facade_shot());
  EXPECT_EQ(expect_sound(near_plane_shot(false)).stats.splats, 0u);
  ExtremeShot shot = near_plane_shot(true);
  EXPECT_EQ(expect_sound(shot).stats.splats, 1u);
  shot.input.eyes[0].camera.near_z = 1e-4;
  EXPECT_GT(expect_sound(shot).at(9, 9)[0], 0.9f);
}

TEST_F(SplatExtreme, ScalesNeedlesAndOpacities) {
  expect_sound(scales_shot());
  for (const float length : kNeedleLengths) expect_sound(needles_shot(length));
  for (const float opacity : kOpacities) expect_sound(opacity_shot(opacity));
}

TEST_F(SplatExtreme, ScalesNeedlesAndOpacitiesAntialiased) {
  for (const NativeScale& native : kExtremeNatives) {
    expect_sound(scales_shot(native));
    for (const float length : kNeedleLengths) expect_sound(needles_shot(length, native));
    for (const float opacity : kOpacities) expect_sound(opacity_shot(opacity, native));
  }
}

TEST_F(SplatExtreme, ColoursDegenerateCloudsAndFarCameras) {
  for (const ExtremeShot& shot : wild_colour_shots()) expect_sound(shot);
  const Frame frame = expect_sound(negative_colour_shot());
  EXPECT_EQ(frame.at(8, 8)[0], 0.0f);
  EXPECT_GT(frame.at(8, 8)[1], 0.4f);
  for (const ExtremeShot& shot : degenerate_shots()) expect_sound(shot);
  for (const ExtremeShot& shot : far_camera_shots())
    EXPECT_EQ(expect_sound(shot).cut.size(), 1u) << shot.name;
}

// As near the same scene at the origin as its means in scene-local binary32 are.
TEST_F(SplatExtreme, EarthCentredWithMillimetreSteps) {
  const GaussianCloud cloud = random_cloud(4000, 8, 1);
  const auto here = flat_scene(cloud), there = earth_centred_scene(cloud);
  const auto near_view = view(here), far_view = view(there);
  Agreement with_reference("earth-centred, CUDA against the reference");
  for (int step = 0; step < 8; ++step) {
    const FrameInput near =
        frame_input(look({0.001 * step, -1, -14}, {0.001 * step, 0, 0}, 160, 120));
    FrameInput far = near;
    far.eyes[0].camera.eye = far.eyes[0].camera.eye + there->origin;
    const Frame a = render(*near_view, near), b = render(*far_view, far);
    const Difference d = compare(a, b);
    EXPECT_GT(d.psnr, 70);
    EXPECT_LE(d.rough, a.depth.size() / 1000);
    with_reference.add(b, draw(*reference, there, {}, far));
  }
  with_reference.expect();
}

TEST_F(SplatExtreme, EarthCentredTreesWithMillimetreSteps) {
  GaussianCloud cloud = random_cloud(4000, 8, 1);
  cloud.origin = {6250.0 * 1024, -3000.0 * 1024, 4000.0 * 1024};
  const auto scene = baked_scene(cloud);
  ASSERT_GT(scene->origin.x, 6e6);
  const auto own = view(scene), exact = view(*reference, scene);
  Agreement with_reference("earth-centred tree, CUDA against the reference");
  for (int step = 0; step < 8; ++step) {
    FrameInput input =
        frame_input(look({0.001 * step, -1, -24}, {0.001 * step, 0, 0}, 160, 120), 6);
    input.eyes[0].camera.eye =
        input.eyes[0].camera.eye + Vec3d{cloud.origin[0], cloud.origin[1], cloud.origin[2]};
    with_reference.add(render(*own, input), render(*exact, input));
  }
  with_reference.expect();
}

TEST_F(SplatExtreme, WhatBinary16CannotHoldIsKeptInBinary32) {
  auto scene = flat_scene(random_cloud(100, 9, 2));
  const auto form = [&] { return cuda::DeviceScene(*device(), *scene, workers).view().sh_form; };
  EXPECT_EQ(form(), cuda::ShForm::half);
  scene->sh.back() = std::nextafter(-cuda::kMaxHalfCoefficient, -9.0f);
  EXPECT_EQ(form(), cuda::ShForm::single);
}

}  // namespace
}  // namespace splat_extreme_test
}  // namespace voyager::test
