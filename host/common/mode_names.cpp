#include "mode_names.h"

namespace host {

const char* backend_name(VoyBackend backend) {
  switch (backend) {
    case VOY_BACKEND_CPU:
      return "cpu";
    case VOY_BACKEND_CUDA:
      return "cuda";
    case VOY_BACKEND_REFERENCE:
      return "reference";
    default:
      return "auto";
  }
}

const char* sharing_name(VoyVulkanSharing sharing) {
  switch (sharing) {
    case VOY_VULKAN_SHARING_DEVICE:
      return "device";
    case VOY_VULKAN_SHARING_HOST:
      return "host";
    default:
      return "auto";
  }
}

const char* sync_name(VoyVulkanSync sync) {
  switch (sync) {
    case VOY_VULKAN_SYNC_TIMELINE:
      return "timeline";
    case VOY_VULKAN_SYNC_BINARY:
      return "binary";
    case VOY_VULKAN_SYNC_HOST:
      return "host";
    default:
      return "auto";
  }
}

}  // namespace host
