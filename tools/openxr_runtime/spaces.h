#pragma once
// XrSpace: where things are. All are resolved to the root, which is LOCAL before any recentring.
#include "session.h"

namespace test_runtime {

struct Space final : Object {
  explicit Space(Session& of) : Object(&of), session(of) {}

  Session& session;
  bool is_action = false;
  XrReferenceSpaceType reference = XR_REFERENCE_SPACE_TYPE_LOCAL;
  uint64_t action = 0;    // of an action space
  std::string top_level;  // its subaction path, or ""
  Pose pose;              // in the reference space or action
};

// A live one, refused once its session is lost.
Space& find_space(XrSpace handle, const char* name);

struct Located {
  Pose in_root;
  XrSpaceLocationFlags flags;
};
Located locate(const Space& space, XrTime time);
// What the script says of the head's tracking at this time.
XrSpaceLocationFlags head_tracking(XrTime time);
void check_time(XrTime time, const char* name);
// Refuses what is not finite, or no unit quaternion within a hundredth.
void check_pose(const XrPosef& pose, const std::string& name);

}  // namespace test_runtime
