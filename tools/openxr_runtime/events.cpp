#include "instance.h"
#include "session.h"

using namespace test_runtime;

XrResult xrPollEvent(XrInstance handle, XrEventDataBuffer* event) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    checked(event, XR_TYPE_EVENT_DATA_BUFFER, "eventData");
    if (instance.events.empty()) {
      context().handles.each<Session>([](Session& session) { idle_poll(session); });
      return XR_EVENT_UNAVAILABLE;
    }
    *event = instance.events.front();
    instance.events.pop_front();
    return XR_SUCCESS;
  });
}
