#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace voyager::tools {

// The JSON that a file holds. `expected` is what a message calls the file. Throws
// Error(refused_input) naming file, offset, found, expected, and what open_file_source() does.
nlohmann::json read_json_file(const std::string& path, const std::string& expected);

}  // namespace voyager::tools
