// The estimate of METHOD §12's native pixel where the cameras are known: the synthetic city is made
// as if it had been trained from its own.
#include "runtime/scene/append.h"
#include "runtime/scene/native_pixel.h"
#include "runtime/scene/scale_histogram.h"
#include "tests/support/test_support.h"
#include "tests/support/training_camera_files.h"
#include "tools/synth/city.h"
#include "tools/training_cameras.h"

namespace voyager::native_pixel_estimate_test {
namespace {

GaussianCloud city(const synth::CityDesc& desc) {
  GaussianCloud all;
  all.sh_degree = desc.sh_degree;
  synth::generate_city(
      desc, [&](const GaussianCloud& part) { append(all, GaussianCloud(part), "city"); });
  return all;
}

std::vector<TrainingCamera> cameras_of(const synth::CityDesc& desc) {
  const test::TempFolder folder;
  test::write_file(folder.file("cameras.json"), synth::city_cameras_json(desc));
  return tools::read_training_cameras(folder.file("cameras.json"));
}

// VoyNativePixelSource says so.
TEST(NativePixelEstimate, IsWithinAFactorOfThreeOfWhatTheCamerasSaw) {
  for (const uint64_t gaussians : {10000u, 20000u, 40000u, 100000u})
    for (const uint64_t seed : {1u, 2u}) {
      SCOPED_TRACE(std::to_string(gaussians) + ", seed " + std::to_string(seed));
      const synth::CityDesc desc{gaussians, seed, 0};
      const GaussianCloud cloud = city(desc);
      const NativePixel known = native_pixel(cameras_of(desc), cloud);
      ASSERT_GT(known.seen, 1000u);
      const double ratio = estimated_scale(cloud).pixel / known.median;
      EXPECT_GT(ratio, 1.0 / 3);
      EXPECT_LT(ratio, 3.0);
      // Where Gaussians are few they are larger than pixels; more of them come down to the pixel.
      if (gaussians >= 100000) {
        EXPECT_LT(ratio, 1.3);
      }
    }
}

}  // namespace
}  // namespace voyager::native_pixel_estimate_test
