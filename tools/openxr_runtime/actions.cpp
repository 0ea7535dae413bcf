#include "actions.h"

#include <algorithm>

using namespace test_runtime;

namespace test_runtime {
namespace {

// Of an array that the application filled: with an end, and with something in it.
std::string text_in(const char* text, size_t size, XrResult result, const char* name) {
  std::string found(text, strnlen(text, size));
  if (found.size() == size) violation(XR_ERROR_VALIDATION_FAILURE, std::string(name) + ": no end");
  if (found.empty()) violation(result, std::string(name) + ": found none");
  return found;
}

std::string name_in(const char* text, size_t size, const char* name) {
  std::string found = text_in(text, size, XR_ERROR_NAME_INVALID, name);
  for (const char c : found)
    if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.'))
      violation(XR_ERROR_PATH_FORMAT_INVALID,
                std::string(name) + ": found " + found + ", expected letters of a path");
  return found;
}

template <class T>
void check_names(const T& made, const Object* parent) {
  context().handles.each<T>([&](T& other) {
    if (other.parent != parent) return;
    if (other.name == made.name)
      violation(XR_ERROR_NAME_DUPLICATED, "the name " + made.name + " is taken");
    if (other.localized_name == made.localized_name)
      violation(XR_ERROR_LOCALIZED_NAME_DUPLICATED,
                "the localised name " + made.localized_name + " is taken");
  });
}

bool is_action_type(XrActionType type) {
  for (const XrActionType known :
       {XR_ACTION_TYPE_BOOLEAN_INPUT, XR_ACTION_TYPE_FLOAT_INPUT, XR_ACTION_TYPE_VECTOR2F_INPUT,
        XR_ACTION_TYPE_POSE_INPUT, XR_ACTION_TYPE_VIBRATION_OUTPUT})
    if (type == known) return true;
  return false;
}

bool is_top_level(const std::string& path) {
  for (const char* known : {"/user/hand/left", "/user/hand/right", "/user/head", "/user/gamepad"})
    if (path == known) return true;
  return false;
}

void read_subactions(const XrActionCreateInfo& info, const Instance& instance, Action& action) {
  for (uint32_t i = 0; i < info.countSubactionPaths; ++i) {
    const std::string& path =
        instance.text_of((&checked_pointer(info.subactionPaths, "subactionPaths"))[i]);
    if (!is_top_level(path) || std::count(action.subactions.begin(), action.subactions.end(), path))
      violation(XR_ERROR_PATH_UNSUPPORTED,
                "subactionPaths: found " + path + ", expected each top level user path once");
    action.subactions.push_back(path);
  }
}

}  // namespace

Action& find_action(const Session& session, XrAction handle, XrActionType type) {
  Action& action = context().handles.find<Action>(handle, "action");
  if (&action.set.instance != &session.instance)
    violation(XR_ERROR_HANDLE_INVALID, "action: expected one of this instance");
  if (action.type != type)
    violation(XR_ERROR_ACTION_TYPE_MISMATCH, "action: " + action.name + " is of another type");
  return action;
}

void check_attached(const Session& session, const Action& action) {
  const auto& sets = session.action_sets;
  if (std::find(sets.begin(), sets.end(), action.set.handle) == sets.end())
    violation(XR_ERROR_ACTIONSET_NOT_ATTACHED,
              "the action set " + action.set.name + " is not attached to the session");
}

std::string subaction_of(const Session& session, const Action& action, XrPath path) {
  if (path == XR_NULL_PATH) return "";
  const std::string& text = session.instance.text_of(path);
  if (std::find(action.subactions.begin(), action.subactions.end(), text) ==
      action.subactions.end())
    violation(XR_ERROR_PATH_UNSUPPORTED,
              "subactionPath: found " + text + ", " + action.name + " was not created with it");
  return text;
}

}  // namespace test_runtime

XrResult xrCreateActionSet(XrInstance handle, const XrActionSetCreateInfo* info,
                           XrActionSet* created) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    checked(info, XR_TYPE_ACTION_SET_CREATE_INFO, "createInfo");
    checked_pointer(created, "actionSet");
    auto set = std::make_unique<ActionSet>(instance);
    set->name = name_in(info->actionSetName, sizeof info->actionSetName, "actionSetName");
    set->localized_name = text_in(info->localizedActionSetName, sizeof info->localizedActionSetName,
                                  XR_ERROR_LOCALIZED_NAME_INVALID, "localizedActionSetName");
    check_names(*set, &instance);
    *created = context().handles.add<XrActionSet>(std::move(set));
    return XR_SUCCESS;
  });
}

XrResult xrDestroyActionSet(XrActionSet handle) {
  return call(__func__, [&](auto&) {
    context().handles.destroy(context().handles.find<ActionSet>(handle, "actionSet").handle);
    return XR_SUCCESS;
  });
}

XrResult xrCreateAction(XrActionSet handle, const XrActionCreateInfo* info, XrAction* created) {
  return call(__func__, [&](auto&) {
    ActionSet& set = context().handles.find<ActionSet>(handle, "actionSet");
    checked(info, XR_TYPE_ACTION_CREATE_INFO, "createInfo");
    checked_pointer(created, "action");
    if (set.attached)
      violation(XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "the action set is attached already");
    auto action = std::make_unique<Action>(set);
    action->name = name_in(info->actionName, sizeof info->actionName, "actionName");
    action->localized_name = text_in(info->localizedActionName, sizeof info->localizedActionName,
                                     XR_ERROR_LOCALIZED_NAME_INVALID, "localizedActionName");
    action->type = info->actionType;
    if (!is_action_type(action->type))
      violation(XR_ERROR_VALIDATION_FAILURE, "actionType: expected one of OpenXR 1.0");
    read_subactions(*info, set.instance, *action);
    check_names(*action, &set);
    *created = context().handles.add<XrAction>(std::move(action));
    return XR_SUCCESS;
  });
}

XrResult xrDestroyAction(XrAction handle) {
  return call(__func__, [&](auto&) {
    context().handles.destroy(context().handles.find<Action>(handle, "action").handle);
    return XR_SUCCESS;
  });
}
