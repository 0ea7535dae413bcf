#include <algorithm>
#include <cmath>

#include "actions.h"

using namespace test_runtime;

namespace test_runtime {
namespace {

// As numbers: a press is 1. A component's parent stands in for what the script does not name.
std::pair<float, float> read_source(const Source& source) {
  const std::string path = source.path;
  const Json value = run().input(path);
  if (value.is_array()) return {value[0].get<float>(), value[1].get<float>()};
  if (value.is_boolean()) return {value.get<bool>() ? 1.0f : 0.0f, 0.0f};
  if (value.is_number()) return {value.get<float>(), 0.0f};
  const Json stick = run().input(path.substr(0, path.rfind('/')));
  if (!stick.is_array() || path.size() < 2) return {0.0f, 0.0f};
  if (path.ends_with("/x")) return {stick[0].get<float>(), 0.0f};
  if (path.ends_with("/y")) return {stick[1].get<float>(), 0.0f};
  return {0.0f, 0.0f};
}

// Of several sources the one that is pushed farthest.
ActionValue read_action(const Session& session, const Action& action, const std::string& hand) {
  ActionValue value;
  for (const Source* source : bound_sources(session, action, hand)) {
    if (!hand_active(source->path)) continue;
    value.active = true;
    const auto [x, y] = read_source(*source);
    if (std::hypot(x, y) > std::hypot(value.x, value.y)) value.x = x, value.y = y;
  }
  if (action.type == XR_ACTION_TYPE_BOOLEAN_INPUT) value.x = value.x > 0.5f ? 1.0f : 0.0f;
  return value;
}

void sync_action(Session& session, const Action& action, const std::string& hand, bool active) {
  ActionValue& held = session.values[{action.handle, hand}];
  ActionValue now = active ? read_action(session, action, hand) : ActionValue{};
  now.changed = now.active && held.active && (now.x != held.x || now.y != held.y);
  now.changed_at = now.changed ? run().clock.now() : held.changed_at;
  held = now;
}

void choose_profile(Session& session) {
  if (!session.profile.empty()) return;
  for (const char* profile : kProfiles)
    if (session.profile.empty() && session.instance.suggested.count(profile))
      session.profile = profile;
  if (session.profile.empty()) return;
  queue_event(session.instance,
              XrEventDataInteractionProfileChanged{XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED,
                                                   nullptr, session.xr()});
}

// The value of the action of that type that a query names.
ActionValue query(const Session& session, const XrActionStateGetInfo* info, XrActionType type) {
  checked(info, XR_TYPE_ACTION_STATE_GET_INFO, "getInfo");
  const Action& action = find_action(session, info->action, type);
  check_attached(session, action);
  const auto found =
      session.values.find({action.handle, subaction_of(session, action, info->subactionPath)});
  return found == session.values.end() ? ActionValue{} : found->second;
}

template <class State>
void fill(State& state, const ActionValue& value) {
  state.changedSinceLastSync = value.changed;
  state.lastChangeTime = value.changed_at;
  state.isActive = value.active;
}

XrResult haptic(XrSession handle, const XrHapticActionInfo* info) {
  const Session& session = find_session(handle);
  checked(info, XR_TYPE_HAPTIC_ACTION_INFO, "hapticActionInfo");
  const Action& action = find_action(session, info->action, XR_ACTION_TYPE_VIBRATION_OUTPUT);
  check_attached(session, action);
  subaction_of(session, action, info->subactionPath);
  return session.state == XR_SESSION_STATE_FOCUSED ? success(session) : XR_SESSION_NOT_FOCUSED;
}

}  // namespace
}  // namespace test_runtime

XrResult xrSyncActions(XrSession handle, const XrActionsSyncInfo* info) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    checked(info, XR_TYPE_ACTIONS_SYNC_INFO, "syncInfo");
    if (info->countActiveActionSets > 0)
      checked_pointer(info->activeActionSets, "activeActionSets");
    std::vector<uint64_t> active;
    for (uint32_t i = 0; i < info->countActiveActionSets; ++i) {
      const auto& set = context().handles.find<ActionSet>(info->activeActionSets[i].actionSet,
                                                          "activeActionSets");
      if (!std::count(session.action_sets.begin(), session.action_sets.end(), set.handle))
        violation(XR_ERROR_ACTIONSET_NOT_ATTACHED, set.name + " is not attached to the session");
      if (info->activeActionSets[i].subactionPath != XR_NULL_PATH)
        session.instance.text_of(info->activeActionSets[i].subactionPath);
      active.push_back(set.handle);
    }
    const bool focused = session.state == XR_SESSION_STATE_FOCUSED;
    if (focused) choose_profile(session);
    context().handles.each<Action>([&](Action& action) {
      const bool on = focused && std::count(active.begin(), active.end(), action.set.handle);
      sync_action(session, action, "", on);
      for (const std::string& hand : action.subactions) sync_action(session, action, hand, on);
    });
    return focused ? success(session) : XR_SESSION_NOT_FOCUSED;
  });
}

XrResult xrGetActionStateBoolean(XrSession handle, const XrActionStateGetInfo* info,
                                 XrActionStateBoolean* state) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked(state, XR_TYPE_ACTION_STATE_BOOLEAN, "state");
    const ActionValue value = query(session, info, XR_ACTION_TYPE_BOOLEAN_INPUT);
    state->currentState = value.x > 0;
    fill(*state, value);
    return success(session);
  });
}

XrResult xrGetActionStateFloat(XrSession handle, const XrActionStateGetInfo* info,
                               XrActionStateFloat* state) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked(state, XR_TYPE_ACTION_STATE_FLOAT, "state");
    const ActionValue value = query(session, info, XR_ACTION_TYPE_FLOAT_INPUT);
    state->currentState = value.x;
    fill(*state, value);
    return success(session);
  });
}

XrResult xrGetActionStateVector2f(XrSession handle, const XrActionStateGetInfo* info,
                                  XrActionStateVector2f* state) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked(state, XR_TYPE_ACTION_STATE_VECTOR2F, "state");
    const ActionValue value = query(session, info, XR_ACTION_TYPE_VECTOR2F_INPUT);
    state->currentState = {value.x, value.y};
    fill(*state, value);
    return success(session);
  });
}

XrResult xrGetActionStatePose(XrSession handle, const XrActionStateGetInfo* info,
                              XrActionStatePose* state) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked(state, XR_TYPE_ACTION_STATE_POSE, "state");
    state->isActive = query(session, info, XR_ACTION_TYPE_POSE_INPUT).active;
    return success(session);
  });
}

XrResult xrApplyHapticFeedback(XrSession handle, const XrHapticActionInfo* info,
                               const XrHapticBaseHeader* feedback) {
  return call(__func__, [&](auto&) {
    checked(feedback, XR_TYPE_HAPTIC_VIBRATION, "hapticFeedback");
    return haptic(handle, info);
  });
}

XrResult xrStopHapticFeedback(XrSession handle, const XrHapticActionInfo* info) {
  return call(__func__, [&](auto&) { return haptic(handle, info); });
}
