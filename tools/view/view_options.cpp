#include "tools/view/view_options.h"

#include "tools/options.h"

namespace voyager::view {
namespace {

using namespace voyager::tools;

void add_common(CLI::App& command, ViewOptions& options) {
  command.add_option("scene", options.scene,
                     "Scene to look at: a .voy, a flat scene of any format that is read, or the "
                     "URL of one. More can be dropped on the window");
  CLI::Option* cameras =
      command
          .add_option("--cameras", options.cameras,
                      "Bookmarks to begin with, as a cameras.json of 3DGS (INRIA). Without it the "
                      "first view is from above at an angle")
          ->type_name("FILE");
  add_camera_option(command, options.camera)->needs(cameras);
  add_size_option(command, options.size)
      ->description("Size of the window in pixels")
      ->default_str("1280x720");
  add_choice<VoyBackend>(
      command, "--backend", options.backend,
      {{"auto", VOY_BACKEND_AUTO}, {"cpu", VOY_BACKEND_CPU}, {"cuda", VOY_BACKEND_CUDA}},
      "What draws the scene. auto is CUDA if there is a device for it, else the CPU");
  command
      .add_option("--gpu", options.gpu,
                  "Show the window with the Vulkan device whose name has this in it")
      ->type_name("NAME");
  add_tau_or_budget_options(command, options.tau, options.milliseconds);
  add_choice<VoyAntialias>(command, "--antialias", options.antialias,
                           {{"on", VOY_ANTIALIAS_ON}, {"off", VOY_ANTIALIAS_OFF}},
                           "off is the picture of 3DGS, in which what is smaller than a pixel "
                           "swells");
  name_group(command, kCommonOptions);
}

void add_files(CLI::App& command, ViewOptions& options) {
  add_number_option(
      command, "--budget", options.budget,
      [](double value) { return value >= kLeastBudget && value <= kLargestBudget; },
      "a number of MB above 0, from 1e-6 (a byte) to 1e9",
      "Keep at most so many MB (10^6 bytes) of a .voy in the memory of the device that draws; the "
      "rest is read as frames need it")
      ->type_name("MB");
  command
      .add_option(
          "--keep", options.keep,
          "Write the bake of a flat scene to this .voy, and leave it there. Without it the "
          "bake goes to the user's cache folder (docs/viewer.md), and is found there the next time")
      ->type_name("FILE");
  name_group(command, "Files and memory");
}

void add_testing(CLI::App& command, ViewOptions& options) {
  CLI::Option* script =
      command
          .add_option("--script", options.script,
                      "Do what the lines of this file say, then close the window (docs/viewer.md)")
          ->type_name("FILE");
  add_whole_option(command, "--frames", {1, kMostFrames}, options.frames,
                   "Close the window so many frames after the scene is there")
      ->excludes(script);
  command
      .add_option("--screenshot", options.screenshot,
                  "Save the picture of the last frame, then close the window. Without --frames, "
                  "once nothing changes any more")
      ->type_name("PNG")
      ->excludes(script);
  command.add_flag("--validation", options.validation,
                   "Run under Vulkan's validation layer, and fail if it reports anything");
  name_group(command, "Tests");
}

}  // namespace

void add_view_options(CLI::App& command, ViewOptions& options) {
  add_common(command, options);
  add_files(command, options);
  add_testing(command, options);
}

}  // namespace voyager::view
