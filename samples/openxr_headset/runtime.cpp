#include "runtime.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "interrupted.h"

namespace host {
namespace {

constexpr std::chrono::seconds kPatience(30);
constexpr std::chrono::milliseconds kPause(100);

std::string runtime_hint() {
  const char* manifest = std::getenv("XR_RUNTIME_JSON");
  return std::string("XR_RUNTIME_JSON is ") +
         (manifest ? manifest : "not set, and there may be no active_runtime.json") +
         "; XR_LOADER_DEBUG=all tells what the loader tried";
}

Lost no_runtime(XrResult result) {
  return {Lost::instance,
          "found no OpenXR runtime (" + result_name(result) + "), expected one: " + runtime_hint()};
}

std::vector<XrExtensionProperties> list_extensions(const char* layer) {
  uint32_t count = 0;
  // Where there is no runtime, this is the first call to say so.
  const XrResult result = xrEnumerateInstanceExtensionProperties(layer, 0, &count, nullptr);
  if (XR_FAILED(result)) throw no_runtime(result);
  return xr_list("xrEnumerateInstanceExtensionProperties",
                 xr_struct<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES),
                 [&](uint32_t capacity, uint32_t* size, XrExtensionProperties* into) {
                   return xrEnumerateInstanceExtensionProperties(layer, capacity, size, into);
                 });
}

bool contains(const std::vector<XrExtensionProperties>& extensions, const char* name) {
  return std::any_of(extensions.begin(), extensions.end(), [&](const XrExtensionProperties& e) {
    return std::strcmp(e.extensionName, name) == 0;
  });
}

void require_xr_validation_layer() {
  const auto layers = xr_list("xrEnumerateApiLayerProperties",
                              xr_struct<XrApiLayerProperties>(XR_TYPE_API_LAYER_PROPERTIES),
                              xrEnumerateApiLayerProperties);
  for (const XrApiLayerProperties& layer : layers)
    if (std::strcmp(layer.layerName, kXrValidationLayer) == 0) return;
  throw Failure(kMachine, std::string("--validation: found no ") + kXrValidationLayer +
                              ", expected it installed");
}

}  // namespace

Runtime::Runtime(bool quad_views, XrValidation* validation)
    : view_configuration_(quad_views ? kQuadViews : kStereo) {
  create(validation);
  XrInstanceProperties properties = xr_struct<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
  check(xrGetInstanceProperties(instance_.get(), &properties), "xrGetInstanceProperties");
  const XrVersion version = properties.runtimeVersion;
  name_ = std::string(properties.runtimeName) + " " + std::to_string(XR_VERSION_MAJOR(version)) +
          "." + std::to_string(XR_VERSION_MINOR(version)) + "." +
          std::to_string(XR_VERSION_PATCH(version));
  find_headset();
}

