// The same frame in every colour format.
#include <algorithm>
#include <array>

#include "on_backend.h"

namespace format_test {
namespace {

constexpr uint32_t kLargestHalf = 0x7bff;  // 65504
constexpr uint16_t kPadding = 0xa5a5;

double magnitude_of(uint32_t half) {
  const int exponent = static_cast<int>(half >> 10), fraction = static_cast<int>(half & 1023);
  return exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
}

// Whether `half` is finite, and no other finite half is nearer to `value` (clamped to
// those), nor as near and even where it is odd.
bool is_rounded(uint16_t half, float value) {
  const uint32_t h = half & 0x7fff;
  if (h > kLargestHalf || (h != 0 && std::signbit(value) != (half >> 15 != 0))) return false;
  const double magnitude = std::min(std::fabs(double{value}), magnitude_of(kLargestHalf));
  const double error = std::fabs(magnitude_of(h) - magnitude);
  const auto beats = [&](uint32_t other) {
    const double others = std::fabs(magnitude_of(other) - magnitude);
    return others < error || (others == error && h % 2 == 1);
  };
  return !(h > 0 && beats(h - 1)) && !(h < kLargestHalf && beats(h + 1));
}

// Draws what the host's own target would get, in binary16, with `padding` halves after
// each row.
std::vector<uint16_t> render_half(Host& host, VoyFrame frame, size_t padding) {
  const size_t pitch = 4 * Host::kWidth + padding;
  std::vector<uint16_t> halves(pitch * Host::kHeight, kPadding);
  VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
  desc.colorFormat = VOY_COLOR_FORMAT_RGBA16F;
  desc.width = Host::kWidth;
  desc.height = Host::kHeight;
  desc.color = halves.data();
  desc.colorRowPitch = padding == 0 ? 0 : pitch * sizeof halves[0];
  VoyFrameEye eye = *frame.eyes;
  EXPECT_EQ(host.voy.CreateTarget(host.device, &desc, &eye.target), VOY_SUCCESS)
      << host.voy.message();
  frame.eyes = &eye;
  EXPECT_EQ(host.voy.RenderFrame(host.view, &frame), VOY_SUCCESS) << host.voy.message();
  EXPECT_EQ(host.voy.DestroyTarget(eye.target), VOY_SUCCESS);
  return halves;
}

class HalfFormat : public OnBackend {};
INSTANTIATE_TEST_SUITE_P(Of, HalfFormat, ::testing::ValuesIn(kEachBackend), backend_name);

TEST_P(HalfFormat, IsFloatRounded) {
  Host host(voy, device_for(GetParam()));
  const VoyFrameEye eye = host.eye();
  VoyFrame frame = Host::frame(eye);
  // Backgrounds take values beyond binary16 into the image, where splats leave room.
  for (const auto [r, g, b] : {std::array{0.25f, 0.5f, 1.0f}, std::array{1e6f, -1e6f, 65519.0f},
                               std::array{3e38f, -3e38f, 1e-7f}}) {
    frame.background[0] = r, frame.background[1] = g, frame.background[2] = b;
    ASSERT_EQ(voy.RenderFrame(host.view, &frame), VOY_SUCCESS) << voy.message();
    for (const size_t padding : {0u, 6u}) {
      const std::vector<uint16_t> halves = render_half(host, frame, padding);
      const size_t row = 4 * Host::kWidth, pitch = row + padding;
      for (size_t i = 0; i < halves.size(); ++i) {
        const size_t y = i / pitch, x = i % pitch;
        if (x < row) {
          const float value = host.pixels[y * row + x];
          ASSERT_TRUE(is_rounded(halves[i], value)) << value << " as " << halves[i];
        } else {
          ASSERT_EQ(halves[i], kPadding) << "wrote beyond the width";
        }
      }
    }
  }
  EXPECT_EQ(std::count(host.pixels.begin(), host.pixels.end(), -1.0f), 0);
}

TEST(Format, CapabilitiesListTheFormatsThatTargetsTake) {
  const Library voy;
  Host host(voy);
  VoyCapabilities found = VOY_CAPABILITIES_INIT;
  ASSERT_EQ(voy.GetCapabilities(host.device, &found), VOY_SUCCESS);
  for (const VoyColorFormat format : {VOY_COLOR_FORMAT_NONE, VOY_COLOR_FORMAT_RGBA8_UNORM,
                                      VOY_COLOR_FORMAT_RGBA32F, VOY_COLOR_FORMAT_RGBA16F}) {
    VoyTargetDesc desc = host.target_desc();
    desc.colorFormat = format;
    if (format == VOY_COLOR_FORMAT_NONE) desc.color = nullptr;
    VoyTarget target = nullptr;
    EXPECT_EQ(voy.CreateTarget(host.device, &desc, &target) == VOY_SUCCESS,
              (found.colorFormats >> format & 1) != 0)
        << format << voy.message();
    EXPECT_EQ(voy.DestroyTarget(target), VOY_SUCCESS);
  }
}

}  // namespace
}  // namespace format_test
