// The CPU against the float64 reference, with a limit a pixel.
#include "tests/support/depth_limits.h"

namespace voyager::depth_limit_test {
namespace {

using test::Frame;
using test::frame_input;
using test::LimitImage;
using test::look;
using test::render;

// A limit is a binary32 number that both compare with one binary32 depth: it falls to the
// same side in both. What is left are the thresholds that they have without limits.
TEST(DepthLimitParity, CpuAgreesWithTheReference) {
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  size_t rough = 0, depths = 0, pixels = 0;
  double least = INFINITY;
  for (const uint32_t seed : {1u, 2u}) {
    const auto scene = test::baked_scene(test::random_cloud(4000, seed, 3));
    for (const double tau : {0.0, 3.0, 12.0})
      for (const Vec3d& eye : {Vec3d{3, -6, -24}, {1, 1, 1}}) {
        FrameInput input = frame_input(look(eye, {0.1, 0.2, 5}, 160, 100), tau);
        const LimitImage limits =
            test::random_limits(input, render(*reference, scene, {}, input), seed);
        input.eyes[0].limits = limits.limits();
        const Frame a = render(*cpu, scene, {}, input), b = render(*reference, scene, {}, input);
        const test::Difference d = compare(a, b);
        EXPECT_GE(d.psnr, 60) << tau;
        least = std::min(least, d.psnr);
        rough += d.rough;
        for (size_t i = 0; i < a.depth.size(); ++i) depths += a.depth[i] != b.depth[i];
        pixels += a.depth.size();
      }
  }
  EXPECT_LE(rough, pixels / 2000);
  EXPECT_LE(depths, pixels / 2000);
  RecordProperty("least_psnr", std::to_string(least));
  RecordProperty("rough_pixels", std::to_string(rough) + " of " + std::to_string(pixels));
}

// The same geometry in every encoding; one backend turns it into the same metres as another.
TEST(DepthLimitParity, EncodingsAgree) {
  const auto cpu = create_cpu_backend(), reference = create_reference_backend();
  const auto scene = test::baked_scene(test::random_cloud(4000, 3, 1));
  FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, 160, 100), 3);
  for (const DepthForm form : {DepthForm::standard, DepthForm::reversed})
    for (const double far : {1000.0, double{INFINITY}}) {
      const DepthEncoding encoding = depth_encoding(form, 0.1, far);
      LimitImage raw(input.eyes[0].camera, 0), metres(input.eyes[0].camera, 0);
      std::mt19937 random(7);
      for (size_t y = 0; y < input.eyes[0].camera.height; ++y)
        for (size_t x = 0; x < input.eyes[0].camera.width; ++x) {
          const double z = 10 + static_cast<double>(random() % 30000) * 1e-3;
          const double t = (1 / z - 1 / far) / (1 / 0.1 - 1 / far);
          raw.at(x, y) = static_cast<float>(form == DepthForm::reversed ? t : 1 - t);
          if (random() % 8 == 0) raw.at(x, y) = form == DepthForm::reversed ? 0.0f : 1.0f;
          metres.at(x, y) = depth_limit(encoding, raw.at(x, y));
        }
      for (Backend* backend : {cpu.get(), reference.get()}) {
        input.eyes[0].limits = raw.limits(encoding);
        const Frame found = render(*backend, scene, {}, input);
        input.eyes[0].limits = metres.limits();
        test::expect_same_bits(found, render(*backend, scene, {}, input));
      }
    }
}

}  // namespace
}  // namespace voyager::depth_limit_test
