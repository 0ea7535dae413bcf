#include "session.h"

using namespace test_runtime;

namespace test_runtime {
namespace {

const XrGraphicsBindingVulkanKHR& check_binding(const Instance& instance, const void* next) {
  const auto* binding =
      chained<XrGraphicsBindingVulkanKHR>(next, XR_TYPE_GRAPHICS_BINDING_VULKAN_KHR);
  if (!binding)
    violation(XR_ERROR_GRAPHICS_DEVICE_INVALID,
              "createInfo->next: found no XrGraphicsBindingVulkan2KHR, expected one");
  if (!instance.requirements_asked)
    violation(XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
              "expected xrGetVulkanGraphicsRequirements2KHR before");
  const auto expect = [](bool same, const char* field, const char* from) {
    if (!same)
      violation(XR_ERROR_GRAPHICS_DEVICE_INVALID,
                std::string("the graphics binding: ") + field + ": expected that of " + from);
  };
  expect(instance.vulkan_instance && binding->instance == instance.vulkan_instance, "instance",
         "xrCreateVulkanInstanceKHR");
  expect(binding->physicalDevice == instance.vulkan_physical, "physicalDevice",
         "xrGetVulkanGraphicsDevice2KHR");
  expect(instance.vulkan_device && binding->device == instance.vulkan_device, "device",
         "xrCreateVulkanDeviceKHR");
  return *binding;
}

}  // namespace

Session& find_session(XrSession handle) {
  Session& session = context().handles.find<Session>(handle, "session");
  check_not_lost(session);
  return session;
}

void check_not_lost(const Session& session) {
  if (session.instance.lost) refuse(XR_ERROR_INSTANCE_LOST, "the instance is lost");
  if (session.lost) refuse(XR_ERROR_SESSION_LOST, "the session is lost");
}

void check_running(const Session& session) {
  if (!session.running) violation(XR_ERROR_SESSION_NOT_RUNNING, "the session is not running");
}

XrResult success(const Session& session) {
  return session.state == XR_SESSION_STATE_LOSS_PENDING ? XR_SESSION_LOSS_PENDING : XR_SUCCESS;
}

}  // namespace test_runtime

XrResult xrCreateSession(XrInstance handle, const XrSessionCreateInfo* info, XrSession* created) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    checked(info, XR_TYPE_SESSION_CREATE_INFO, "createInfo");
    checked_pointer(created, "session");
    check_system(info->systemId);
    if (info->createFlags != 0) violation(XR_ERROR_VALIDATION_FAILURE, "createFlags: expected 0");
    const auto& binding = check_binding(instance, info->next);
    context().handles.each<Session>(
        [](Session&) { refuse(XR_ERROR_LIMIT_REACHED, "there is a session already"); });
    *created = context().handles.add<XrSession>(std::make_unique<Session>(instance, binding));
    session_created(context().handles.find<Session>(*created, "session"));
    run().report.count("sessions");
    return XR_SUCCESS;
  });
}

XrResult xrDestroySession(XrSession handle) {
  return call(__func__, [&](auto&) {
    Session& session = context().handles.find<Session>(handle, "session");
    auto& events = session.instance.events;
    std::erase_if(events, [&](const XrEventDataBuffer& event) {
      const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
      return event.type != XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING && changed.session == handle;
    });
    context().handles.destroy(session.handle);
    context().changed.notify_all();
    run().write();
    return XR_SUCCESS;
  });
}

XrResult xrBeginSession(XrSession handle, const XrSessionBeginInfo* info) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    checked(info, XR_TYPE_SESSION_BEGIN_INFO, "beginInfo");
    check_view_configuration(session.instance, info->primaryViewConfigurationType);
    if (session.running) violation(XR_ERROR_SESSION_RUNNING, "the session is running already");
    if (session.state != XR_SESSION_STATE_READY)
      violation(XR_ERROR_SESSION_NOT_READY,
                "found " + name_of(session.state) + ", expected XR_SESSION_STATE_READY");
    session.running = true;
    session.configuration = info->primaryViewConfigurationType;
    session.waited.reset();
    session.begun.reset();
    run().report.count("sessions_begun");
    return XR_SUCCESS;
  });
}

XrResult xrEndSession(XrSession handle) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    check_running(session);
    if (session.state != XR_SESSION_STATE_STOPPING)
      violation(XR_ERROR_SESSION_NOT_STOPPING,
                "found " + name_of(session.state) + ", expected XR_SESSION_STATE_STOPPING");
    if (session.begun) remark("the session is ended within a frame");
    session.running = false;
    session.waited.reset();
    session.begun.reset();
    context().changed.notify_all();
    set_state(session, XR_SESSION_STATE_IDLE);
    if (session.exit_requested) set_state(session, XR_SESSION_STATE_EXITING);
    run().write();
    return XR_SUCCESS;
  });
}

XrResult xrRequestExitSession(XrSession handle) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    check_running(session);
    session.exit_requested = true;
    request_stop(session);
    return success(session);
  });
}
