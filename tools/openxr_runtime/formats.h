#pragma once
// Formats of swapchain images, and how a texel becomes a picture's.
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "api.h"

namespace test_runtime {

struct Format {
  VkFormat format;
  const char* name;  // in the script
  uint32_t texel;    // bytes
  bool depth;
};

std::span<const Format> all_formats();
std::span<const Format> default_formats();
const Format* find_format(const std::string& name);
const Format* find_format(int64_t format);
std::string format_names();

// 8-bit code values, red first: what an 8-bit image holds, undecoded; linear binary16 is
// sRGB-encoded, as a display would get it.
std::array<uint8_t, 3> code_values(const Format& format, const std::byte* texel);

}  // namespace test_runtime
