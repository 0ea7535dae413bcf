// METHOD §10: sizes, cameras and Gaussians at the edge, on both backends.
#include <algorithm>
#include <limits>

#include "runtime/base/error.h"
#include "runtime/math/alpha.h"
#include "tests/support/render_scene.h"
#include "tests/support/tree_clouds.h"

namespace voyager {
namespace {

using test::add_gaussian;
using test::compare;
using test::Frame;
using test::frame_input;
using test::look;
using test::render;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// CPU and reference draw it alike, with the filter and without, and no NaN.
// Returns the CPU's frame. rough: pixels that may lie on a threshold's other side.
Frame expect_sound(const std::shared_ptr<const Scene>& scene, const FrameInput& input,
                   size_t rough = 0, double limit = 2.0 / 255) {
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  const Frame on = render(*cpu, scene, {}, input);
  test::expect_no_nan(on);
  test::expect_same_bits(on, render(*cpu, scene, {.alpha_filter = false}, input));
  const Frame ex2 = render(*cpu, scene, {.exponential = Exponential::ex2}, input);
  test::expect_no_nan(ex2);
  test::expect_same_bits(
      ex2, render(*cpu, scene, {.alpha_filter = false, .exponential = Exponential::ex2}, input));
  const Frame truth = render(*reference, scene, {}, input);
  test::expect_no_nan(truth);
  test::expect_same_bits(truth, render(*reference, scene, {.alpha_filter = false}, input));
  EXPECT_LE(compare(on, truth, limit).rough, rough)
      << "largest " << compare(on, truth, limit).largest;
  return on;
}

TEST(ExtremeImage, Sizes) {
  const auto scene = test::baked_scene(test::random_cloud(800, 1, 1));
  for (const auto& size :
       {std::pair(1u, 1u), {17u, 5u}, {15u, 33u}, {16u, 16u}, {8192u, 16u}, {3u, 700u}})
    expect_sound(scene, frame_input(look({2, -3, -22}, {0, 0, 0}, size.first, size.second), 3), 1);
}

TEST(ExtremeImage, FieldsOfViewAndOffCentreFrusta) {
  const auto scene = test::baked_scene(test::random_cloud(1500, 2, 1));
  for (const double fov : {1.0, 20.0, 120.0, 170.0})
    expect_sound(scene, frame_input(look({0, 0, -15}, {0, 0, 0}, 80, 60, fov), 2), 2);
  for (const double centre : {-50.0, 0.0, 130.0}) {
    Camera camera = look({1, 0, -12}, {0, 0, 0}, 80, 60);
    camera.cx = centre, camera.cy = 60 - centre, camera.fy *= 1.3;
    expect_sound(scene, frame_input(camera, 2), 2);
  }
}

TEST(ExtremeImage, AnEmptySceneIsTransparentBlackOverTheBackground) {
  for (const auto& scene :
       {std::shared_ptr<const Scene>(test::empty_scene()), test::baked_scene(GaussianCloud())}) {
    FrameInput input = frame_input(look({0, 0, -3}, {0, 0, 0}, 37, 19));
    const Frame black = expect_sound(scene, input);
    for (const float v : black.rgba) ASSERT_EQ(v, 0.0f);
    for (const float z : black.depth) ASSERT_EQ(z, kInfinity);
    input.background = {0.1f, 0.2f, 0.3f};
    EXPECT_EQ(expect_sound(scene, input).at(5, 5)[2], 0.3f);
  }
}

TEST(ExtremeImage, ASingleGaussianIsItsFormula) {
  auto scene = test::empty_scene();
  add_gaussian(*scene, {0, 0, 4}, {0.2f, 0.1f, 0.1f}, 0.8f, {1, 0.5f, 0});
  const Camera camera = look({0, 0, 0}, {0, 0, 1}, 64, 48);
  const Frame frame = expect_sound(scene, frame_input(camera));
  const double xx = std::pow(camera.fx * double{0.2f} / 4, 2) + 0.3,
               yy = std::pow(camera.fx * double{0.1f} / 4, 2) + 0.3;
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
  auto scene = test::empty_scene();
  std::mt19937 random(1);
  for (int i = 0; i < 40; ++i)
    add_gaussian(*scene, {0, 0, 2.0f + static_cast<float>(random() % 1000) / 100},
                 {1e4f, 1e4f, 1e-6f}, static_cast<float>(random() % 20) / 100);
  const Frame frame = expect_sound(scene, frame_input(look({0, 0, 0}, {0, 0, 1}, 3, 3)));
  std::vector<std::pair<float, float>> layers;
  for (const Gaussian& g : scene->gaussians) layers.push_back({g.mean.z, g.opacity});
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
    auto scene = test::empty_scene();
    for (int i = 0; i < 100000; ++i)
      add_gaussian(*scene, {0, 0, 1 + 1e-4f * static_cast<float>(99999 - i)}, {1, 1, 1e-4f},
                   opacity, {0.6f, 0.7f, 0.8f});
    const Frame frame = expect_sound(scene, frame_input(look({0, 0, 0}, {0, 0, 1}, 4, 4)));
    EXPECT_NEAR(frame.at(2, 2)[3], 1, opacity == 1.0f ? 0.011 : 2e-3);
    EXPECT_NEAR(frame.at(2, 2)[1], 0.7 * double{frame.at(2, 2)[3]}, 1e-4);
  }
}

TEST(ExtremeImage, AFacadeSeenSquareKeepsItsOrder) {
  // Coplanar Gaussians with the camera's axis along the plane's normal.
  auto scene = test::empty_scene();
  std::mt19937 random(4);
  for (int i = 0; i < 3000; ++i)
    add_gaussian(*scene,
                 {static_cast<float>(random() % 1000) / 100 - 5,
                  static_cast<float>(random() % 1000) / 100 - 5, 7.3f},
                 {0.2f, 0.2f, 1e-6f}, 0.9f,
                 {static_cast<float>(random() % 2), static_cast<float>(random() % 2), 0.2f});
  expect_sound(scene, frame_input(look({0.31, 0.17, 0}, {0.31, 0.17, 1}, 96, 96)), 4);
  // Turned, so that depths differ by rounding only: the key is the same in both backends.
  auto turned = test::empty_scene();
  const Camera camera = look({0.3, 0.2, 0.1}, {3, -2, 5}, 96, 96);
  const Mat3d& w = camera.world_to_view;
  for (const Gaussian& g : scene->gaussians) {
    const Vec3d p =
        camera.eye + double{g.mean.x} * w.row[0] + double{g.mean.y} * w.row[1] + 7.3 * w.row[2];
    turned->gaussians.push_back(g);
    turned->gaussians.back().mean = {static_cast<float>(p.x), static_cast<float>(p.y),
                                     static_cast<float>(p.z)};
    turned->gaussians.back().scale = {0.2f, 0.2f, 0.2f};
  }
  turned->sh = scene->sh;
  expect_sound(turned, frame_input(camera), 4);
}

TEST(ExtremeImage, TheNearPlane) {
  auto scene = test::empty_scene();
  const float near = 0.2f;
  for (const float z : {-5.0f, -0.1f, 0.0f, near})
    add_gaussian(*scene, {0, 0, z}, {1, 1, 1}, 1, {1, 0, 0});
  FrameInput input = frame_input(look({0, 0, 0}, {0, 0, 1}, 20, 20));
  EXPECT_EQ(expect_sound(scene, input).stats.splats, 0u);
  add_gaussian(*scene, {0, 0, std::nextafter(near, 1.0f)}, {1e-3f, 1e-3f, 1e-3f}, 1, {0, 1, 0});
  const Frame frame = expect_sound(scene, input);
  EXPECT_EQ(frame.stats.splats, 1u);
  EXPECT_GT(frame.at(9, 9)[1], 0.4f);
  input.camera.near_z = 1e-4;
  EXPECT_GT(expect_sound(scene, input).at(9, 9)[0], 0.9f);
}

TEST(ExtremeImage, ScalesFromANanometreToAThousandKilometres) {
  std::mt19937 random(5);
  auto scene = test::empty_scene();
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 400; ++i) {
    const auto scale = [&] {
      return std::pow(10.0f, uniform(random) < 0 ? -9.0f + 3 * (1 + uniform(random))
                                                 : -1.5f + 1.5f * uniform(random));
    };
    add_gaussian(*scene, {5 * uniform(random), 5 * uniform(random), 6 + 5 * uniform(random)},
                 {scale(), scale(), scale()}, 0.5f + 0.5f * uniform(random),
                 {uniform(random) < 0 ? 0.1f : 0.9f, 0.4f, 0.6f},
                 {uniform(random), uniform(random), uniform(random), uniform(random)});
  }
  expect_sound(scene, frame_input(look({0, 0, 0}, {0, 0, 1}, 90, 70)), 8);
}

