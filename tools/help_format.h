#pragma once
#include <CLI/CLI.hpp>
#include <memory>

namespace voyager::tools {

// The text of --help: how a command is called, then its options by group, in 80 columns.
std::shared_ptr<CLI::FormatterBase> help_format();

}  // namespace voyager::tools
