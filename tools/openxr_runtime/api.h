#pragma once
// OpenXR with Vulkan, as every file here includes it. The library defines OpenXR's functions
// under their own names; hidden, they are reached through xrGetInstanceProcAddr only.
#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#define XR_USE_GRAPHICS_API_VULKAN
#define XR_EXTENSION_PROTOTYPES
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <string>

namespace test_runtime {

std::string name_of(XrResult result);
std::string name_of(XrStructureType type);
std::string name_of(XrSessionState state);

}  // namespace test_runtime
