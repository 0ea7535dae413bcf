#include "options.h"

#include <CLI/CLI.hpp>

#include "option_checks.h"

namespace host {

std::optional<Options> parse_options(int argc, char** argv) {
  Options o;
  CLI::App app{"A Gaussian city on an OpenXR headset"};
  app.name("openxr_headset");
  app.add_option("SCENE", o.scene, ".voy, or a flat scene of any format")->required();
  app.add_option("--frames", o.frames, "Leave after so many were shown")
      ->check(CLI::Validator(positive, "N"));
  app.add_option("--camera-file", o.camera_file, "cameras.json: the start is its first camera")
      ->type_name("FILE");
  app.add_flag("--fixed-pose", o.fixed_pose, "The head stays at the start, wherever it is");
  app.add_flag(
      "--quad-views", o.quad_views,
      "Two pictures an eye, a coarse one of everything and a sharp one of the middle; fails "
      "where the runtime has none");
  app.add_option("--readback", o.readback,
                 "A PNG an eye and frame, 0000_L.png and so on, and their cameras.json")
      ->type_name("FOLDER");
  auto* const tau = app.add_option("--tau", o.tau, "Level of detail, pixels: smaller is finer")
                        ->check(CLI::Validator(not_negative, "PX"));
  auto* const time = app.add_option("--time-budget", o.time_budget,
                                    "Voyager's part of a frame, both eyes: tau follows. Without it "
                                    "and --tau, three quarters of the display's period")
                         ->check(CLI::Validator(above_zero, "MS"))
                         ->excludes(tau);
  app.add_option("--budget", o.budget_megabytes,
                 "Stream the scene: 10^6 bytes that its data may occupy")
      ->check(CLI::Validator(megabytes, "MB"));
  app.add_flag("--validation", o.validation,
               "Run under the validation layers of Vulkan and OpenXR; exit with 1 if they report "
               "anything");
  app.footer("openxr_headset city.voy --camera-file city.cameras.json");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    app.exit(request);
    return std::nullopt;
  }
  if (!o.readback.empty() && o.frames == 0)
    throw CLI::ValidationError("--readback", "expected --frames N with it");
  // Pictures that are compared have one tau.
  o.follows_display = tau->empty() && time->empty() && o.readback.empty();
  return o;
}

}  // namespace host
