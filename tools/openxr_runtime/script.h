#pragma once
// What the runtime is told to do: one JSON file, README.md has every field. A frame's number is
// that of the successful xrWaitFrame that handed it out, from 0, over all sessions of a run.
#include <map>
#include <string>
#include <vector>

#include "json_reader.h"
#include "motion.h"

namespace test_runtime {

struct Range {
  int64_t first, count;
  bool contains(int64_t frame) const { return frame >= first && frame - first < count; }
};
using Ranges = std::vector<Range>;
bool contains(const Ranges& ranges, int64_t frame);

struct Event {
  int64_t frame;
  std::string what;
  int64_t amount = 0;  // restart_polls (-1: never), frames or periods, as `what` needs
  Pose recentred;      // of the new LOCAL in the first one
};

struct Input {
  int64_t frame;
  std::map<std::string, Json> values;  // by user path; held until told otherwise
};

struct Failure {
  std::string call;
  int64_t frame;
  int64_t after;  // calls that are let through
  int64_t times;
  XrResult result;
};

enum class ImageOrder { ascending, descending, shuffled };

struct Script {
  std::string path;  // "" without one
  Motion motion;     // in LOCAL, as it is before any recentring
  Pose local_in_scene;
  // Left, right, left inner, right inner.
  XrExtent2Di recommended[4] = {{512, 544}, {512, 544}, {512, 544}, {512, 544}};
  XrExtent2Di maximum = {4096, 4096};
  std::vector<int64_t> formats;
  std::vector<std::string> extensions;
  int64_t period = 1000000000 / 72;  // nanoseconds
  bool realtime = false;
  XrVersion vulkan[2] = {XR_MAKE_VERSION(1, 0, 0), XR_MAKE_VERSION(1, 4, 0)};  // least, most
  int64_t images = 3;                                                          // of a swapchain
  ImageOrder image_order = ImageOrder::ascending;
  bool image_layouts = true;  // as OpenXR promises
  Ranges hidden = {{0, 3}};
  Ranges position_lost, tracking_lost, image_timeouts, flipped;
  int64_t patience = 2000;  // milliseconds that a second xrWaitFrame waits
  std::vector<Event> events;
  std::vector<Input> inputs;
  std::vector<Failure> failures;
  std::string output, report;  // "" for none
  Ranges capture = {{0, INT64_MAX}};
};

// path "" is the default script. Throws std::runtime_error that names the field.
Script read_script(const std::string& path);

}  // namespace test_runtime
