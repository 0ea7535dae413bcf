#pragma once
// Options that several subcommands share.
#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tools/image_size.h"

namespace voyager::tools {

// "--size WxH"
void add_size_option(CLI::App& command, ImageSize& size);
// "--tau PX"
CLI::Option* add_tau_option(CLI::App& command, double& tau);
// "--tau PX" and "--time-budget MS", of which one may be given; 0 milliseconds: none was.
void add_tau_or_budget_options(CLI::App& command, double& tau, double& milliseconds);

// One of several names; the first is the default. Another is refused, with the list.
template <class T>
void add_choice(CLI::App& command, const std::string& option, T& value,
                const std::vector<std::pair<std::string, T>>& names,
                const std::string& description) {
  std::string list;
  for (const auto& [name, choice] : names) list += (list.empty() ? "" : "|") + name;
  command
      .add_option_function<std::string>(
          option,
          [&value, names, list, option](const std::string& found) {
            for (const auto& [name, choice] : names)
              if (name == found) {
                value = choice;
                return;
              }
            throw CLI::ValidationError(option, "found " + found + ", this version has " + list);
          },
          description)
      ->type_name(list)
      ->default_str(names.front().first);
}

}  // namespace voyager::tools
