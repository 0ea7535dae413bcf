#include <cstdio>

#include "instance.h"

using namespace test_runtime;

namespace test_runtime {

void check_system(XrSystemId system) {
  if (system != kSystem)
    violation(XR_ERROR_SYSTEM_INVALID, "systemId: expected what xrGetSystem gave");
}

void check_view_configuration(XrViewConfigurationType type) {
  if (type != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO)
    violation(XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED,
              "expected XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO");
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
    find_instance(handle);
    check_system(system);
    check_view_configuration(type);
    return enumerate(1, capacity, count, modes,
                     [](size_t, auto& mode) { mode = XR_ENVIRONMENT_BLEND_MODE_OPAQUE; });
  });
}

XrResult xrEnumerateViewConfigurations(XrInstance handle, XrSystemId system, uint32_t capacity,
                                       uint32_t* count, XrViewConfigurationType* types) {
  return call(__func__, [&](auto&) {
    find_instance(handle);
    check_system(system);
    return enumerate(1, capacity, count, types,
                     [](size_t, auto& type) { type = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO; });
  });
}

XrResult xrGetViewConfigurationProperties(XrInstance handle, XrSystemId system,
                                          XrViewConfigurationType type,
                                          XrViewConfigurationProperties* properties) {
  return call(__func__, [&](auto&) {
    find_instance(handle);
    check_system(system);
    check_view_configuration(type);
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
    find_instance(handle);
    check_system(system);
    check_view_configuration(type);
    return enumerate(2, capacity, count, views, [](size_t eye, auto& view) {
      checked(&view, XR_TYPE_VIEW_CONFIGURATION_VIEW, "views");
      const auto& size = run().script.recommended[eye];
      const auto& maximum = run().script.maximum;
      view.recommendedImageRectWidth = static_cast<uint32_t>(size.width);
      view.recommendedImageRectHeight = static_cast<uint32_t>(size.height);
      view.maxImageRectWidth = static_cast<uint32_t>(maximum.width);
      view.maxImageRectHeight = static_cast<uint32_t>(maximum.height);
      view.recommendedSwapchainSampleCount = view.maxSwapchainSampleCount = 1;
    });
  });
}
