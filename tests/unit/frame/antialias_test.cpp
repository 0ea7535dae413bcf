// METHOD §12: a scene looks the same from any distance, in every backend.
#include "tests/support/render_scene.h"
#include "tools/supersample.h"

namespace voyager::antialias_test {
namespace {

using test::frame_input;
using test::look;
using test::render;

double psnr(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = double{a[i]} - double{b[i]};
    sum += d * d;
  }
  return -10 * std::log10(sum / static_cast<double>(a.size()));
}

// Alpha over all pixels of one small Gaussian, times the square of its distance: the mean over
// where in a pixel it is.
double covered(Backend& backend, Antialias antialias, double distance) {
  auto scene = test::empty_scene();
  test::add_gaussian(*scene, {0, 0, 0}, {0.02f, 0.02f, 0.02f}, 0.9f);
  scene->native = {NativeSource::given, 0.02, kPixelVariance};
  constexpr int kPlaces = 4;
  double sum = 0;
  for (int place = 0; place < kPlaces * kPlaces; ++place) {
    auto input = frame_input(look({0, 0, -distance}, {0, 0, 0}, 65, 65));
    input.eyes[0].camera.cx += static_cast<double>(place % kPlaces) / kPlaces;
    input.eyes[0].camera.cy += static_cast<double>(place / kPlaces) / kPlaces;
    const test::Frame frame =
        render(backend, scene, {.lod = Lod::all_leaves, .antialias = antialias}, input);
    for (size_t i = 3; i < frame.rgba.size(); i += 4) sum += double{frame.rgba[i]};
  }
  return sum / (kPlaces * kPlaces) * distance * distance;
}

TEST(Antialias, WhatIsBelowAPixelKeepsItsSum) {
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  for (Backend* backend : {cpu.get(), reference.get()}) {
    const double near = covered(*backend, Antialias::truth, 0.5);
    EXPECT_NEAR(covered(*backend, Antialias::truth, 2), near, 0.02 * near);
    EXPECT_NEAR(covered(*backend, Antialias::truth, 4), near, 0.03 * near);
    // 3DGS's swells.
    EXPECT_GT(covered(*backend, Antialias::off, 4), 3 * near);
  }
}

TEST(Antialias, APictureFromAfarIsNearTheMeanOfFinerOnes) {
  const auto scene = test::baked_scene(test::random_cloud(4000, 11, 1));
  const auto cpu = create_cpu_backend();
  constexpr uint32_t kSide = 48, kSamples = 8;
  const auto eye = Vec3d{30, -60, -220};
  const test::Frame fine =
      render(*cpu, scene, {.lod = Lod::all_leaves, .antialias = Antialias::truth},
             frame_input(look(eye, {0, 0, 0}, kSamples * kSide, kSamples * kSide, 12)));
  const std::vector<float> truth = tools::mean_of_samples(fine.rgba, kSide, kSide, kSamples);
  const auto of = [&](Antialias antialias) {
    return psnr(render(*cpu, scene, {.lod = Lod::all_leaves, .antialias = antialias},
                       frame_input(look(eye, {0, 0, 0}, kSide, kSide, 12)))
                    .rgba,
                truth);
  };
  const double on = of(Antialias::on), off = of(Antialias::off);
  RecordProperty("on_db", std::to_string(on));
  RecordProperty("off_db", std::to_string(off));
  EXPECT_GT(on, 30);
  EXPECT_GT(on, off + 6);
}

// A file of an older version does not say at what size its scene was seen.
TEST(Antialias, WhereNobodyKnowsTheNativePixelThePictureIs3dgs) {
  auto scene = test::flat_scene(test::random_cloud(500, 3, 0));
  scene->native = {};
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  const auto input = frame_input(look({3, -6, -24}, {0, 0, 0}, 61, 40));
  for (Backend* backend : {cpu.get(), reference.get()})
    test::expect_same_bits(
        render(*backend, scene, {.lod = Lod::all_leaves}, input),
        render(*backend, scene, {.lod = Lod::all_leaves, .antialias = Antialias::off}, input));
}

TEST(Antialias, TheTruthRefusesExponentialsThatDoNotReachIt) {
  const auto scene = test::flat_scene(test::random_cloud(5, 3, 0));
  const auto input = frame_input(look({3, -6, -24}, {0, 0, 0}, 16, 16));
  const auto cpu = create_cpu_backend();
  EXPECT_THROW(
      render(
          *cpu, scene,
          {.lod = Lod::all_leaves, .exponential = Exponential::lut, .antialias = Antialias::truth},
          input),
      Error);
}

// Footprints and filters that no training has, and opacities above 1.
TEST(Antialias, ExtremeScalesGiveFiniteCloseImages) {
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  const auto input = frame_input(look({0, 0, -5}, {0, 0, 0}, 48, 48));
  for (const double pixel : {0.0, 1e-6, 0.05, 1e3, kMaxNativePixel})
    for (const double low_pass : {0.0, kPixelVariance, kMaxLowPass}) {
      auto scene = test::empty_scene();
      test::add_gaussian(*scene, {0, 0, 0}, {1e-9f, 1e-9f, 1e-9f}, 0.9f);
      test::add_gaussian(*scene, {1, 0, 0}, {1.0f, 1e-9f, 1e-9f}, 0.9f, {0.9f, 0.1f, 0.1f});
      test::add_gaussian(*scene, {0, 1, 0}, {1.0f, 1e-9f, 1.0f}, 0.9f, {0.1f, 0.9f, 0.1f});
      test::add_gaussian(*scene, {0, -1, 1}, {0.2f, 0.3f, 0.1f}, 3.0f, {0.1f, 0.1f, 0.9f});
      scene->native = {NativeSource::given, pixel, low_pass};
      const test::Frame found = render(*cpu, scene, {.lod = Lod::all_leaves}, input),
                        exact = render(*reference, scene, {.lod = Lod::all_leaves}, input);
      test::expect_no_nan(found);
      EXPECT_GT(psnr(found.rgba, exact.rgba), 80) << pixel << ' ' << low_pass;
    }
}

}  // namespace
}  // namespace voyager::antialias_test
