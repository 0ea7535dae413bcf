#include "extensions.h"

#include <cstdint>
#include <cstring>
#include <map>

namespace test_runtime {

std::vector<std::string> optional_extensions() {
  return {XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME, XR_KHR_VISIBILITY_MASK_EXTENSION_NAME,
          XR_VARJO_QUAD_VIEWS_EXTENSION_NAME};
}

XrExtensionProperties extension_properties(const std::string& name) {
  XrExtensionProperties properties = {XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, 0};
  name.copy(properties.extensionName, XR_MAX_EXTENSION_NAME_SIZE - 1);
  static const std::map<std::string, uint32_t> versions = {
      {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME, XR_KHR_vulkan_enable2_SPEC_VERSION},
      {XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME, XR_KHR_composition_layer_depth_SPEC_VERSION},
      {XR_KHR_VISIBILITY_MASK_EXTENSION_NAME, XR_KHR_visibility_mask_SPEC_VERSION},
      {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, XR_VARJO_quad_views_SPEC_VERSION}};
  properties.extensionVersion = versions.at(name);
  return properties;
}

}  // namespace test_runtime
