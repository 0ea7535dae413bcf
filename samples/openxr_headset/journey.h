#pragma once
// What outlives sessions and instances: the options, the start, what was recorded and counted.
#include <chrono>
#include <optional>

#include "camera_file.h"
#include "options.h"
#include "recorder.h"
#include "statistics.h"
#include "traveller.h"

namespace host {

// Throws Failure once nothing has been heard of for too long.
class Patience {
 public:
  void renew() { since_ = std::chrono::steady_clock::now(); }
  void excuse(std::chrono::steady_clock::duration time) { since_ += time; }  // our own work
  void check(const std::string& what) const;

 private:
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

struct Journey {
  explicit Journey(const Options& options);

  bool finished() const { return options.frames > 0 && statistics.frames() >= options.frames; }

  const Options& options;
  std::vector<Camera> cameras;
  std::optional<Recorder> recorder;
  std::optional<Traveller> traveller;  // once there is a scene
  Statistics statistics;
  Patience patience;
  std::string modes;   // how frames were handed over
  std::string detail;  // of the last session's last frame
};

}  // namespace host
