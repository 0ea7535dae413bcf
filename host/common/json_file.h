#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace host {

// Of cameras. Discarded where it is no JSON. Throws Failure(kRefusedInput) where the file cannot
// be read or is too large, or where there are too many levels.
nlohmann::json read_json(const std::string& path);

}  // namespace host
