#pragma once
#include <cstdint>
#include <string>

namespace voyager::tools {

// For people: "512 bytes", "3.42 kB", "79.1 MB", "1.20 GB"; a megabyte is 10^6 bytes.
std::string size_text(uint64_t bytes);

}  // namespace voyager::tools
