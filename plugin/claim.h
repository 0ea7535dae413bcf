#pragma once
// A view, or a target, serves one thread at a time.
#include <mutex>

#include "plugin/objects.h"
#include "plugin/result.h"

namespace voyager {

template <class T>
std::unique_lock<std::mutex> claim_object(T& object, const char* name) {
  std::unique_lock lock(object.busy, std::try_to_lock);
  if (!lock)
    throw ApiError(
        VOY_ERROR_BUSY,
        std::string(name) + ": found it in use by another thread, expected it to be free");
  return lock;
}

// The view's state is the caller's while the lock lives.
inline std::unique_lock<std::mutex> claim(ViewObject& view) {
  auto lock = claim_object(view, "view");
  if (!view.view)
    throw ApiError(
        VOY_ERROR_SCENE_DESTROYED,
        "view: found that a scene was destroyed, expected the view to be destroyed, too");
  return lock;
}

inline void check_has_frame(const ViewObject& view) {
  if (!view.view->has_frame())
    refuse("view: found a view without a rendered frame, expected voyRenderFrame before this call");
}

}  // namespace voyager
