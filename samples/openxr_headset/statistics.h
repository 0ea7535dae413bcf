#pragma once
// What the frames took, and which display times they missed.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "xr.h"

namespace host {

class Statistics {
 public:
  // When xrWaitFrame returns: display periods between the last frame's and this one's are missed.
  void waited(const XrFrameState& state);
  // The session begins anew: the gap before its first frame is none.
  void begun() { last_.reset(); }
  // Of a frame with a picture: from xrWaitFrame's return to xrEndFrame's.
  void shown(double milliseconds) { milliseconds_.push_back(milliseconds); }
  void empty() { ++empty_; }  // a frame that showed nothing
  void restarted() { ++restarts_; }
  void lost() { ++losses_; }

  uint64_t frames() const { return milliseconds_.size(); }
  std::string summary() const;

 private:
  double percentile(double share) const;  // of at least one frame

  std::vector<double> milliseconds_;
  std::optional<XrTime> last_;
  uint64_t missed_ = 0, empty_ = 0, restarts_ = 0, losses_ = 0;
};

}  // namespace host
