#pragma once
// Extensions that this runtime knows. XR_KHR_vulkan_enable2 is always offered.
#include <string>
#include <vector>

#include "api.h"

namespace test_runtime {

std::vector<std::string> optional_extensions();
XrExtensionProperties extension_properties(const std::string& name);

}  // namespace test_runtime
