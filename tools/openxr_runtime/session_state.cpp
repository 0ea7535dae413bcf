#include <algorithm>

#include "session.h"

namespace test_runtime {
namespace {

void recentre(Session& session, const Event& event) {
  const XrTime from = run().clock.display_time() + 2 * run().clock.period();
  const Pose previous = session.recentrings.back().local_in_root;
  session.recentrings.push_back({from, event.recentred});
  queue_event(session.instance, XrEventDataReferenceSpaceChangePending{
                                    XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING, nullptr,
                                    session.xr(), XR_REFERENCE_SPACE_TYPE_LOCAL, from, XR_TRUE,
                                    to_xr(previous.inverse() * event.recentred)});
}

void mask_changed(Session& session) {
  if (!session.instance.enabled(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME)) return;
  for (uint32_t view = 0; view < view_count(session.configuration); ++view)
    queue_event(session.instance, XrEventDataVisibilityMaskChangedKHR{
                                      XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR, nullptr,
                                      session.xr(), session.configuration, view});
}

void lose_session(Session& session, int64_t frames) {
  session.frames_to_loss = frames;
  set_state(session, XR_SESSION_STATE_LOSS_PENDING);
}

void lose_instance(Instance& instance, int64_t frames) {
  instance.frames_to_loss = frames;
  queue_event(instance,
              XrEventDataInstanceLossPending{XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING, nullptr,
                                             run().clock.now() + frames * run().clock.period()});
}

// Counts down to a loss; true at it.
bool count_down(int64_t& frames) {
  return frames >= 0 && frames-- == 0;
}

void play(Session& session, const Event& event, int64_t& periods_late) {
  if (event.what == "synchronized") session.wanted = XR_SESSION_STATE_SYNCHRONIZED;
  if (event.what == "visible") session.wanted = XR_SESSION_STATE_VISIBLE;
  if (event.what == "focused") session.wanted = XR_SESSION_STATE_FOCUSED;
  if (event.what == "stop" || event.what == "exit") {
    session.polls_to_ready = event.what == "stop" ? event.amount : -1;
    session.exit_requested |= event.what == "exit";
    request_stop(session);
  }
  if (event.what == "lose_session") lose_session(session, event.amount);
  if (event.what == "lose_instance") lose_instance(session.instance, event.amount);
  if (event.what == "recentre") recentre(session, event);
  if (event.what == "late") periods_late += event.amount;
  if (event.what == "swap_image") session.swap_next_image = true;
  if (event.what == "mask_changed") mask_changed(session);
}

bool in_frame_loop(const Session& session) {
  return session.state >= XR_SESSION_STATE_SYNCHRONIZED &&
         session.state <= XR_SESSION_STATE_FOCUSED;
}

}  // namespace

void set_state(Session& session, XrSessionState state) {
  session.state = state;
  run().report.state(run().frame(), state);
  queue_event(session.instance,
              XrEventDataSessionStateChanged{XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED, nullptr,
                                             session.xr(), state, run().clock.now()});
}

void session_created(Session& session) {
  set_state(session, XR_SESSION_STATE_IDLE);
  set_state(session, XR_SESSION_STATE_READY);
}

void request_stop(Session& session) {
  if (session.state > XR_SESSION_STATE_FOCUSED) return;  // on its way already
  if (session.state == XR_SESSION_STATE_FOCUSED) set_state(session, XR_SESSION_STATE_VISIBLE);
  if (session.state != XR_SESSION_STATE_SYNCHRONIZED)
    set_state(session, XR_SESSION_STATE_SYNCHRONIZED);
  set_state(session, XR_SESSION_STATE_STOPPING);
}

void idle_poll(Session& session) {
  if (session.state != XR_SESSION_STATE_IDLE || session.exit_requested ||
      session.polls_to_ready < 0)
    return;
  if (session.polls_to_ready-- > 0) return;
  session.wanted = XR_SESSION_STATE_FOCUSED;
  set_state(session, XR_SESSION_STATE_READY);
}

void frame_starts(Session& session) {
  session.lost |= count_down(session.frames_to_loss);
  session.instance.lost |= count_down(session.instance.frames_to_loss);
  check_not_lost(session);
  if (!in_frame_loop(session) || session.state == session.wanted) return;
  const int step = session.state < session.wanted ? 1 : -1;
  set_state(session, static_cast<XrSessionState>(session.state + step));
}

void frame_ended(Session& session) {
  if (session.state == XR_SESSION_STATE_READY) set_state(session, XR_SESSION_STATE_SYNCHRONIZED);
}

void play_events(Session& session, int64_t up_to_frame, int64_t& periods_late) {
  for (const Event& event : run().take_events(up_to_frame)) play(session, event, periods_late);
}

}  // namespace test_runtime
