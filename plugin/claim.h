#pragma once
// A view, or a target, serves one thread at a time.
#include <mutex>

#include "plugin/field_name.h"
#include "plugin/objects.h"
#include "plugin/result.h"

namespace voyager {

template <class T>
std::unique_lock<std::mutex> claim_object(T& object, const FieldName& name) {
  std::unique_lock lock(object.busy, std::try_to_lock);
  if (!lock)
    throw ApiError(VOY_ERROR_BUSY,
                   name.str() + ": found it in use by another thread, expected it to be free");
  return lock;
}

struct ViewClaim {
  std::unique_lock<std::mutex> call, state;
};

// The view's state is the caller's while the claim lives. The closing of a scene on another
// thread is waited for: to the host, that is no use of the view.
inline ViewClaim claim_for_instances(ViewObject& view) {
  ViewClaim claim;
  claim.call = claim_object(view, "view");
  claim.state = std::unique_lock(view.state);
  if (!view.view)
    throw ApiError(VOY_ERROR_SCENE_CLOSED,
                   "view: found a view that closing a scene has left unusable, expected it to be "
                   "destroyed");
  return claim;
}

// The same for all but what gives the view other instances.
inline ViewClaim claim(ViewObject& view) {
  ViewClaim claim = claim_for_instances(view);
  if (view.scene_lost)
    throw ApiError(VOY_ERROR_SCENE_CLOSED,
                   "view: found that a scene was closed, expected voySetViewInstances to set "
                   "instances without it, or the view to be destroyed, too");
  return claim;
}

inline void check_has_frame(const ViewObject& view) {
  if (!view.view->has_frame())
    refuse("view: found a view without a rendered frame, expected voyRenderFrame before this call");
}

}  // namespace voyager
