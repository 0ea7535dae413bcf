#pragma once
// The command line.
#include <cstdint>
#include <optional>
#include <string>

namespace host {

struct Options {
  std::string scene;
  std::string camera_file;  // or empty: the start is in the middle of the scene
  std::string readback;     // a folder, or empty
  bool fixed_pose = false;
  bool quad_views = false;  // two pictures an eye; else one
  bool validation = false;
  uint64_t frames = 0;  // 0: until the player leaves
  double tau = 3;
  double time_budget = 0;       // milliseconds a frame in place of tau; 0 is none
  bool follows_display = true;  // neither was given: its period says how long a frame may take
  double budget_megabytes = 0;  // of scene data, which is streamed then; 0: no limit
};

// Nothing where --help was printed. Throws CLI::ParseError.
std::optional<Options> parse_options(int argc, char** argv);

}  // namespace host
