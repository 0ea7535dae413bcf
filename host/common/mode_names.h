#pragma once
// The modes of voyager_vulkan.h, as messages have them.
#include <voyager/voyager_vulkan.h>

namespace host {

const char* backend_name(VoyBackend backend);
const char* sharing_name(VoyVulkanSharing sharing);
const char* sync_name(VoyVulkanSync sync);

}  // namespace host
