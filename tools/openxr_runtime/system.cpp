#include <algorithm>
#include <cstdio>

#include "instance.h"

using namespace test_runtime;

namespace test_runtime {

void check_system(XrSystemId system) {
  if (system != kSystem)
    violation(XR_ERROR_SYSTEM_INVALID, "systemId: expected what xrGetSystem gave");
}

namespace {

// The one that it likes best first.
std::vector<XrViewConfigurationType> view_configurations(const Instance& instance) {
  if (!instance.enabled(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME))
    return {XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
  return {XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
}

}  // namespace

void check_view_configuration(const Instance& instance, XrViewConfigurationType type) {
  const auto known = view_configurations(instance);
  if (std::find(known.begin(), known.end(), type) == known.end())
    violation(XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED,
              "found view configuration " + std::to_string(type) +
                  ", expected XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO" +
                  (known.size() > 1 ? " or PRIMARY_QUAD_VARJO" : ""));
}

uint32_t view_count(XrViewConfigurationType type) {
  return type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO ? 4 : 2;
}

}  // namespace test_runtime

XrResult xrGetSystem(XrInstance handle, const XrSystemGetInfo* info, XrSystemId* system) {
  return call(__func__, [&](auto&) {
    find_instance(handle);
    checked(info, XR_TYPE_SYSTEM_GET_INFO, "getInfo");
    checked_pointer(system, "systemId");
    if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY)
      refuse(XR_ERROR_FORM_FACTOR_UNSUPPORTED, "formFactor: expected HEAD_MOUNTED_DISPLAY");
    *system = kSystem;
    return XR_SUCCESS;
  });
}

XrResult xrGetSystemProperties(XrInstance handle, XrSystemId system,
                               XrSystemProperties* properties) {
  return call(__func__, [&](auto&) {
    find_instance(handle);
    check_system(system);
    checked(properties, XR_TYPE_SYSTEM_PROPERTIES, "properties");
    properties->systemId = system;
    properties->vendorId = 0;
    std::snprintf(properties->systemName, sizeof properties->systemName, "Headless headset");
    const XrExtent2Di& size = run().script.maximum;
    properties->graphicsProperties = {static_cast<uint32_t>(size.height),
                                      static_cast<uint32_t>(size.width),
                                      XR_MIN_COMPOSITION_LAYERS_SUPPORTED};
    properties->trackingProperties = {XR_TRUE, XR_TRUE};
    return XR_SUCCESS;
  });
}

XrResult xrEnumerateEnvironmentBlendModes(XrInstance handle, XrSystemId system,
                                          XrViewConfigurationType type, uint32_t capacity,
                                          uint32_t* count, XrEnvironmentBlendMode* modes) {
  return call(__func__, [&](auto&) {
    const Instance& instance = find_instance(handle);
    check_system(system);
    check_view_configuration(instance, type);
    return enumerate(1, capacity, count, modes,
                     [](size_t, auto& mode) { mode = XR_ENVIRONMENT_BLEND_MODE_OPAQUE; });
  });
}

XrResult xrEnumerateViewConfigurations(XrInstance handle, XrSystemId system, uint32_t capacity,
                                       uint32_t* count, XrViewConfigurationType* types) {
  return call(__func__, [&](auto&) {
    const auto known = view_configurations(find_instance(handle));
    check_system(system);
    return enumerate(known.size(), capacity, count, types,
                     [&](size_t i, XrViewConfigurationType& type) { type = known[i]; });
  });
}

XrResult xrGetViewConfigurationProperties(XrInstance handle, XrSystemId system,
                                          XrViewConfigurationType type,
                                          XrViewConfigurationProperties* properties) {
  return call(__func__, [&](auto&) {
    const Instance& instance = find_instance(handle);
    check_system(system);
    check_view_configuration(instance, type);
    checked(properties, XR_TYPE_VIEW_CONFIGURATION_PROPERTIES, "configurationProperties");
    properties->viewConfigurationType = type;
    properties->fovMutable = XR_TRUE;
    return XR_SUCCESS;
  });
}

XrResult xrEnumerateViewConfigurationViews(XrInstance handle, XrSystemId system,
                                           XrViewConfigurationType type, uint32_t capacity,
                                           uint32_t* count, XrViewConfigurationView* views) {
  return call(__func__, [&](auto&) {
    const Instance& instance = find_instance(handle);
    check_system(system);
    check_view_configuration(instance, type);
    return enumerate(view_count(type), capacity, count, views, [](size_t i, auto& view) {
      checked(&view, XR_TYPE_VIEW_CONFIGURATION_VIEW, "views");
      const auto& size = run().script.recommended[i];
      const auto& maximum = run().script.maximum;
      view.recommendedImageRectWidth = static_cast<uint32_t>(size.width);
      view.recommendedImageRectHeight = static_cast<uint32_t>(size.height);
      view.maxImageRectWidth = static_cast<uint32_t>(maximum.width);
      view.maxImageRectHeight = static_cast<uint32_t>(maximum.height);
      view.recommendedSwapchainSampleCount = view.maxSwapchainSampleCount = 1;
    });
  });
}
