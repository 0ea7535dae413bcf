#pragma once
// One script being played, with its report, over every instance that names it: after a loss the
// application starts again, and the frames go on.
#include "capture.h"
#include "clock.h"
#include "report.h"
#include "script.h"

namespace test_runtime {

class Run {
 public:
  explicit Run(Script read);

  // The current frame; for xrWaitFrame the one that it is about to hand out.
  int64_t frame(const char* function) const;
  int64_t frame() const { return waited > 0 ? waited - 1 : 0; }
  // What the script has this call return instead, or XR_SUCCESS.
  XrResult failure(const char* function);
  // The events of frames up to this one that have not been taken yet.
  std::vector<Event> take_events(int64_t up_to);
  // The held value of an input source at the current frame; null where the script has none.
  Json input(const std::string& path) const;
  // Where the head is when this time is displayed.
  const Head& head(XrTime time) const;
  void write();

  const Script script;
  Report report;
  Clock clock;
  Capture capture;
  int64_t waited = 0;  // frames handed out

 private:
  std::vector<Failure> failures_;
  size_t next_event_ = 0;
};

}  // namespace test_runtime
