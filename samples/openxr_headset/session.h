#pragma once
// An OpenXR session: its state as the runtime's events drive it, LOCAL space, frame calls.
#include <optional>
#include <vector>

#include "graphics.h"
#include "input.h"

namespace host {

// All views at one time, in LOCAL space: left and right eye by turns, outer before inner.
using Views = std::vector<XrView>;

struct Located {
  Views views;
  bool position_known;  // else the positions mean nothing
};

class Session {
 public:
  Session(const Runtime& runtime, const Graphics& graphics, const Input& input);

  XrSession get() const { return session_.get(); }
  XrSpace local() const { return local_.get(); }
  std::vector<int64_t> swapchain_formats() const;

  // Begins and ends the session as the state asks. Throws Lost where it is to be lost.
  void handle(const XrEventDataSessionStateChanged& event);
  bool running() const { return running_; }  // frames are to be waited for
  XrSessionState state() const { return state_; }
  bool focused() const { return state_ == XR_SESSION_STATE_FOCUSED; }
  bool exiting() const { return state_ == XR_SESSION_STATE_EXITING; }
  uint64_t begun() const { return begun_; }  // how often
  void request_exit();

  XrFrameState wait_frame() const;
  void begin_frame() const;
  // layer: NULL shows nothing.
  void end_frame(XrTime display_time, const XrCompositionLayerProjection* layer) const;
  // None where the runtime does not know which way the head looks.
  std::optional<Located> locate(XrTime display_time) const;

 private:
  const Runtime& runtime_;
  UniqueXrSession session_;
  UniqueXrSpace local_;
  XrSessionState state_ = XR_SESSION_STATE_IDLE;
  bool running_ = false;
  uint64_t begun_ = 0;
};

const char* state_name(XrSessionState state);

}  // namespace host
