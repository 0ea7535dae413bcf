#include "functions.h"

#include <cstring>

#include "instance.h"

using namespace test_runtime;

namespace {

struct Function {
  const char* name;
  PFN_xrVoidFunction address;
  const char* extension;  // nullptr: of the core
};

template <class Address>
PFN_xrVoidFunction plain(Address address) {
  return reinterpret_cast<PFN_xrVoidFunction>(address);
}

#define TEST_RUNTIME_CORE(name) \
  { #name, plain(&(name)), nullptr }
#define TEST_RUNTIME_EXTENSION(name, extension) \
  { #name, plain(&(name)), extension }

const Function kFunctions[] = {
    TEST_RUNTIME_CORE(xrGetInstanceProcAddr),
    TEST_RUNTIME_CORE(xrEnumerateApiLayerProperties),
    TEST_RUNTIME_CORE(xrEnumerateInstanceExtensionProperties),
    TEST_RUNTIME_CORE(xrCreateInstance),
    TEST_RUNTIME_CORE(xrDestroyInstance),
    TEST_RUNTIME_CORE(xrGetInstanceProperties),
    TEST_RUNTIME_CORE(xrPollEvent),
    TEST_RUNTIME_CORE(xrResultToString),
    TEST_RUNTIME_CORE(xrStructureTypeToString),
    TEST_RUNTIME_CORE(xrGetSystem),
    TEST_RUNTIME_CORE(xrGetSystemProperties),
    TEST_RUNTIME_CORE(xrEnumerateEnvironmentBlendModes),
    TEST_RUNTIME_CORE(xrCreateSession),
    TEST_RUNTIME_CORE(xrDestroySession),
    TEST_RUNTIME_CORE(xrEnumerateReferenceSpaces),
    TEST_RUNTIME_CORE(xrCreateReferenceSpace),
    TEST_RUNTIME_CORE(xrGetReferenceSpaceBoundsRect),
    TEST_RUNTIME_CORE(xrCreateActionSpace),
    TEST_RUNTIME_CORE(xrLocateSpace),
    TEST_RUNTIME_CORE(xrDestroySpace),
    TEST_RUNTIME_CORE(xrEnumerateViewConfigurations),
    TEST_RUNTIME_CORE(xrGetViewConfigurationProperties),
    TEST_RUNTIME_CORE(xrEnumerateViewConfigurationViews),
    TEST_RUNTIME_CORE(xrEnumerateSwapchainFormats),
    TEST_RUNTIME_CORE(xrCreateSwapchain),
    TEST_RUNTIME_CORE(xrDestroySwapchain),
    TEST_RUNTIME_CORE(xrEnumerateSwapchainImages),
    TEST_RUNTIME_CORE(xrAcquireSwapchainImage),
    TEST_RUNTIME_CORE(xrWaitSwapchainImage),
    TEST_RUNTIME_CORE(xrReleaseSwapchainImage),
    TEST_RUNTIME_CORE(xrBeginSession),
    TEST_RUNTIME_CORE(xrEndSession),
    TEST_RUNTIME_CORE(xrRequestExitSession),
    TEST_RUNTIME_CORE(xrWaitFrame),
    TEST_RUNTIME_CORE(xrBeginFrame),
    TEST_RUNTIME_CORE(xrEndFrame),
    TEST_RUNTIME_CORE(xrLocateViews),
    TEST_RUNTIME_CORE(xrStringToPath),
    TEST_RUNTIME_CORE(xrPathToString),
    TEST_RUNTIME_CORE(xrCreateActionSet),
    TEST_RUNTIME_CORE(xrDestroyActionSet),
    TEST_RUNTIME_CORE(xrCreateAction),
    TEST_RUNTIME_CORE(xrDestroyAction),
    TEST_RUNTIME_CORE(xrSuggestInteractionProfileBindings),
    TEST_RUNTIME_CORE(xrAttachSessionActionSets),
    TEST_RUNTIME_CORE(xrGetCurrentInteractionProfile),
    TEST_RUNTIME_CORE(xrGetActionStateBoolean),
    TEST_RUNTIME_CORE(xrGetActionStateFloat),
    TEST_RUNTIME_CORE(xrGetActionStateVector2f),
    TEST_RUNTIME_CORE(xrGetActionStatePose),
    TEST_RUNTIME_CORE(xrSyncActions),
    TEST_RUNTIME_CORE(xrEnumerateBoundSourcesForAction),
    TEST_RUNTIME_CORE(xrGetInputSourceLocalizedName),
    TEST_RUNTIME_CORE(xrApplyHapticFeedback),
    TEST_RUNTIME_CORE(xrStopHapticFeedback),
    TEST_RUNTIME_EXTENSION(xrCreateVulkanInstanceKHR, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME),
    TEST_RUNTIME_EXTENSION(xrCreateVulkanDeviceKHR, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME),
    TEST_RUNTIME_EXTENSION(xrGetVulkanGraphicsDevice2KHR, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME),
    TEST_RUNTIME_EXTENSION(xrGetVulkanGraphicsRequirements2KHR,
                           XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME),
    TEST_RUNTIME_EXTENSION(xrGetVisibilityMaskKHR, XR_KHR_VISIBILITY_MASK_EXTENSION_NAME),
};

#undef TEST_RUNTIME_CORE
#undef TEST_RUNTIME_EXTENSION

const Function* find_function(const char* name) {
  for (const Function& function : kFunctions)
    if (std::strcmp(function.name, name) == 0) return &function;
  return nullptr;
}

// What may be asked for before there is an instance.
bool is_global(const char* name) {
  for (const char* global : {"xrEnumerateInstanceExtensionProperties",
                             "xrEnumerateApiLayerProperties", "xrCreateInstance"})
    if (std::strcmp(global, name) == 0) return true;
  return false;
}

}  // namespace

bool test_runtime::is_function(const std::string& name) {
  return find_function(name.c_str()) != nullptr;
}

XrResult xrGetInstanceProcAddr(XrInstance handle, const char* name, PFN_xrVoidFunction* address) {
  return call(__func__, [&](auto&) {
    checked_pointer(name, "name");
    checked_pointer(address, "function") = nullptr;
    const Function* function = find_function(name);
    if (handle == XR_NULL_HANDLE) {
      if (!is_global(name))
        refuse(XR_ERROR_HANDLE_INVALID, std::string(name) + " wants an instance");
    } else {
      const Instance& instance = context().handles.find<Instance>(handle, "instance");
      if (!function || (function->extension && !instance.enabled(function->extension)))
        return XR_ERROR_FUNCTION_UNSUPPORTED;  // the loader asks for all that it knows
    }
    *address = function->address;
    return XR_SUCCESS;
  });
}
