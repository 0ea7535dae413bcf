#pragma once
// The subcommands. Each adds itself to the parser; its work runs in the
// callback and throws voyager::Error or voy::Error.
#include <CLI/CLI.hpp>

namespace voyager::tools {

void add_synth(CLI::App& app);
void add_bake(CLI::App& app);
void add_convert(CLI::App& app);
void add_export(CLI::App& app);
void add_info(CLI::App& app);
void add_render(CLI::App& app);
void add_bench(CLI::App& app);
void add_report(CLI::App& app);  // of builds with cairo
void add_view(CLI::App& app);    // of builds with a window
void add_devices(CLI::App& app);

}  // namespace voyager::tools
