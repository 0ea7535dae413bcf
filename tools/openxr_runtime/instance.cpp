#include "instance.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "extensions.h"
#include "session.h"

using namespace test_runtime;

namespace test_runtime {
namespace {

// The script's run goes on where the application starts again after a loss.
void start_run() {
  const char* named = std::getenv("VOYAGER_TEST_RUNTIME_SCRIPT");
  const std::string path = named ? named : "";
  auto& current = context().run;
  if (current && current->script.path == path && !path.empty()) return;
  try {
    current = std::make_unique<Run>(read_script(path));
  } catch (const std::runtime_error& error) {
    refuse(XR_ERROR_INITIALIZATION_FAILED, std::string("the script: ") + error.what());
  }
}

// A script that is refused is told of once, by xrCreateInstance.
void try_run() {
  try {
    start_run();
  } catch (const Refusal&) {
    context().run.reset();
  }
}

std::vector<std::string> offered() {
  std::vector<std::string> names = {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME};
  const auto optional = context().run ? run().script.extensions : optional_extensions();
  names.insert(names.end(), optional.begin(), optional.end());
  return names;
}

void check_extension(const char* name) {
  const auto names = offered();
  if (std::find(names.begin(), names.end(), checked_pointer(&name, "an extension's name")) ==
      names.end())
    violation(XR_ERROR_EXTENSION_NOT_PRESENT, std::string("enabledExtensionNames: found ") + name +
                                                  ", expected one that the runtime offers");
}

void check_application(const XrApplicationInfo& application) {
  if (application.applicationName[0] == '\0')
    violation(XR_ERROR_NAME_INVALID, "applicationInfo.applicationName: found none");
  if (XR_VERSION_MAJOR(application.apiVersion) != 1 || XR_VERSION_MINOR(application.apiVersion) > 0)
    refuse(XR_ERROR_API_VERSION_UNSUPPORTED, "applicationInfo.apiVersion: expected 1.0");
}

}  // namespace

bool Instance::enabled(const char* extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

Instance& find_instance(XrInstance handle) {
  Instance& instance = context().handles.find<Instance>(handle, "instance");
  if (instance.lost) refuse(XR_ERROR_INSTANCE_LOST, "the instance is lost");
  return instance;
}

}  // namespace test_runtime

XrResult xrEnumerateInstanceExtensionProperties(const char* layer, uint32_t capacity,
                                                uint32_t* count,
                                                XrExtensionProperties* properties) {
  return call(__func__, [&](auto&) {
    if (layer) refuse(XR_ERROR_API_LAYER_NOT_PRESENT, "layerName: the runtime is no layer");
    if (!context().instance) try_run();
    const auto names = offered();
    return enumerate(names.size(), capacity, count, properties, [&](size_t i, auto& item) {
      checked(&item, XR_TYPE_EXTENSION_PROPERTIES, "properties");
      void* const next = item.next;
      item = extension_properties(names[i]);
      item.next = next;
    });
  });
}

XrResult xrEnumerateApiLayerProperties(uint32_t, uint32_t* count, XrApiLayerProperties*) {
  return call(__func__, [&](auto&) {
    checked_pointer(count, "propertyCountOutput") = 0;
    return XR_SUCCESS;
  });
}

XrResult xrCreateInstance(const XrInstanceCreateInfo* info, XrInstance* handle) {
  return call(__func__, [&](auto&) {
    checked(info, XR_TYPE_INSTANCE_CREATE_INFO, "createInfo");
    checked_pointer(handle, "instance");
    if (context().instance) refuse(XR_ERROR_LIMIT_REACHED, "there is an instance already");
    start_run();
    if (info->createFlags != 0) violation(XR_ERROR_VALIDATION_FAILURE, "createFlags: expected 0");
    check_application(info->applicationInfo);
    auto instance = std::make_unique<Instance>();
    for (uint32_t i = 0; i < info->enabledExtensionCount; ++i) {
      check_extension(info->enabledExtensionNames[i]);
      instance->extensions.emplace_back(info->enabledExtensionNames[i]);
    }
    *handle = context().handles.add<XrInstance>(std::move(instance));
    context().instance = true;
    run().report.count("instances");
    return XR_SUCCESS;
  });
}

XrResult xrDestroyInstance(XrInstance handle) {
  return call(__func__, [&](auto&) {
    const Instance& instance = context().handles.find<Instance>(handle, "instance");
    context().handles.each<Session>(
        [](Session&) { remark("the instance is destroyed with a live session"); });
    context().handles.destroy(instance.handle);
    context().instance = false;
    context().changed.notify_all();
    run().write();
    return XR_SUCCESS;
  });
}

XrResult xrGetInstanceProperties(XrInstance handle, XrInstanceProperties* properties) {
  return call(__func__, [&](auto&) {
    find_instance(handle);
    checked(properties, XR_TYPE_INSTANCE_PROPERTIES, "instanceProperties");
    properties->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
    std::snprintf(properties->runtimeName, sizeof properties->runtimeName, "Voyager test runtime");
    return XR_SUCCESS;
  });
}

XrResult xrResultToString(XrInstance handle, XrResult value, char text[XR_MAX_RESULT_STRING_SIZE]) {
  return call(__func__, [&](auto&) {
    find_instance(handle);
    std::snprintf(&checked_pointer(text, "buffer"), XR_MAX_RESULT_STRING_SIZE, "%s",
                  name_of(value).c_str());
    return XR_SUCCESS;
  });
}

XrResult xrStructureTypeToString(XrInstance handle, XrStructureType value,
                                 char text[XR_MAX_STRUCTURE_NAME_SIZE]) {
  return call(__func__, [&](auto&) {
    find_instance(handle);
    std::snprintf(&checked_pointer(text, "buffer"), XR_MAX_STRUCTURE_NAME_SIZE, "%s",
                  name_of(value).c_str());
    return XR_SUCCESS;
  });
}
