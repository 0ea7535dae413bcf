#pragma once
#include <cstdint>
#include <string>

namespace voyager::tools {

// "1 tile", "2 tiles".
inline std::string counted(uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace voyager::tools
