#pragma once
#include <cstdint>
#include <cstdio>
#include <string>

namespace voyager {

// For messages: "0.263 MB"; below a kilobyte to the byte, since no budget is "0.000 MB". A megabyte
// is 10^6 bytes.
inline std::string megabytes_text(uint64_t bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f MB", bytes < 1000 ? 6 : 3,
                static_cast<double>(bytes) / 1e6);
  return text;
}

}  // namespace voyager
