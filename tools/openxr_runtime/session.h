#pragma once
// XrSession: its state machine, its frame loop, its device.
#include <array>
#include <optional>

#include "device.h"
#include "instance.h"

namespace test_runtime {

struct Frame {
  int64_t number;
  XrTime display_time;
};

// One reference space's origin in the root, which is LOCAL before any recentring.
struct Recentring {
  XrTime from;
  Pose local_in_root;
};

// What a bound source gave at the last two xrSyncActions calls.
struct ActionValue {
  float x = 0, y = 0;
  bool active = false, changed = false;
  XrTime changed_at = 0;
};

struct Session final : Object {
  explicit Session(Instance& of, const XrGraphicsBindingVulkanKHR& binding)
      : Object(&of), instance(of), device(of.vulkan_get, binding) {}

  XrSession xr() const { return Handles::handle_of<XrSession>(handle); }

  Instance& instance;
  Device device;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
  XrSessionState wanted = XR_SESSION_STATE_FOCUSED;  // what the script has it climb to
  bool running = false;
  // That it was begun with last.
  XrViewConfigurationType configuration = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  bool exit_requested = false;
  bool lost = false;
  int64_t polls_to_ready = -1;   // after a stop; below 0: does not come back
  int64_t frames_to_loss = -1;   // after LOSS_PENDING
  bool swap_next_image = false;  // the next image acquired is not the one whose turn it is
  std::optional<Frame> waited, begun;
  std::vector<Recentring> recentrings = {{0, {}}};

  bool attached = false;
  std::vector<uint64_t> action_sets;  // attached ones
  std::string profile;                // "" before the first xrSyncActions
  // By action's handle and top level path ("" for all of its bindings together).
  std::map<std::pair<uint64_t, std::string>, ActionValue> values;
};

// A live one, refused once it or its instance is lost.
Session& find_session(XrSession handle);
void check_not_lost(const Session& session);
void check_running(const Session& session);
// XR_SUCCESS, or that the session is about to be lost.
XrResult success(const Session& session);

// session_state.cpp
void set_state(Session& session, XrSessionState state);
void session_created(Session& session);
void request_stop(Session& session);  // down to STOPPING
void idle_poll(Session& session);     // xrPollEvent found nothing
void frame_starts(Session& session);  // before shouldRender is decided
void frame_ended(Session& session);
void play_events(Session& session, int64_t up_to_frame, int64_t& periods_late);

}  // namespace test_runtime
