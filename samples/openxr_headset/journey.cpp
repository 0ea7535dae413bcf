#include "journey.h"

namespace host {

void Patience::check(const std::string& what) const {
  constexpr std::chrono::seconds kLongest(60);
  if (std::chrono::steady_clock::now() - since_ > kLongest)
    throw Failure(kMachine, "found " + what + " for 60 s, expected a frame to show");
}

Journey::Journey(const Options& chosen) : options(chosen) {
  // Files first: what is refused is refused before any device is made.
  if (!options.camera_file.empty()) cameras = read_cameras(options.camera_file);
  if (!options.readback.empty())
    recorder.emplace(options.readback,
                     std::vector<std::string>{options.scene, options.camera_file});
}

}  // namespace host
