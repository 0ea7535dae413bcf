#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace voyager::tools {

// The line for a command line that was refused: the option, what was found and what was expected,
// and where its help is. app: after it was parsed.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

// The one of the candidates that the user may have meant; "" if none is near.
std::string nearest(const std::string& found, const std::vector<std::string>& candidates);

}  // namespace voyager::tools
