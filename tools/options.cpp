#include "tools/options.h"

#include <cmath>

#include "tools/cameras.h"

namespace voyager::tools {
namespace {

bool parse_size(const std::string& text, ImageSize& size) {
  const size_t cross = text.find('x');
  uint32_t width = 0, height = 0;
  if (cross == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, cross), width) ||
      !CLI::detail::lexical_cast(text.substr(cross + 1), height))
    return false;
  if (width < 1 || width > kLargestSide || height < 1 || height > kLargestSide) return false;
  size = {width, height};
  return true;
}

}  // namespace

void add_size_option(CLI::App& command, ImageSize& size) {
  command
      .add_option_function<std::string>(
          "--size",
          [&size](const std::string& text) {
            if (!parse_size(text, size))
              throw CLI::ValidationError(
                  "--size", "found " + text + ", expected WxH in pixels, each from 1 to 16384");
          },
          "Image size in place of each camera's own; fx, fy, cx, cy follow")
      ->type_name("WxH");
}

CLI::Option* add_tau_option(CLI::App& command, double& tau) {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= 0) return {};
    return "found " + text + ", expected a number of pixels, 0 or more";
  };
  return command.add_option("--tau", tau, "Granularity in pixels")
      ->type_name("PX")
      ->check(CLI::Validator(check, ""))
      ->capture_default_str();
}

void add_tau_or_budget_options(CLI::App& command, double& tau, double& milliseconds) {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0) return {};
    return "found " + text + ", expected a number of milliseconds above 0";
  };
  CLI::Option* fixed = add_tau_option(command, tau);
  command
      .add_option("--time-budget", milliseconds,
                  "Milliseconds a frame, which tau follows from frame to frame, from 1 to 60")
      ->type_name("MS")
      ->check(CLI::Validator(check, ""))
      ->excludes(fixed);
}

}  // namespace voyager::tools
