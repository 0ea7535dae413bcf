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
    throw ApiError(VOY_ERROR_BUSY,
                   std::string(name) + ": found one that is busy in another thread");
  return lock;
}

// The view's state is the caller's while the lock lives.
inline std::unique_lock<std::mutex> claim(ViewObject& view) {
  auto lock = claim_object(view, "view");
  if (!view.view)
    throw ApiError(VOY_ERROR_SCENE_DESTROYED,
                   "view: found one of which a scene was destroyed, expected it to be "
                   "destroyed too");
  return lock;
}

inline void check_has_frame(const ViewObject& view) {
  if (!view.view->has_frame())
    refuse("view: found one that has rendered no frame, expected one that has");
}

}  // namespace voyager
