#pragma once
// Controllers: thumbsticks walk, climb and turn, a button recentres. With none, nothing moves.
#include "runtime.h"
#include "traveller.h"

namespace host {

class Input {
 public:
  explicit Input(const Runtime& runtime);

  // Once a session.
  void attach(XrSession session) const;
  // Of this moment. All rest while the session has not the focus.
  Steering read(XrSession session) const;

 private:
  void suggest(const Runtime& runtime) const;

  UniqueXrActionSet actions_;
  XrAction walk_ = XR_NULL_HANDLE, look_ = XR_NULL_HANDLE;  // thumbsticks; the set owns them
  XrAction advance_ = XR_NULL_HANDLE, recentre_ = XR_NULL_HANDLE;
};

}  // namespace host
