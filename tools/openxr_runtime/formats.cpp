#include "formats.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace test_runtime {
namespace {

// The first four are offered where the script names none.
constexpr Format kFormats[] = {
    {VK_FORMAT_R8G8B8A8_SRGB, "R8G8B8A8_SRGB", 4, false},
    {VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8_UNORM", 4, false},
    {VK_FORMAT_R16G16B16A16_SFLOAT, "R16G16B16A16_SFLOAT", 8, false},
    {VK_FORMAT_D32_SFLOAT, "D32_SFLOAT", 4, true},
    {VK_FORMAT_B8G8R8A8_SRGB, "B8G8R8A8_SRGB", 4, false},
    {VK_FORMAT_B8G8R8A8_UNORM, "B8G8R8A8_UNORM", 4, false},
};

float half_to_float(uint16_t half) {
  const int exponent = half >> 10 & 31;
  const float mantissa = static_cast<float>(half & 1023);
  const float magnitude = exponent == 31  ? (mantissa == 0 ? INFINITY : NAN)
                          : exponent == 0 ? std::ldexp(mantissa, -24)
                                          : std::ldexp(1024 + mantissa, exponent - 25);
  return half & 0x8000 ? -magnitude : magnitude;
}

uint8_t encode(float linear) {
  const float v = linear > 0 ? std::min(linear, 1.0f) : 0.0f;  // NaN is 0
  const float code = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
  return static_cast<uint8_t>(std::lround(255 * code));
}

}  // namespace

std::span<const Format> all_formats() {
  return kFormats;
}

std::span<const Format> default_formats() {
  return all_formats().first(4);
}

const Format* find_format(const std::string& name) {
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const Format& format) { return name == format.name; });
  return found == std::end(kFormats) ? nullptr : found;
}

const Format* find_format(int64_t format) {
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const Format& known) { return format == known.format; });
  return found == std::end(kFormats) ? nullptr : found;
}

std::string format_names() {
  std::string names;
  for (const Format& format : kFormats)
    names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

std::array<uint8_t, 3> code_values(const Format& format, const std::byte* texel) {
  std::array<uint8_t, 3> code;
  if (format.format == VK_FORMAT_R16G16B16A16_SFLOAT) {
    uint16_t halves[3];
    std::memcpy(halves, texel, sizeof halves);
    for (size_t i = 0; i < 3; ++i) code[i] = encode(half_to_float(halves[i]));
    return code;
  }
  std::memcpy(code.data(), texel, code.size());
  if (format.format == VK_FORMAT_B8G8R8A8_SRGB || format.format == VK_FORMAT_B8G8R8A8_UNORM)
    std::swap(code[0], code[2]);
  return code;
}

}  // namespace test_runtime
