#pragma once
// Action sets and actions, and the sources that they are bound to.
#include <string>
#include <vector>

#include "profiles.h"
#include "session.h"

namespace test_runtime {

struct ActionSet final : Object {
  explicit ActionSet(Instance& of) : Object(&of), instance(of) {}

  Instance& instance;
  std::string name, localized_name;
  bool attached = false;  // to a session, for ever
};

struct Action final : Object {
  explicit Action(ActionSet& of) : Object(&of), set(of) {}

  ActionSet& set;
  std::string name, localized_name;
  XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT;
  std::vector<std::string> subactions;
};

// A live one of the session's, of this type, in an attached set for state queries.
Action& find_action(const Session& session, XrAction handle, XrActionType type);
void check_attached(const Session& session, const Action& action);
// A subaction path of the action's, or "" for XR_NULL_PATH.
std::string subaction_of(const Session& session, const Action& action, XrPath path);

// The source that a suggested path means for an action of this type in a profile, or nullptr: a
// component's parent stands for the component.
const Source* resolve(const std::string& profile, const std::string& path, XrActionType type);
// Of the current profile; those of one hand only where top_level is not "".
std::vector<const Source*> bound_sources(const Session& session, const Action& action,
                                         const std::string& top_level);
// The top level path of the hand that a pose action follows; "" for none.
std::string bound_hand(const Session& session, uint64_t action, const std::string& top_level);
bool hand_active(const std::string& path);  // the script has not put the controller away

}  // namespace test_runtime
