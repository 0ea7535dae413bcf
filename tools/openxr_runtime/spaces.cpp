#include "spaces.h"

#include <cmath>

#include "actions.h"

using namespace test_runtime;

namespace test_runtime {
namespace {

constexpr double kEyeHeight = 1.6;  // metres; of LOCAL's origin above STAGE's
constexpr XrSpaceLocationFlags kTracked =
    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;

// Hands that hang below the head, and turn with it.
Located locate_action(const Space& space, XrTime time) {
  const std::string hand = bound_hand(space.session, space.action, space.top_level);
  if (hand.empty()) return {{}, 0};
  const double side = hand == "/user/hand/left" ? -0.2 : 0.2;
  return {run().head(time).centre() * Pose{Eigen::Quaterniond::Identity(), {side, -0.3, -0.4}},
          head_tracking(time)};
}

Located locate_reference(const Space& space, XrTime time) {
  switch (space.reference) {
    case XR_REFERENCE_SPACE_TYPE_VIEW:
      return {run().head(time).centre(), head_tracking(time)};
    case XR_REFERENCE_SPACE_TYPE_STAGE:
      return {{Eigen::Quaterniond::Identity(), {0, -kEyeHeight, 0}}, kTracked};
    default:
      break;
  }
  Pose local;
  for (const Recentring& change : space.session.recentrings)
    if (change.from <= time) local = change.local_in_root;
  return {local, kTracked};
}

}  // namespace

Space& find_space(XrSpace handle, const char* name) {
  Space& space = context().handles.find<Space>(handle, name);
  check_not_lost(space.session);
  return space;
}

XrSpaceLocationFlags head_tracking(XrTime time) {
  const Script& script = run().script;
  // The frame that this time belongs to: displayed now, or a period before or after.
  const int64_t away = run().clock.slot(time) - run().clock.slot(run().clock.display_time());
  const int64_t frame = run().frame() + away;
  if (contains(script.tracking_lost, frame)) return 0;
  if (contains(script.position_lost, frame))
    return XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
  return kTracked;
}

Located locate(const Space& space, XrTime time) {
  Located located = space.is_action ? locate_action(space, time) : locate_reference(space, time);
  located.in_root = located.in_root * space.pose;
  return located;
}

void check_time(XrTime time, const char* name) {
  if (time <= 0) violation(XR_ERROR_TIME_INVALID, std::string(name) + ": expected a time above 0");
}

void check_pose(const XrPosef& pose, const std::string& name) {
  const auto& q = pose.orientation;
  const auto& p = pose.position;
  const float norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(norm - 1) <= 0.01f))
    violation(XR_ERROR_POSE_INVALID, name + ".orientation: found length " + std::to_string(norm) +
                                         ", expected 1 within a hundredth");
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
    violation(XR_ERROR_POSE_INVALID, name + ".position: expected finite numbers");
}

}  // namespace test_runtime

XrResult xrEnumerateReferenceSpaces(XrSession handle, uint32_t capacity, uint32_t* count,
                                    XrReferenceSpaceType* spaces) {
  return call(__func__, [&](auto&) {
    find_session(handle);
    constexpr XrReferenceSpaceType kTypes[] = {
        XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL, XR_REFERENCE_SPACE_TYPE_STAGE};
    return enumerate(std::size(kTypes), capacity, count, spaces,
                     [&](size_t i, auto& type) { type = kTypes[i]; });
  });
}

XrResult xrCreateReferenceSpace(XrSession handle, const XrReferenceSpaceCreateInfo* info,
                                XrSpace* created) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    checked(info, XR_TYPE_REFERENCE_SPACE_CREATE_INFO, "createInfo");
    checked_pointer(created, "space");
    if (info->referenceSpaceType < XR_REFERENCE_SPACE_TYPE_VIEW ||
        info->referenceSpaceType > XR_REFERENCE_SPACE_TYPE_STAGE)
      violation(XR_ERROR_REFERENCE_SPACE_UNSUPPORTED,
                "referenceSpaceType: expected VIEW, LOCAL or STAGE");
    check_pose(info->poseInReferenceSpace, "poseInReferenceSpace");
    auto space = std::make_unique<Space>(session);
    space->reference = info->referenceSpaceType;
    space->pose = from_xr(info->poseInReferenceSpace);
    *created = context().handles.add<XrSpace>(std::move(space));
    return success(session);
  });
}

XrResult xrCreateActionSpace(XrSession handle, const XrActionSpaceCreateInfo* info,
                             XrSpace* created) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    checked(info, XR_TYPE_ACTION_SPACE_CREATE_INFO, "createInfo");
    checked_pointer(created, "space");
    const Action& action = find_action(session, info->action, XR_ACTION_TYPE_POSE_INPUT);
    check_pose(info->poseInActionSpace, "poseInActionSpace");
    auto space = std::make_unique<Space>(session);
    space->is_action = true;
    space->action = action.handle;
    space->top_level = subaction_of(session, action, info->subactionPath);
    space->pose = from_xr(info->poseInActionSpace);
    *created = context().handles.add<XrSpace>(std::move(space));
    return success(session);
  });
}

XrResult xrDestroySpace(XrSpace handle) {
  return call(__func__, [&](auto&) {
    context().handles.destroy(context().handles.find<Space>(handle, "space").handle);
    return XR_SUCCESS;
  });
}

XrResult xrGetReferenceSpaceBoundsRect(XrSession handle, XrReferenceSpaceType type,
                                       XrExtent2Df* bounds) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked_pointer(bounds, "bounds") = {0, 0};
    if (type < XR_REFERENCE_SPACE_TYPE_VIEW || type > XR_REFERENCE_SPACE_TYPE_STAGE)
      violation(XR_ERROR_REFERENCE_SPACE_UNSUPPORTED,
                "referenceSpaceType: expected VIEW, LOCAL or STAGE");
    if (type != XR_REFERENCE_SPACE_TYPE_STAGE) return XR_SPACE_BOUNDS_UNAVAILABLE;
    *bounds = {2, 2};
    return success(session);
  });
}

XrResult xrLocateSpace(XrSpace handle, XrSpace base_handle, XrTime time,
                       XrSpaceLocation* location) {
  return call(__func__, [&](auto&) {
    const Space& space = find_space(handle, "space");
    const Space& base = find_space(base_handle, "baseSpace");
    checked(location, XR_TYPE_SPACE_LOCATION, "location");
    check_time(time, "time");
    const Located what = locate(space, time), in = locate(base, time);
    location->pose = to_xr(in.in_root.inverse() * what.in_root);
    location->locationFlags = what.flags & in.flags;
    return success(space.session);
  });
}
