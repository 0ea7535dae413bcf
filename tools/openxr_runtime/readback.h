#pragma once
// What a swapchain's most recently released image holds. On the application's queue, inside
// xrEndFrame; the image is left as it was found.
#include <vector>

#include "device.h"

namespace test_runtime {

// Code values, rows of RGB from the top.
std::vector<uint8_t> read_colour(const Device& device, const XrSwapchainSubImage& sub);
// View-space z in metres, rows from the top.
std::vector<float> read_depth(const Device& device, const XrCompositionLayerDepthInfoKHR& info,
                              XrExtent2Di& extent);

}  // namespace test_runtime
