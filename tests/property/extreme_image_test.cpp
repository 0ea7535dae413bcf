// METHOD §10: sizes, cameras and Gaussians at the edge, on both backends.
#include <algorithm>
#include <limits>

#include "runtime/base/error.h"
#include "runtime/math/alpha.h"
#include "tests/support/extreme_scenes.h"

namespace voyager::extreme_image_test {
namespace {

using test::compare;
using test::ExtremeShot;
using test::Frame;
using test::frame_input;
using test::look;
using test::render;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// CPU and reference draw it alike, with the filter and without, and no NaN.
// Returns the CPU's frame.
Frame expect_sound(const ExtremeShot& shot) {
  SCOPED_TRACE(shot.name);
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  const auto draw = [&](Backend& backend, const PipelineDesc& desc) {
    return render(backend, shot.scene, desc, shot.input);
  };
  const Frame on = draw(*cpu, {});
  test::expect_no_nan(on);
  test::expect_same_bits(on, draw(*cpu, {.alpha_filter = false}));
  const Frame ex2 = draw(*cpu, {.exponential = Exponential::ex2});
  test::expect_no_nan(ex2);
  test::expect_same_bits(ex2, draw(*cpu, {.alpha_filter = false, .exponential = Exponential::ex2}));
  const Frame truth = draw(*reference, {});
  test::expect_no_nan(truth);
  test::expect_same_bits(truth, draw(*reference, {.alpha_filter = false}));
  EXPECT_LE(compare(on, truth).rough, shot.rough) << "largest " << compare(on, truth).largest;
  return on;
}

TEST(ExtremeImage, EverySizeIsFiniteAndNearTheReference) {
  for (const ExtremeShot& shot : test::size_shots()) expect_sound(shot);
}

TEST(ExtremeImage, FieldsOfViewAndOffCentreFrusta) {
  for (const ExtremeShot& shot : test::frustum_shots()) expect_sound(shot);
}

TEST(ExtremeImage, AnEmptySceneIsTransparentBlackOverTheBackground) {
  for (const ExtremeShot& shot : test::empty_shots()) {
    const Frame frame = expect_sound(shot);
    for (size_t i = 0; i < frame.rgba.size(); ++i)
      ASSERT_EQ(frame.rgba[i], i % 4 == 3 ? 0.0f : shot.input.background[static_cast<int>(i % 4)]);
    for (const float z : frame.depth) ASSERT_EQ(z, kInfinity);
  }
}

TEST(ExtremeImage, ASingleGaussianIsItsFormula) {
  const ExtremeShot shot = test::single_gaussian_shot();
  const Frame frame = expect_sound(shot);
  const double f = shot.input.eyes[0].camera.fx;
  const double xx = std::pow(f * double{0.2f} / 4, 2) + 0.3,
               yy = std::pow(f * double{0.1f} / 4, 2) + 0.3;
  for (size_t y = 0; y < 48; ++y)
    for (size_t x = 0; x < 64; ++x) {
      const double dx = static_cast<double>(x) - 31.5, dy = static_cast<double>(y) - 23.5;
      const double alpha = double{0.8f} * std::exp(-0.5 * (dx * dx / xx + dy * dy / yy));
      if (std::fabs(alpha * 255 - 1) < 1e-4) continue;
      const double expected = alpha * 255 > 1 ? alpha : 0;
      ASSERT_NEAR(frame.at(x, y)[3], expected, 2e-6);
      ASSERT_NEAR(frame.at(x, y)[0], expected, 2e-6);
      ASSERT_EQ(frame.depth[y * 64 + x], expected >= 0.5 ? 4.0f : kInfinity);
    }
}

TEST(ExtremeImage, DepthIsTheFirstAtWhichHalfIsHidden) {
  const ExtremeShot shot = test::sheets_shot();
  const Frame frame = expect_sound(shot);
  std::vector<std::pair<float, float>> layers;
  for (const Gaussian& g : shot.scene->gaussians) layers.push_back({g.mean.z, g.opacity});
  std::stable_sort(layers.begin(), layers.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  double left = 1;
  float expected = kInfinity;
  for (const auto& [z, alpha] : layers) {
    if (alpha < kAlphaThreshold) continue;
    if (left > 0.5 && left * (1 - double{alpha}) <= 0.5) expected = z;
    left *= 1 - double{alpha};
  }
  for (const float z : frame.depth) EXPECT_EQ(z, expected);
}

TEST(ExtremeImage, AHundredThousandLayersOverOnePixel) {
  for (const float opacity : {0.0042f, 0.3f, 1.0f}) {
    const Frame frame = expect_sound(test::layers_shot(opacity));
    EXPECT_NEAR(frame.at(2, 2)[3], 1, opacity == 1.0f ? 0.011 : 2e-3);
    EXPECT_NEAR(frame.at(2, 2)[1], 0.7 * double{frame.at(2, 2)[3]}, 1e-4);
  }
}

TEST(ExtremeImage, AFacadeSeenSquareKeepsItsOrder) {
  expect_sound(test::facade_shot());
  expect_sound(test::turned_facade_shot());
}

TEST(ExtremeImage, TheNearPlane) {
  EXPECT_EQ(expect_sound(test::near_plane_shot(false)).stats.splats, 0u);
  ExtremeShot shot = test::near_plane_shot(true);
  const Frame frame = expect_sound(shot);
  EXPECT_EQ(frame.stats.splats, 1u);
  EXPECT_GT(frame.at(9, 9)[1], 0.4f);
  shot.input.eyes[0].camera.near_z = 1e-4;
  EXPECT_GT(expect_sound(shot).at(9, 9)[0], 0.9f);
}

TEST(ExtremeImage, ScalesFromANanometreToAThousandKilometres) {
  expect_sound(test::scales_shot());
}

TEST(ExtremeImage, NeedlesOfAThousandKilometresAtArmsLength) {
  for (const float length : test::kNeedleLengths) expect_sound(test::needles_shot(length));
}

TEST(ExtremeImage, ScalesNeedlesAndOpacitiesAntialiased) {
  for (const NativeScale& native : test::kExtremeNatives) {
    SCOPED_TRACE(native.pixel);
    expect_sound(test::scales_shot(native));
    for (const float length : test::kNeedleLengths)
      expect_sound(test::needles_shot(length, native));
    for (const float opacity : test::kOpacities) expect_sound(test::opacity_shot(opacity, native));
  }
}

TEST(ExtremeImage, OpacitiesFromNothingToMerged) {
  for (const float opacity : test::kOpacities) {
    SCOPED_TRACE(opacity);
    const ExtremeShot shot = test::opacity_shot(opacity);
    const Frame frame = expect_sound(shot);
    const float expected = opacity < kAlphaThreshold ? 0.0f : std::min(opacity, 0.99f);
    EXPECT_NEAR(frame.at(32, 32)[3], expected, 1e-6f);
    // Merged: the support is as wide as o says, and the table knows it.
    for (const uint32_t m : {32u, 4096u}) {
      const auto cpu = create_cpu_backend();
      const Frame lut =
          render(*cpu, shot.scene, {.exponential = Exponential::lut, .lut_size = m}, shot.input);
      for (size_t i = 3; i < lut.rgba.size(); i += 4)
        ASSERT_NEAR(lut.rgba[i], frame.rgba[i], m == 32 ? 0.087 : 1e-3);
    }
  }
}

TEST(ExtremeImage, ColoursBeyondBinary32AndBelowZero) {
  for (const ExtremeShot& shot : test::wild_colour_shots()) expect_sound(shot);
  const Frame frame = expect_sound(test::negative_colour_shot());
  EXPECT_EQ(frame.at(8, 8)[0], 0.0f);
  EXPECT_EQ(frame.at(8, 8)[2], 0.0f);
  EXPECT_GT(frame.at(8, 8)[1], 0.4f);
}

// Earth-centred coordinates: as near the same scene at the origin as its means
// in scene-local binary32 are.
TEST(ExtremeImage, EarthCentredWithMillimetreSteps) {
  const GaussianCloud cloud = test::random_cloud(1500, 8, 1);
  const auto here = test::flat_scene(cloud);
  const auto there = test::earth_centred_scene(cloud);
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  for (int step = 0; step < 5; ++step) {
    const Vec3d eye{0.001 * step, -1, -14}, target{0.001 * step, 0, 0};
    const FrameInput at_origin = frame_input(look(eye, target, 80, 60));
    FrameInput far = at_origin;
    far.eyes[0].camera.eye = far.eyes[0].camera.eye + there->origin;
    const Frame a = render(*cpu, here, {}, at_origin), b = render(*cpu, there, {}, far);
    EXPECT_GT(compare(a, b).psnr, 70);
    EXPECT_LE(compare(a, b).rough, 2u);
    EXPECT_GT(compare(b, render(*reference, there, {}, far)).psnr, 60);
  }
}

TEST(ExtremeImage, DegenerateCloudsAtEveryLevelOfDetail) {
  for (const ExtremeShot& shot : test::degenerate_shots()) expect_sound(shot);
}

TEST(ExtremeImage, CamerasAtTheEndOfTheWorld) {
  const std::vector<ExtremeShot> shots = test::far_camera_shots();
  for (const ExtremeShot& shot : shots) EXPECT_EQ(expect_sound(shot).cut.size(), 1u);
  const auto cpu = create_cpu_backend();
  for (const double beyond : {1e18, -1e18, 1e300, static_cast<double>(kInfinity), std::nan("")}) {
    FrameInput input = frame_input(look({0, 0, -5}, {0, 0, 0}, 8, 8));
    input.eyes[0].camera.eye.y = beyond;
    EXPECT_THROW(render(*cpu, shots[0].scene, {}, input), Error);
  }
}

}  // namespace
}  // namespace voyager::extreme_image_test
