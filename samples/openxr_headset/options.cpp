#include "options.h"

#include <CLI/CLI.hpp>
#include <cmath>

namespace host {
namespace {

std::string not_negative(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= 0) return {};
  return "found " + text + ", expected a number, 0 or more";
}

std::string above_zero(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0) return {};
  return "found " + text + ", expected milliseconds above 0";
}

std::string positive(const std::string& text) {
  uint64_t value = 0;
  const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
  if (digits && CLI::detail::lexical_cast(text, value) && value > 0) return {};
  return "found " + text + ", expected a whole number, 1 or more";
}

}  // namespace

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
  app.add_option("--readback", o.readback,
                 "A PNG an eye and frame, 0000_L.png and so on, and their cameras.json")
      ->type_name("FOLDER");
  auto* const tau = app.add_option("--tau", o.tau, "Level of detail, pixels: smaller is finer")
                        ->check(CLI::Validator(not_negative, "PX"));
  app.add_option("--time-budget", o.time_budget,
                 "Voyager's share of a frame, both eyes: the granularity follows")
      ->check(CLI::Validator(above_zero, "MS"))
      ->excludes(tau);
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
  return o;
}

}  // namespace host
