#include "input.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace host {
namespace {

XrAction make_action(XrActionSet set, XrActionType type, const char* name, const char* shown) {
  XrActionCreateInfo info = xr_struct<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
  info.actionType = type;
  std::strcpy(info.actionName, name);
  std::strcpy(info.localizedActionName, shown);
  XrAction action = XR_NULL_HANDLE;
  check(xrCreateAction(set, &info, &action), "xrCreateAction");
  return action;
}

XrPath to_path(XrInstance instance, const char* text) {
  XrPath path = XR_NULL_PATH;
  check(xrStringToPath(instance, text, &path), "xrStringToPath");
  return path;
}

bool read_button(XrSession session, XrAction action) {
  XrActionStateGetInfo info = xr_struct<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
  info.action = action;
  auto state = xr_struct<XrActionStateBoolean>(XR_TYPE_ACTION_STATE_BOOLEAN);
  check(xrGetActionStateBoolean(session, &info, &state), "xrGetActionStateBoolean");
  return state.isActive && state.currentState;
}

XrVector2f read_stick(XrSession session, XrAction action) {
  XrActionStateGetInfo info = xr_struct<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
  info.action = action;
  auto state = xr_struct<XrActionStateVector2f>(XR_TYPE_ACTION_STATE_VECTOR2F);
  check(xrGetActionStateVector2f(session, &info, &state), "xrGetActionStateVector2f");
  return state.isActive ? state.currentState : XrVector2f{0, 0};
}

// A thumb's rest is not quite the middle.
double deflection(float value) {
  constexpr double kDead = 0.15;
  const double size = std::min(std::abs(double{value}), 1.0);
  return size < kDead ? 0 : std::copysign((size - kDead) / (1 - kDead), value);
}

}  // namespace

Input::Input(const Runtime& runtime) {
  XrActionSetCreateInfo info = xr_struct<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
  std::strcpy(info.actionSetName, "explore");
  std::strcpy(info.localizedActionSetName, "Explore");
  XrActionSet set = XR_NULL_HANDLE;
  check(xrCreateActionSet(runtime.get(), &info, &set), "xrCreateActionSet");
  actions_ = UniqueXrActionSet(set);
  walk_ = make_action(set, XR_ACTION_TYPE_VECTOR2F_INPUT, "walk", "Walk");
  look_ = make_action(set, XR_ACTION_TYPE_VECTOR2F_INPUT, "turn_and_climb", "Turn and climb");
  advance_ = make_action(set, XR_ACTION_TYPE_BOOLEAN_INPUT, "advance", "Walk ahead");
  recentre_ = make_action(set, XR_ACTION_TYPE_BOOLEAN_INPUT, "recentre", "Recentre");
  suggest(runtime);
}

void Input::suggest(const Runtime& runtime) const {
  struct Binding {
    XrAction action;
    const char* path;
  };
  const struct {
    const char* profile;
    std::vector<Binding> bindings;
  } suggestions[] = {{"/interaction_profiles/khr/simple_controller",
                      {{advance_, "/user/hand/left/input/select/click"},
                       {advance_, "/user/hand/right/input/select/click"},
                       {recentre_, "/user/hand/left/input/menu/click"},
                       {recentre_, "/user/hand/right/input/menu/click"}}},
                     {"/interaction_profiles/oculus/touch_controller",
                      {{walk_, "/user/hand/left/input/thumbstick"},
                       {look_, "/user/hand/right/input/thumbstick"},
                       {recentre_, "/user/hand/right/input/thumbstick/click"}}},
                     {"/interaction_profiles/valve/index_controller",
                      {{walk_, "/user/hand/left/input/thumbstick"},
                       {look_, "/user/hand/right/input/thumbstick"},
                       {recentre_, "/user/hand/right/input/thumbstick/click"}}},
                     {"/interaction_profiles/microsoft/motion_controller",
                      {{walk_, "/user/hand/left/input/thumbstick"},
                       {look_, "/user/hand/right/input/thumbstick"},
                       {recentre_, "/user/hand/right/input/thumbstick/click"}}},
                     {"/interaction_profiles/htc/vive_controller",
                      {{walk_, "/user/hand/left/input/trackpad"},
                       {look_, "/user/hand/right/input/trackpad"},
                       {recentre_, "/user/hand/right/input/menu/click"}}},
                     {"/interaction_profiles/microsoft/xbox_controller",
                      {{walk_, "/user/gamepad/input/thumbstick_left"},
                       {look_, "/user/gamepad/input/thumbstick_right"},
                       {recentre_, "/user/gamepad/input/thumbstick_right/click"}}}};
  for (const auto& suggestion : suggestions) {
    std::vector<XrActionSuggestedBinding> bindings;
    for (const Binding& binding : suggestion.bindings)
      bindings.push_back({binding.action, to_path(runtime.get(), binding.path)});
    auto info = xr_struct<XrInteractionProfileSuggestedBinding>(
        XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
    info.interactionProfile = to_path(runtime.get(), suggestion.profile);
    info.countSuggestedBindings = static_cast<uint32_t>(bindings.size());
    info.suggestedBindings = bindings.data();
    const XrResult result = xrSuggestInteractionProfileBindings(runtime.get(), &info);
    // A runtime need not know every controller.
    if (result != XR_ERROR_PATH_UNSUPPORTED) check(result, "xrSuggestInteractionProfileBindings");
  }
}

void Input::attach(XrSession session) const {
  const XrActionSet set = actions_.get();
  auto info = xr_struct<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
  info.countActionSets = 1;
  info.actionSets = &set;
  check(xrAttachSessionActionSets(session, &info), "xrAttachSessionActionSets");
}

Steering Input::read(XrSession session) const {
  const XrActiveActionSet active = {actions_.get(), XR_NULL_PATH};
  XrActionsSyncInfo info = xr_struct<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
  info.countActiveActionSets = 1;
  info.activeActionSets = &active;
  if (check(xrSyncActions(session, &info), "xrSyncActions") == XR_SESSION_NOT_FOCUSED) return {};
  const XrVector2f walk = read_stick(session, walk_), look = read_stick(session, look_);
  Steering steering;
  steering.right = deflection(walk.x);
  steering.forward = read_button(session, advance_) ? 1 : deflection(walk.y);
  steering.up = deflection(look.y);
  steering.turn = look.x;
  steering.recentre = read_button(session, recentre_);
  return steering;
}

}  // namespace host