void Runtime::create(XrValidation* validation) {
  const std::vector<XrExtensionProperties> offered = list_extensions(nullptr);
  if (!contains(offered, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME))
    throw Failure(kMachine,
                  "found an OpenXR runtime without XR_KHR_vulkan_enable2, expected one with it: " +
                      runtime_hint());
  depth_layer_ = contains(offered, XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
  visibility_mask_ = contains(offered, XR_KHR_VISIBILITY_MASK_EXTENSION_NAME);
  std::vector<const char*> extensions = {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME};
  if (depth_layer_) extensions.push_back(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
  if (visibility_mask_) extensions.push_back(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME);

  // Where there is no extension, OpenXR 1.1 may have the configuration.
  const bool quad_views = view_configuration_ == kQuadViews;
  const bool without_extension =
      quad_views && !contains(offered, XR_VARJO_QUAD_VIEWS_EXTENSION_NAME);
  if (quad_views && !without_extension) extensions.push_back(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME);

  XrInstanceCreateInfo info = xr_struct<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  std::strcpy(info.applicationInfo.applicationName, "openxr_headset");
  std::strcpy(info.applicationInfo.engineName, "Voyager");
  info.applicationInfo.apiVersion =
      without_extension ? XR_MAKE_VERSION(1, 1, 0) : XR_MAKE_VERSION(1, 0, 0);
  if (validation) {
    require_xr_validation_layer();
    extensions.push_back(XR_EXT_DEBUG_UTILS_EXTENSION_NAME);
    info.next = validation->instance_chain();
    info.enabledApiLayerCount = 1;
    info.enabledApiLayerNames = &kXrValidationLayer;
  }
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.enabledExtensionNames = extensions.data();
  XrInstance instance = XR_NULL_HANDLE;
  const XrResult result = xrCreateInstance(&info, &instance);
  if (result == XR_ERROR_RUNTIME_UNAVAILABLE) throw no_runtime(result);
  if (result == XR_ERROR_API_VERSION_UNSUPPORTED && without_extension)
    throw Failure(kMachine,
                  "--quad-views: found an OpenXR runtime or loader without XR_VARJO_quad_views and "
                  "without OpenXR 1.1, expected one of them: " +
                      runtime_hint());
  if (XR_FAILED(result) && result != XR_ERROR_INSTANCE_LOST)
    throw Failure(kMachine, "xrCreateInstance: " + result_name(result) + ": " + runtime_hint());
  check(result, "xrCreateInstance");
  instance_ = UniqueXrInstance(instance);
}

void Runtime::find_headset() {
  XrSystemGetInfo info = xr_struct<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
  info.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  const auto until = std::chrono::steady_clock::now() + kPatience;
  XrResult result = xrGetSystem(instance_.get(), &info, &system_);
  if (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE)
    std::fprintf(stderr, "%s: no headset yet, waiting for one\n", name_.c_str());
  while (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(kPause);
    if (interrupted) throw Lost(Lost::instance, "interrupted before there was a headset");
    result = xrGetSystem(instance_.get(), &info, &system_);
  }
  if (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE || result == XR_ERROR_FORM_FACTOR_UNSUPPORTED)
    throw Failure(kMachine, name_ + ": found no headset (" + result_name(result) +
                                "), expected one that is connected");
  check(result, "xrGetSystem");

  const auto kinds = xr_list("xrEnumerateViewConfigurations", XrViewConfigurationType{},
                             [&](uint32_t capacity, uint32_t* size, XrViewConfigurationType* into) {
                               return xrEnumerateViewConfigurations(instance_.get(), system_,
                                                                    capacity, size, into);
                             });
  if (std::find(kinds.begin(), kinds.end(), view_configuration_) == kinds.end())
    throw Failure(kMachine, name_ + ": found no view configuration of " +
                                std::to_string(view_count()) + " views, expected one");
  const auto modes =
      xr_list("xrEnumerateEnvironmentBlendModes", XrEnvironmentBlendMode{},
              [&](uint32_t capacity, uint32_t* size, XrEnvironmentBlendMode* into) {
                return xrEnumerateEnvironmentBlendModes(instance_.get(), system_,
                                                        view_configuration_, capacity, size, into);
              });
  if (modes.empty()) throw Failure(kMachine, name_ + ": found no blend mode, expected one");
  // A city is all there is to see: opaque, or else what the runtime likes best.
  blend_mode_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  if (std::find(modes.begin(), modes.end(), blend_mode_) == modes.end())
    blend_mode_ = modes.front();
}

bool Runtime::find_headset_again() {
  const XrSystemId before = system_;
  find_headset();
  return system_ == before;
}

bool Runtime::poll(XrEventDataBuffer& event) const {
  event = xr_struct<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
  return check(xrPollEvent(instance_.get(), &event), "xrPollEvent") == XR_SUCCESS;
}

std::vector<XrViewConfigurationView> Runtime::views() const {
  auto views = xr_list("xrEnumerateViewConfigurationViews",
                       xr_struct<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW),
                       [&](uint32_t capacity, uint32_t* size, XrViewConfigurationView* into) {
                         return xrEnumerateViewConfigurationViews(
                             instance_.get(), system_, view_configuration_, capacity, size, into);
                       });
  if (views.size() != view_count())
    throw Failure(kMachine, name_ + ": found " + std::to_string(views.size()) +
                                " views, expected " + std::to_string(view_count()));
  return views;
}

}  // namespace host
