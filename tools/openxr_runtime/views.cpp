#include <utility>

#include "spaces.h"

using namespace test_runtime;

XrResult xrLocateViews(XrSession handle, const XrViewLocateInfo* info, XrViewState* state,
                       uint32_t capacity, uint32_t* count, XrView* views) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    checked(info, XR_TYPE_VIEW_LOCATE_INFO, "viewLocateInfo");
    checked(state, XR_TYPE_VIEW_STATE, "viewState");
    check_view_configuration(session.instance, info->viewConfigurationType);
    if (session.running && info->viewConfigurationType != session.configuration)
      remark("viewConfigurationType is not the one that the session was begun with");
    check_time(info->displayTime, "displayTime");
    const Space& space = find_space(info->space, "viewLocateInfo->space");
    const Located base = locate(space, info->displayTime);
    // View state and space location flags have the same bits.
    state->viewStateFlags = base.flags & head_tracking(info->displayTime);
    const Head& head = run().head(info->displayTime);
    const XrResult result =
        enumerate(view_count(info->viewConfigurationType), capacity, count, views,
                  [&](size_t i, XrView& view) {
                    checked(&view, XR_TYPE_VIEW, "views");
                    const Eye eye = head.view(i);
                    view.pose = to_xr(base.in_root.inverse() * eye.pose);
                    view.fov = eye.fov();
                    if (contains(run().script.flipped, run().frame()))
                      std::swap(view.fov.angleUp, view.fov.angleDown);
                    // Where nothing is known, an application must not use what it finds.
                    if (!(state->viewStateFlags & XR_VIEW_STATE_POSITION_VALID_BIT))
                      view.pose.position = {};
                    if (!(state->viewStateFlags & XR_VIEW_STATE_ORIENTATION_VALID_BIT))
                      view.pose.orientation = {0, 0, 0, 1};
                  });
    return result == XR_SUCCESS ? success(session) : result;
  });
}
