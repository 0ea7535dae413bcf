// METHOD §8 on the device: what each exponential costs in quality.
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"

namespace voyager::test {
namespace splat_exponential_test {
namespace {

constexpr uint32_t kLutSizes[] = {8, 16, 32, 64, 128, 1000, 4096};

class SplatExponential : public SplatTest {
 protected:
  std::shared_ptr<const Scene> scene = baked_scene(random_cloud(20000, 3, 1));
};

TEST_F(SplatExponential, Ex2IsAsGoodAsExact) {
  Agreement with_exact("ex2 against exact"), with_reference("ex2 against the reference");
  for (const FrameInput& input : varied_frames()) {
    const Frame found = draw(scene, {.exponential = Exponential::ex2}, input);
    with_exact.add(found, draw(scene, {}, input));
    with_reference.add(found, draw(*reference, scene, {}, input));
  }
  with_exact.expect();
  with_reference.expect();
}

// Three digits all along: what it saves in time it costs here.
TEST_F(SplatExponential, Half2IsWithinItsThreeDigits) {
  double least = INFINITY, largest = 0;
  for (const FrameInput& input : varied_frames()) {
    const Frame found = draw(scene, {.exponential = Exponential::half2}, input);
    expect_no_nan(found);
    const Difference d = compare(found, draw(scene, {}, input));
    least = std::min(least, d.psnr);
    largest = std::max(largest, d.largest);
    EXPECT_GE(d.psnr, 45);
  }
  std::printf("half2 against exact: least %.1f dB, largest %.2f/255\n", least, 255 * largest);
}

// Where log α lies between two entries, rounding decides: with few entries that shows in
// a pixel, with many in no eye.
TEST_F(SplatExponential, TheLutIsTheCpusLut) {
  for (const uint32_t m : kLutSizes) {
    const PipelineDesc desc{.exponential = Exponential::lut, .lut_size = m};
    size_t rough = 0, depths = 0, pixels = 0;
    for (const FrameInput& input : varied_frames()) {
      const Frame found = draw(scene, desc, input), expected = draw(*cpu, scene, desc, input);
      expect_no_nan(found);
      const Difference d = compare(found, expected);
      EXPECT_GE(d.psnr, 50) << m;
      rough += d.rough;
      for (size_t i = 0; i < found.depth.size(); ++i) depths += found.depth[i] != expected.depth[i];
      pixels += found.depth.size();
    }
    std::printf("lut of %u: %zu of %zu pixels beyond 2/255, depth of %zu\n", m, rough, pixels,
                depths);
    EXPECT_LE(rough, pixels / 200) << m;
    EXPECT_LE(depths, pixels / 200) << m;
  }
}

TEST_F(SplatExponential, TheLutsErrorFallsAsItGrows) {
  for (const FrameInput& input : varied_frames()) {
    const Frame truth = draw(*reference, scene, {}, input);
    double last = 0;
    for (const uint32_t m : {8u, 16u, 32u, 64u, 128u, 4096u}) {
      const double psnr =
          compare(draw(scene, {.exponential = Exponential::lut, .lut_size = m}, input), truth).psnr;
      EXPECT_GT(psnr, last + 3) << m;
      last = psnr;
    }
    EXPECT_GE(last, 60);
  }
}

}  // namespace
}  // namespace splat_exponential_test
}  // namespace voyager::test
