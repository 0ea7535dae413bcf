#pragma once
// Options that several subcommands share, and kinds of options. What does not fit is refused with
// the option's name, what was found and what was expected.
#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/image_size.h"

namespace voyager::tools {

// For what the parser cannot refuse, because it depends on several options or on the files.
[[noreturn]] void bad_usage(const std::string& message);

// "--size WxH"
CLI::Option* add_size_option(CLI::App& command, ImageSize& size);
// "--tau PX"
CLI::Option* add_tau_option(CLI::App& command, double& tau);
// "--tau PX" and "--time-budget MS", of which one may be given; 0 milliseconds: none was.
void add_tau_or_budget_options(CLI::App& command, double& tau, double& milliseconds);
// "--quiet" and "--verbose"
void add_verbosity_options(CLI::App& command);
// --flag=3 is a mistake in every flag of the command.
void refuse_values_of_flags(CLI::App& command);

// Gives those options of the command that have no group yet this heading in its help.
void name_group(CLI::App& command, const std::string& group);
inline constexpr const char* kCommonOptions = "Common options";

// A whole number from least to most.
struct WholeRange {
  uint64_t least = 0, most = std::numeric_limits<uint64_t>::max();
};
CLI::Option* add_whole_option(CLI::App& command, const std::string& option, WholeRange range,
                              const std::function<void(uint64_t)>& set,
                              const std::string& description);
// For a number, or a std::optional of one.
template <class T>
CLI::Option* add_whole_option(CLI::App& command, const std::string& option, WholeRange range,
                              T& value, const std::string& description) {
  return add_whole_option(
      command, option, range, [&value](uint64_t found) { value = static_cast<T>(found); },
      description);
}

// All of the text as a whole number: digits and nothing else.
std::optional<uint64_t> parse_whole(const std::string& text);

// All of the text as a finite number.
std::optional<double> parse_number(const std::string& text);

// "--camera I", whose range camera_at() knows (tools/cameras.h).
CLI::Option* add_camera_option(CLI::App& command, int64_t& index);

// A finite number for which `fits` is true; `expected` says so in words.
CLI::Option* add_number_option(CLI::App& command, const std::string& option, double& value,
                               const std::function<bool(double)>& fits, const std::string& expected,
                               const std::string& description);

// One of several names; the first is the default. Another is refused, with the list.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& option, T& value,
                        const std::vector<std::pair<std::string, T>>& names,
                        const std::string& description) {
  std::string list;
  for (const auto& [name, choice] : names) list += (list.empty() ? "" : "|") + name;
  return command
      .add_option_function<std::string>(
          option,
          [&value, names, list, option](const std::string& found) {
            for (const auto& [name, choice] : names)
              if (name == found) {
                value = choice;
                return;
              }
            throw CLI::ValidationError(option, "found " + found + ", expected " + list);
          },
          description)
      ->type_name(list)
      ->default_str(names.front().first);
}

}  // namespace voyager::tools
