#include "run.h"

#include <cstring>

namespace test_runtime {

Run::Run(Script read)
    : script(std::move(read)),
      report(script.report),
      clock(script.period, script.realtime),
      capture(script.output, script.capture, script.local_in_scene),
      failures_(script.failures) {}

int64_t Run::frame(const char* function) const {
  return std::strcmp(function, "xrWaitFrame") == 0 ? waited : frame();
}

XrResult Run::failure(const char* function) {
  for (Failure& failure : failures_) {
    if (failure.times == 0 || failure.call != function || frame(function) < failure.frame) continue;
    if (failure.after > 0) {
      --failure.after;
      continue;
    }
    --failure.times;
    return failure.result;
  }
  return XR_SUCCESS;
}

std::vector<Event> Run::take_events(int64_t up_to) {
  std::vector<Event> taken;
  for (; next_event_ < script.events.size() && script.events[next_event_].frame <= up_to;
       ++next_event_)
    taken.push_back(script.events[next_event_]);
  return taken;
}

Json Run::input(const std::string& path) const {
  Json value;
  for (const Input& input : script.inputs) {
    if (input.frame > frame()) break;
    const auto found = input.values.find(path);
    if (found != input.values.end()) value = found->second;
  }
  return value;
}

const Head& Run::head(XrTime time) const {
  return script.motion[static_cast<size_t>(clock.slot(time)) % script.motion.size()];
}

void Run::write() {
  report.write();
  capture.write_cameras();
}

}  // namespace test_runtime
