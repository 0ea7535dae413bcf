#pragma once
// What `voyager view` was asked.
#include <CLI/CLI.hpp>
#include <string>

#include "tools/image_size.h"
#include "voyager/voyager.h"

namespace voyager::view {

inline constexpr double kLeastBudget = 1e-6, kLargestBudget = 1e9;  // MB
inline constexpr double kLongestFrame = 1e9;                        // milliseconds
inline constexpr size_t kMostFrames = 1'000'000;

struct ViewOptions {
  std::string scene;    // "": none yet
  std::string cameras;  // bookmarks from the start; "": none
  int64_t camera = 0;
  tools::ImageSize size{1280, 720};
  VoyBackend backend = VOY_BACKEND_AUTO;
  std::string gpu;  // the Vulkan device whose name has this in it
  double tau = 3;
  double milliseconds = 0;  // 0: tau is fixed
  VoyAntialias antialias = VOY_ANTIALIAS_ON;
  double budget = 4000;  // MB
  std::string keep;      // where a bake is written; "": the cache folder
  std::string script;
  size_t frames = 0;       // after which the window closes; 0: it stays, or until nothing changes
  std::string screenshot;  // saved then; "": none
  bool validation = false;
};

void add_view_options(CLI::App& command, ViewOptions& options);

}  // namespace voyager::view