// Where rounding moves a needle by more than a pixel the two backends part; the
// filter still changes nothing, and nothing is NaN.
TEST(ExtremeImage, NeedlesOfAThousandKilometresAtArmsLength) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (const float length : {1e3f, 1e6f, 1e12f, 1e18f}) {
    SCOPED_TRACE(length);
    auto scene = test::empty_scene();
    for (int i = 0; i < 100; ++i)
      add_gaussian(*scene, {uniform(random), uniform(random), 1 + uniform(random)},
                   {length, i % 2 ? length : 1e-9f, 1e-9f}, 0.3f, {0.2f, 0.7f, 0.6f},
                   {uniform(random), uniform(random), uniform(random), uniform(random)});
    expect_sound(scene, frame_input(look({0, 0, 0}, {0, 0, 1}, 50, 40)), SIZE_MAX);
  }
}

TEST(ExtremeImage, OpacitiesFromNothingToMerged) {
  for (const float opacity : {0.0f, 1e-38f, 0.0039f, 0.5f, 1.0f, 7.0f, 1e6f, 1e30f}) {
    SCOPED_TRACE(opacity);
    auto scene = test::empty_scene();
    add_gaussian(*scene, {0, 0, 4}, {0.1f, 0.1f, 0.1f}, opacity, {1, 1, 1});
    const Frame frame = expect_sound(scene, frame_input(look({0, 0, 0}, {0, 0, 1}, 65, 65)));
    const float expected = opacity < kAlphaThreshold ? 0.0f : std::min(opacity, 0.99f);
    EXPECT_NEAR(frame.at(32, 32)[3], expected, 1e-6f);
    // Merged: the support is as wide as o says, and the table knows it.
    for (const uint32_t m : {32u, 4096u}) {
      const auto cpu = create_cpu_backend();
      const Frame lut = render(*cpu, scene, {.exponential = Exponential::lut, .lut_size = m},
                               frame_input(look({0, 0, 0}, {0, 0, 1}, 65, 65)));
      for (size_t i = 3; i < lut.rgba.size(); i += 4)
        ASSERT_NEAR(lut.rgba[i], frame.rgba[i], m == 32 ? 0.087 : 1e-3);
    }
  }
}

