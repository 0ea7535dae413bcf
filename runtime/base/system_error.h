#pragma once
#include <cerrno>
#include <cstring>

#include "runtime/base/error.h"

namespace voyager {

// Error(io): what was being done to which file, and what the system says.
[[noreturn]] inline void throw_system_error(const std::string& path, const char* doing) {
  throw Error(ErrorCode::io, path + ": " + doing + ": " + std::strerror(errno));
}

}  // namespace voyager
