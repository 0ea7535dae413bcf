#pragma once
// Options that several subcommands share.
#include <CLI/CLI.hpp>
#include <string>

namespace voyager::tools {

struct ImageSize {
  uint32_t width = 0, height = 0;  // 0: the camera's own
};

// "--size WxH"
void add_size_option(CLI::App& command, ImageSize& size);
// "--tau PX"
void add_tau_option(CLI::App& command, double& tau);

}  // namespace voyager::tools
