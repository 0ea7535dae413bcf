#include <algorithm>
#include <array>

#include "actions.h"

using namespace test_runtime;

namespace test_runtime {
namespace {

bool known_profile(const std::string& path) {
  return std::find(std::begin(kProfiles), std::end(kProfiles), path) != std::end(kProfiles);
}

bool in_profile(const Source& source, const std::string& profile) {
  for (size_t i = 0; i < std::size(kProfiles); ++i)
    if (profile == kProfiles[i]) return source.profiles >> i & 1;
  return false;
}

// A press is half way; a number is 0 or 1.
bool convertible(XrActionType source, XrActionType action) {
  const auto scalar = [](XrActionType type) {
    return type == XR_ACTION_TYPE_BOOLEAN_INPUT || type == XR_ACTION_TYPE_FLOAT_INPUT;
  };
  return source == action || (scalar(source) && scalar(action));
}

}  // namespace

const Source* resolve(const std::string& profile, const std::string& path, XrActionType type) {
  for (const char* component : {"", "/value", "/click", "/pose"}) {
    const Source* source = find_source(path + component);
    if (source && in_profile(*source, profile) && convertible(source->type, type)) return source;
  }
  return nullptr;
}

std::vector<const Source*> bound_sources(const Session& session, const Action& action,
                                         const std::string& top_level) {
  std::vector<const Source*> sources;
  const auto suggested = session.instance.suggested.find(session.profile);
  if (suggested == session.instance.suggested.end()) return sources;
  for (const auto& [path, bound] : suggested->second)
    if (bound == action.handle && path.rfind(top_level, 0) == 0)
      sources.push_back(resolve(session.profile, path, action.type));
  return sources;
}

bool hand_active(const std::string& path) {
  const char* hand = path.rfind("/user/hand/left", 0) == 0 ? "/user/hand/left" : "/user/hand/right";
  const Json present = run().input(hand);
  return present.is_null() || present.get<bool>();
}

std::string bound_hand(const Session& session, uint64_t action, const std::string& top_level) {
  const auto& found =
      context().handles.find<Action>(Handles::handle_of<XrAction>(action), "action");
  for (const Source* source : bound_sources(session, found, top_level)) {
    const std::string path = source->path;
    if (hand_active(path)) return path.substr(0, path.find("/input"));
  }
  return "";
}

}  // namespace test_runtime

XrResult xrSuggestInteractionProfileBindings(XrInstance handle,
                                             const XrInteractionProfileSuggestedBinding* info) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    checked(info, XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING, "suggestedBindings");
    const std::string& profile = instance.text_of(info->interactionProfile);
    if (profile.rfind("/interaction_profiles/", 0) != 0)
      violation(XR_ERROR_PATH_UNSUPPORTED, "interactionProfile: found " + profile);
    if (info->countSuggestedBindings == 0)
      violation(XR_ERROR_VALIDATION_FAILURE, "countSuggestedBindings: expected at least 1");
    checked_pointer(info->suggestedBindings, "suggestedBindings");
    std::vector<std::pair<std::string, uint64_t>> bindings;
    for (uint32_t i = 0; i < info->countSuggestedBindings; ++i) {
      const auto& [action_handle, path] = info->suggestedBindings[i];
      const Action& action = context().handles.find<Action>(action_handle, "action");
      const std::string& text = instance.text_of(path);
      if (action.set.attached)
        violation(XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "the action set is attached already");
      // Other profiles of the registry are taken as they come, and never chosen.
      if (known_profile(profile) && !resolve(profile, text, action.type))
        violation(XR_ERROR_PATH_UNSUPPORTED, std::string("found ")
                                                 .append(text)
                                                 .append(", expected a path of ")
                                                 .append(profile)
                                                 .append(" for ")
                                                 .append(action.name));
      bindings.emplace_back(text, action.handle);
    }
    instance.suggested[profile] = bindings;
    return XR_SUCCESS;
  });
}

XrResult xrAttachSessionActionSets(XrSession handle, const XrSessionActionSetsAttachInfo* info) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    checked(info, XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, "attachInfo");
    if (session.attached)
      violation(XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "action sets are attached already");
    if (info->countActionSets == 0)
      violation(XR_ERROR_VALIDATION_FAILURE, "countActionSets: expected at least 1");
    checked_pointer(info->actionSets, "actionSets");
    std::vector<uint64_t> sets;
    for (uint32_t i = 0; i < info->countActionSets; ++i)
      sets.push_back(context().handles.find<ActionSet>(info->actionSets[i], "actionSets").handle);
    for (const uint64_t set : sets)
      context()
          .handles.find<ActionSet>(Handles::handle_of<XrActionSet>(set), "actionSets")
          .attached = true;
    session.attached = true;
    session.action_sets = sets;
    return success(session);
  });
}

XrResult xrGetCurrentInteractionProfile(XrSession handle, XrPath path,
                                        XrInteractionProfileState* profile) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked(profile, XR_TYPE_INTERACTION_PROFILE_STATE, "interactionProfile");
    const std::string& hand = session.instance.text_of(path);
    if (!session.attached)
      violation(XR_ERROR_ACTIONSET_NOT_ATTACHED, "no action set is attached to the session");
    if (hand.rfind("/user/", 0) != 0)
      violation(XR_ERROR_PATH_UNSUPPORTED, "topLevelUserPath: found " + hand);
    const bool held = hand.rfind("/user/hand/", 0) == 0 && hand_active(hand);
    profile->interactionProfile =
        held && !session.profile.empty() ? session.instance.path(session.profile) : XR_NULL_PATH;
    return success(session);
  });
}

XrResult xrEnumerateBoundSourcesForAction(XrSession handle,
                                          const XrBoundSourcesForActionEnumerateInfo* info,
                                          uint32_t capacity, uint32_t* count, XrPath* paths) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked(info, XR_TYPE_BOUND_SOURCES_FOR_ACTION_ENUMERATE_INFO, "enumerateInfo");
    const Action& action = context().handles.find<Action>(info->action, "action");
    check_attached(session, action);
    const auto sources = bound_sources(session, action, "");
    return enumerate(sources.size(), capacity, count, paths, [&](size_t i, XrPath& path) {
      path = session.instance.path(sources[i]->path);
    });
  });
}

XrResult xrGetInputSourceLocalizedName(XrSession handle,
                                       const XrInputSourceLocalizedNameGetInfo* info,
                                       uint32_t capacity, uint32_t* count, char* buffer) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked(info, XR_TYPE_INPUT_SOURCE_LOCALIZED_NAME_GET_INFO, "getInfo");
    if (info->whichComponents == 0)
      violation(XR_ERROR_VALIDATION_FAILURE, "whichComponents: expected one at least");
    if (!session.attached)
      violation(XR_ERROR_ACTIONSET_NOT_ATTACHED, "no action set is attached to the session");
    const std::string& text = session.instance.text_of(info->sourcePath);
    return enumerate(text.size() + 1, capacity, count, buffer,
                     [&](size_t i, char& c) { c = text.c_str()[i]; });
  });
}
