// Images of every size, and what a frame writes where: each format, and nothing beside it.
#include <algorithm>
#include <cmath>

#include "runtime/frame/resolve.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/guarded_image.h"
#include "tests/gpu/splat_test.h"

namespace voyager::test {
namespace splat_output_test {
namespace {

using SplatOutput = SplatTest;

TEST_F(SplatOutput, EverySizeIsAsTheCpuDrawsIt) {
  const auto scene = baked_scene(random_cloud(8000, 1, 1));
  Agreement with_cpu("sizes, CUDA against the CPU");
  const auto grown = view(scene);
  const std::pair<uint32_t, uint32_t>
      sizes[] = {{1, 1},     {17, 5},    {8192, 64}, {33, 1},     {15, 16},
                 {16, 16},   {16, 17},   {31, 32},   {1, 700},    {257, 129},
                 {16384, 2}, {2, 16384}, {641, 361}, {8192, 1024}};  // more tiles than a block of
                                                                     // bin_count takes at once
  for (const auto& [width, height] : sizes) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    Camera camera = look({2, -3, -22}, {0, 0, 0}, width, height);
    camera.fx = camera.fy = 0.6 * std::max(width, height);
    const FrameInput input = frame_input(camera, 3);
    const Frame found = draw(scene, {}, input);
    with_cpu.add(found, draw(*cpu, scene, {}, input));
    expect_same_bits(found, render(*grown, input));
  }
  with_cpu.expect();
}

constexpr ColorFormat kFormats[] = {ColorFormat::none, ColorFormat::rgba8, ColorFormat::rgba16f,
                                    ColorFormat::rgba32f};

GuardedImage render_guarded(View& view, const FrameInput& input, ColorFormat format) {
  GuardedImage image(format, input.eyes[0].camera.width, input.eyes[0].camera.height);
  view.render(input, image.image());
  return image;
}

template <class T>
std::vector<T> values(const GuardedPlane& plane) {
  const std::vector<uint8_t> bytes = plane.packed();
  std::vector<T> all(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
  return all;
}

// Backgrounds beyond what the formats hold, on both sides.
constexpr Vec3f kBackgrounds[] = {{0, 0, 0}, {0.25f, 0.5f, 2.0f}, {1e6f, -0.5f, -1e6f}};

TEST_F(SplatOutput, FormatsAreTheFloatsRounded) {
  const auto scene = flat_scene(random_cloud(4000, 2, 1));
  scene->sh[0] = 1e6f;  // a colour that binary16 has no number for
  const auto own = view(scene);
  for (FrameInput input : varied_frames())
    for (const Vec3f& background : kBackgrounds) {
      input.background = background;
      const auto exact = values<float>(render_guarded(*own, input, ColorFormat::rgba32f).color);
      const auto halves = values<uint16_t>(render_guarded(*own, input, ColorFormat::rgba16f).color);
      const auto codes = render_guarded(*own, input, ColorFormat::rgba8).color.packed();
      ASSERT_EQ(halves.size(), exact.size());
      ASSERT_EQ(codes.size(), exact.size());
      for (size_t i = 0; i < exact.size(); ++i) {
        ASSERT_EQ(halves[i], float_to_half(exact[i])) << exact[i];
        // A code may be the other one where rounding the product matters.
        const double place = 255 * std::clamp(double{exact[i]}, 0.0, 1.0) + 0.5;
        ASSERT_TRUE(codes[i] == to_code(exact[i]) || std::fabs(place - std::round(place)) < 1e-4)
            << exact[i];
        ASSERT_NEAR(codes[i] + 0.5, place, 0.5001);
      }
    }
}

TEST_F(SplatOutput, DepthIsTheSameBesideEveryFormatAndNothingElseIsWritten) {
  const auto scene = baked_scene(random_cloud(6000, 3, 1));
  const auto own = view(scene);
  for (FrameInput input : varied_frames())
    for (const uint32_t width : {input.eyes[0].camera.width, 1u, 16u, 47u}) {
      input.eyes[0].camera.width = width;
      const Frame frame = render(*own, input);
      for (const ColorFormat format : kFormats) {
        const GuardedImage image = render_guarded(*own, input, format);
        EXPECT_EQ(image.spilled(), 0u);
        EXPECT_EQ(different_bits(values<float>(image.depth), frame.depth), 0u);
      }
    }
}

TEST_F(SplatOutput, AnImageWithoutMemoryIsDrawnAndHandedToNobody) {
  const auto scene = baked_scene(random_cloud(6000, 4, 1));
  const auto own = view(scene);
  for (const FrameInput& input : varied_frames())
    for (const ColorFormat format : kFormats) {
      const Frame frame = render(*own, input);
      Image nowhere;
      nowhere.format = format;
      nowhere.width = input.eyes[0].camera.width, nowhere.height = input.eyes[0].camera.height;
      own->render(input, nowhere);
      EXPECT_EQ(own->stats().pairs_after, frame.stats.pairs_after);
      expect_same_bits(frame, render(*own, input));
    }
}

}  // namespace
}  // namespace splat_output_test
}  // namespace voyager::test
