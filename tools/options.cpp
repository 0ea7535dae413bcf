#include "tools/options.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "runtime/base/error.h"
#include "tools/cameras.h"
#include "tools/console.h"

namespace voyager::tools {
namespace {

// All of the text.
template <class Number>
std::optional<Number> parse(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

bool parse_size(const std::string& text, ImageSize& size) {
  const size_t cross = text.find('x');
  if (cross == std::string::npos) return false;
  const auto width = parse<uint32_t>(text.substr(0, cross)),
             height = parse<uint32_t>(text.substr(cross + 1));
  if (!width || !height) return false;
  if (*width < 1 || *width > kLargestSide || *height < 1 || *height > kLargestSide) return false;
  size = {*width, *height};
  return true;
}

std::string words(WholeRange range) {
  if (range.most == std::numeric_limits<uint64_t>::max())
    return "a whole number, " + std::to_string(range.least) + " or more";
  return "a whole number from " + std::to_string(range.least) + " to " + std::to_string(range.most);
}

[[noreturn]] void refuse(const std::string& option, const std::string& found,
                         const std::string& expected) {
  throw CLI::ValidationError(
      option, "found " + (found.empty() ? "nothing" : found) + ", expected " + expected);
}

}  // namespace

void bad_usage(const std::string& message) {
  throw Error(ErrorCode::invalid_argument, message);
}

std::optional<uint64_t> parse_whole(const std::string& text) {
  return parse<uint64_t>(text);
}

std::optional<double> parse_number(const std::string& text) {
  const auto value = parse<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

CLI::Option* add_size_option(CLI::App& command, ImageSize& size) {
  return command
      .add_option_function<std::string>(
          "--size",
          [&size](const std::string& text) {
            if (!parse_size(text, size))
              refuse("--size", text, "WxH in pixels, each from 1 to 16384, as 1280x720");
          },
          "Size of the image in pixels, in place of the camera's own")
      ->type_name("WxH");
}

CLI::Option* add_tau_option(CLI::App& command, double& tau) {
  return add_number_option(
             command, "--tau", tau, [](double value) { return value >= 0; },
             "a number of pixels, 0 or more",
             "Level of detail: how large a node may look before its children are drawn instead. "
             "Smaller is finer and slower")
      ->type_name("PX")
      ->default_str("3");
}

void add_tau_or_budget_options(CLI::App& command, double& tau, double& milliseconds) {
  CLI::Option* fixed = add_tau_option(command, tau);
  add_number_option(
      command, "--time-budget", milliseconds,
      [](double value) { return value >= 1e-6 && value <= 1e9; },
      "a number of milliseconds above 0, from 1e-6 to 1e9",
      "Let tau follow the time that frames take, between 1 and 60 pixels, so that a frame takes at "
      "most so many milliseconds")
      ->type_name("MS")
      ->excludes(fixed);
}

void add_verbosity_options(CLI::App& command) {
  CLI::Option* quiet = command.add_flag_callback(
      "--quiet", [] { set_verbosity(Verbosity::quiet); },
      "Print nothing but errors, and what was asked for");
  command
      .add_flag_callback(
          "--verbose", [] { set_verbosity(Verbosity::verbose); },
          "Print more of what happens: the library's log, times")
      ->excludes(quiet);
}

void refuse_values_of_flags(CLI::App& command) {
  for (CLI::Option* option : command.get_options())
    if (option->get_items_expected_max() == 0) option->disable_flag_override();
}

void name_group(CLI::App& command, const std::string& group) {
  for (CLI::Option* option : command.get_options())
    if (option->get_group() == "Options" && option->nonpositional() &&
        option != command.get_help_ptr())
      option->group(group);
}

CLI::Option* add_whole_option(CLI::App& command, const std::string& option, WholeRange range,
                              const std::function<void(uint64_t)>& set,
                              const std::string& description) {
  return command
      .add_option_function<std::string>(
          option,
          [option, range, set](const std::string& text) {
            const auto value = parse_whole(text);
            if (!value || *value < range.least || *value > range.most)
              refuse(option, text, words(range));
            set(*value);
          },
          description)
      ->type_name("N");
}

CLI::Option* add_camera_option(CLI::App& command, int64_t& index) {
  return command
      .add_option_function<std::string>(
          "--camera",
          [&index](const std::string& text) {
            const auto value = parse<int64_t>(text);
            if (!value) refuse("--camera", text, words({}));
            index = *value;
          },
          "Which camera of the file, counted from 0")
      ->type_name("I")
      ->default_str("0");
}

CLI::Option* add_number_option(CLI::App& command, const std::string& option, double& value,
                               const std::function<bool(double)>& fits, const std::string& expected,
                               const std::string& description) {
  return command.add_option_function<std::string>(
      option,
      [option, &value, fits, expected](const std::string& text) {
        const auto found = parse_number(text);
        if (!found || !fits(*found)) refuse(option, text, expected);
        value = *found;
      },
      description);
}

}  // namespace voyager::tools