TEST(ExtremeImage, ColoursBeyondBinary32AndBelowZero) {
  GaussianCloud cloud = test::random_cloud(300, 7, 3);
  std::mt19937 random(7);
  for (float& c : cloud.sh) c = random() % 4 == 0 ? 3.4e38f : (random() % 2 ? -3.4e38f : c);
  const FrameInput input = frame_input(look({0, 0, -20}, {0, 0, 0}, 60, 50), 9);
  for (const auto& scene :
       {std::shared_ptr<const Scene>(test::flat_scene(cloud)), test::baked_scene(cloud)})
    expect_sound(scene, input, SIZE_MAX);
  auto negative = test::empty_scene();
  add_gaussian(*negative, {0, 0, 4}, {1, 1, 1}, 0.9f, {-5, 0.5f, -0.01f});
  const Frame frame = expect_sound(negative, frame_input(look({0, 0, 0}, {0, 0, 1}, 16, 16)));
  EXPECT_EQ(frame.at(8, 8)[0], 0.0f);
  EXPECT_EQ(frame.at(8, 8)[2], 0.0f);
  EXPECT_GT(frame.at(8, 8)[1], 0.4f);
}

// Earth-centred coordinates: as near the same scene at the origin as its means
// in scene-local binary32 are.
TEST(ExtremeImage, EarthCentredWithMillimetreSteps) {
  const GaussianCloud cloud = test::random_cloud(1500, 8, 1);
  const auto here = test::flat_scene(cloud);
  auto there = test::flat_scene(cloud);
  there->origin = {6250.0 * 1024, -3000.0 * 1024, 4000.0 * 1024};
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  for (int step = 0; step < 5; ++step) {
    const Vec3d eye{0.001 * step, -1, -14}, target{0.001 * step, 0, 0};
    const FrameInput at_origin = frame_input(look(eye, target, 80, 60));
    FrameInput far = at_origin;
    far.camera.eye = far.camera.eye + there->origin;
    const Frame a = render(*cpu, here, {}, at_origin), b = render(*cpu, there, {}, far);
    EXPECT_GT(compare(a, b).psnr, 70);
    EXPECT_LE(compare(a, b).rough, 2u);
    EXPECT_GT(compare(b, render(*reference, there, {}, far)).psnr, 60);
  }
}

// Points, lines, outliers at 9e17 m, specks, needles, invisible ones: as trees.
TEST(ExtremeImage, DegenerateCloudsAtEveryLevelOfDetail) {
  for (const test::NamedCloud& named : test::degenerate_clouds()) {
    SCOPED_TRACE(named.name);
    const auto scene = test::baked_scene(named.cloud);
    for (const double tau : {0.0, 5.0, 1e3})
      for (const Vec3d& eye : {Vec3d{3, -6, -24}, Vec3d{0.1, 0.2, -1.5}})
        expect_sound(scene, frame_input(look(eye, {0, 0, 0}, 40, 30), tau), SIZE_MAX);
  }
}

TEST(ExtremeImage, CamerasAtTheEndOfTheWorld) {
  const auto scene = test::baked_scene(test::random_cloud(500, 9, 1));
  for (const double far : {1e6, 1e12, 1e17, 9.9e17}) {
    const Frame frame =
        expect_sound(scene, frame_input(look({far, 0, -far}, {0, 0, 0}, 20, 20)), SIZE_MAX);
    EXPECT_EQ(frame.cut.size(), 1u);
  }
  const auto cpu = create_cpu_backend();
  for (const double beyond : {1e18, -1e18, 1e300, static_cast<double>(kInfinity), std::nan("")}) {
    FrameInput input = frame_input(look({0, 0, -5}, {0, 0, 0}, 8, 8));
    input.camera.eye.y = beyond;
    EXPECT_THROW(render(*cpu, scene, {}, input), Error);
  }
}

}  // namespace
}  // namespace voyager
