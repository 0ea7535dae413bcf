// Depth limits on the device.
#include "runtime/base/error.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/depth_limits.h"

namespace voyager::test {
namespace splat_limit_test {
namespace {

class SplatLimit : public SplatTest {
 protected:
  // One that interpolates and one that does not: kernels of their own.
  std::vector<std::shared_ptr<const Scene>> scenes(size_t count, uint32_t seed) {
    const GaussianCloud cloud = random_cloud(count, seed, 2);
    return {baked_scene(cloud), flat_scene(cloud)};
  }
  // Random ones, that take the depths of the scene's splats into account.
  LimitImage limits_of(const std::shared_ptr<const Scene>& scene, const FrameInput& input,
                       uint32_t seed) {
    return random_limits(input, draw(*cpu, scene, {}, input), seed);
  }
};

// A limit falls to the same side of a splat on every backend: what is left are the
// thresholds that they have without limits.
TEST_F(SplatLimit, IsAsTheCpuAndTheReferenceDrawIt) {
  Agreement with_cpu("limits, CUDA against the CPU"),
      with_reference("limits, CUDA against the reference");
  for (const auto& scene : scenes(6000, 1))
    for (const FrameInput& input : varied_frames()) {
      const LimitImage limits = limits_of(scene, input, 1);
      const FrameInput with = limited(input, limits);
      const Frame on_cpu = draw(*cpu, scene, {}, with),
                  on_reference = draw(*reference, scene, {}, with);
      for (const Exponential e : {Exponential::exact, Exponential::ex2}) {
        const Frame found = draw(scene, {.exponential = e}, with);
        with_cpu.add(found, on_cpu);
        with_reference.add(found, on_reference);
      }
    }
  with_cpu.expect();
  with_reference.expect();
}

TEST_F(SplatLimit, TheFilterChangesNoBitWithAnyExponential) {
  for (const auto& scene : scenes(6000, 2))
    for (const FrameInput& input : varied_frames()) {
      const LimitImage limits = limits_of(scene, input, 2);
      const FrameInput with = limited(input, limits);
      for (NamedDesc named : all_exponentials(std::array{8u, 32u})) {
        SCOPED_TRACE(named.name + ", tau " + std::to_string(input.tau));
        const Frame on = draw(scene, named.desc, with);
        expect_no_nan(on);
        named.desc.alpha_filter = false;
        expect_same_bits(on, draw(scene, named.desc, with));
      }
    }
}

TEST_F(SplatLimit, InfinityAndNanAreNoneWithAnyExponential) {
  for (const auto& scene : scenes(6000, 3))
    for (FrameInput input : varied_frames())
      for (NamedDesc named : all_exponentials(std::array{32u}))
        for (const bool filter : {true, false}) {
          SCOPED_TRACE(named.name + ", filter " + std::to_string(filter));
          named.desc.alpha_filter = filter;
          input.eyes[0].depth_wanted = filter;
          const Frame without = draw(scene, named.desc, input);
          for (const float none : {INFINITY, NAN}) {
            const LimitImage limits(input.eyes[0].camera, none);
            expect_same_bits(without, draw(scene, named.desc, limited(input, limits)));
          }
        }
}

// A pixel's splats are the first of those it has without a limit.
TEST_F(SplatLimit, EndsPixelsAndChangesNothingBefore) {
  for (const auto& scene : scenes(6000, 4))
    for (const FrameInput& input : varied_frames())
      for (const NamedDesc& named : all_exponentials(std::array{32u})) {
        SCOPED_TRACE(named.name + ", tau " + std::to_string(input.tau));
        const Frame whole = draw(scene, named.desc, input);
        LimitImage limits = random_limits(input, whole, 4);
        const Frame frame = draw(scene, named.desc, limited(input, limits));
        for (size_t i = 0; i < whole.depth.size(); ++i) {
          const float limit = limits.at(i % frame.width, i / frame.width);
          const bool reached = std::isnan(limit) || whole.depth[i] <= limit;
          ASSERT_LE(frame.rgba[4 * i + 3], whole.rgba[4 * i + 3]);
          ASSERT_EQ(frame.depth[i], reached ? whole.depth[i] : INFINITY) << limit;
        }
        const LimitImage nothing(input.eyes[0].camera, 0.0f);
        const Frame hidden = draw(scene, named.desc, limited(input, nothing));
        for (const float value : hidden.rgba) ASSERT_EQ(value, 0.0f);
        for (const float z : hidden.depth) ASSERT_EQ(z, INFINITY);
      }
}

// The device turns values into the same metres as the host, to the bit.
TEST_F(SplatLimit, EncodingsAreDecodedAsOnTheHost) {
  const auto scene = scenes(6000, 5)[0];
  for (FrameInput input : varied_frames())
    for (const DepthForm form : {DepthForm::standard, DepthForm::reversed})
      for (const double far : {100.0, double{INFINITY}}) {
        const DepthEncoding encoding = depth_encoding(form, 0.1, far);
        LimitImage raw(input.eyes[0].camera, 0), metres(input.eyes[0].camera, 0);
        std::mt19937 random(5);
        for (size_t y = 0; y < input.eyes[0].camera.height; ++y)
          for (size_t x = 0; x < input.eyes[0].camera.width; ++x) {
            const float d = static_cast<float>(random() % 4096) / 4096 * 0.02f;
            raw.at(x, y) = form == DepthForm::reversed ? d : 1 - d;
            if (random() % 16 == 0) raw.at(x, y) = static_cast<float>(random() % 8) - 3;
            metres.at(x, y) = depth_limit(encoding, raw.at(x, y));
          }
        input.eyes[0].limits = raw.limits(encoding);
        const Frame found = draw(scene, {}, input);
        input.eyes[0].limits = metres.limits();
        expect_same_bits(found, draw(scene, {}, input));
      }
}

// One view, frames with and without limits of growing and shrinking sizes; the first of
// them finds too little room and is drawn again.
TEST_F(SplatLimit, IsOfOneFrameWhateverWasDrawnBefore) {
  const std::shared_ptr<const Scene> scene = flat_scene(random_cloud(share_of(400000), 6, 0));
  const auto own = view(scene);
  size_t hidden = 0;
  for (const uint32_t width : {640u, 161u, 1283u, 33u})
    for (const bool with_limits : {true, false, true}) {
      FrameInput input = frame_input(look({3, -6, -24}, {0, 0, 0}, width, width / 2));
      const Frame without = draw(scene, {}, input);
      const LimitImage limits(input.eyes[0].camera, 18);
      if (with_limits) input.eyes[0].limits = limits.limits();
      const Frame found = render(*own, input);
      EXPECT_EQ(found.stats.pairs_dropped, 0u);
      expect_same_bits(found, draw(scene, {}, input));
      hidden += different_bits(found.rgba, without.rgba);
      if (!with_limits) expect_same_bits(found, without);
    }
  EXPECT_GT(hidden, 0u);
}

TEST_F(SplatLimit, MeasurementsOfFramesWithoutLimitsRefuseThem) {
  const auto scene = scenes(500, 7)[0];
  const FrameInput input = varied_frames()[1];
  const LimitImage limits(input.eyes[0].camera, 20);
  for (const PipelineDesc& desc :
       {PipelineDesc{.splatting = Splatting::baseline_3dgs}, PipelineDesc{.count_pixels = true}}) {
    const auto own = view(scene, desc);
    const Frame before = render(*own, input);
    try {
      render(*own, limited(input, limits));
      ADD_FAILURE() << "drawn";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::unsupported);
      EXPECT_NE(std::string(error.what()).find("depth limits"), std::string::npos);
    }
    expect_same_bits(before, render(*own, input));
  }
}

}  // namespace
}  // namespace splat_limit_test
}  // namespace voyager::test
