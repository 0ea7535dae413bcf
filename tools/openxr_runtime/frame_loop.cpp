#include "layers.h"
#include "session.h"

using namespace test_runtime;

namespace {

using Lock = std::unique_lock<std::mutex>;

// OpenXR has a second xrWaitFrame wait until the first one's frame is begun. Where that never
// comes, the application would hang.
Session& wait_for_begin(XrSession handle, Lock& lock) {
  const auto patience = std::chrono::milliseconds(run().script.patience);
  const bool begun = context().changed.wait_for(
      lock, patience, [&] { return !find_session(handle).waited.has_value(); });
  context().function = "xrWaitFrame";
  if (!begun)
    violation(XR_ERROR_CALL_ORDER_INVALID,
              "found the last waited frame not begun, expected xrBeginFrame before the next wait");
  Session& session = find_session(handle);
  check_running(session);
  return session;
}

bool should_render(const Session& session, int64_t frame) {
  return (session.state == XR_SESSION_STATE_VISIBLE || session.state == XR_SESSION_STATE_FOCUSED) &&
         !contains(run().script.hidden, frame);
}

void check_end_info(const XrFrameEndInfo& info, const Frame& frame) {
  if (info.displayTime <= 0)
    violation(XR_ERROR_TIME_INVALID, "displayTime: expected a time above 0");
  if (info.displayTime != frame.display_time)
    remark("displayTime: found " + std::to_string(info.displayTime) + ", the frame's is " +
           std::to_string(frame.display_time));
  if (info.environmentBlendMode != XR_ENVIRONMENT_BLEND_MODE_OPAQUE)
    violation(XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED,
              "environmentBlendMode: expected XR_ENVIRONMENT_BLEND_MODE_OPAQUE");
}

}  // namespace

XrResult xrWaitFrame(XrSession handle, const XrFrameWaitInfo* info, XrFrameState* state) {
  return call(__func__, [&](Lock& lock) {
    check_running(find_session(handle));
    if (info) checked(info, XR_TYPE_FRAME_WAIT_INFO, "frameWaitInfo");
    checked(state, XR_TYPE_FRAME_STATE, "frameState");
    Session& session = wait_for_begin(handle, lock);
    int64_t periods_late = 0;
    play_events(session, run().waited, periods_late);
    frame_starts(session);
    const XrTime start = run().clock.next(periods_late);
    const Frame frame = {run().waited++, run().clock.display_time()};
    session.waited = frame;
    state->predictedDisplayTime = frame.display_time;
    state->predictedDisplayPeriod = run().clock.period();
    state->shouldRender = should_render(session, frame.number);
    run().report.count(state->shouldRender ? "frames_to_render" : "frames_hidden");
    const XrResult result = success(session);
    const auto until = run().clock.until(start);
    if (until.count() > 0) context().changed.wait_for(lock, until, [] { return false; });
    return result;
  });
}

XrResult xrBeginFrame(XrSession handle, const XrFrameBeginInfo* info) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    if (info) checked(info, XR_TYPE_FRAME_BEGIN_INFO, "frameBeginInfo");
    check_running(session);
    if (!session.waited)
      violation(XR_ERROR_CALL_ORDER_INVALID, "found no waited frame, expected xrWaitFrame before");
    const bool discarded = session.begun.has_value();
    session.begun = session.waited;
    session.waited.reset();
    context().changed.notify_all();
    if (discarded) run().report.count("frames_discarded");
    return discarded ? XR_FRAME_DISCARDED : success(session);
  });
}

XrResult xrEndFrame(XrSession handle, const XrFrameEndInfo* info) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    checked(info, XR_TYPE_FRAME_END_INFO, "frameEndInfo");
    check_running(session);
    if (!session.begun)
      violation(XR_ERROR_CALL_ORDER_INVALID, "found no begun frame, expected xrBeginFrame before");
    check_end_info(*info, *session.begun);
    end_with_layers(session, *session.begun, *info);
    session.begun.reset();
    run().report.count("frames_ended");
    frame_ended(session);
    return success(session);
  });
}
