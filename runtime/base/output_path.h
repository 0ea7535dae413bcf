#pragma once
// Where a file will be written, and whether it can be.
#include <cstdint>
#include <string>

namespace voyager {

// What symbolic links at `path` lead to, whether that is there or not: a file is written through
// them. Throws Error(io) for links in a circle.
std::string written_path(const std::string& path);

// Throws Error(io) where something is there that no file may replace: a folder, a device, a named
// pipe, a file that must not be written to.
void require_replaceable(const std::string& path);

// Throws Error(io) where the device that a file of the name would lie on has not so many bytes
// free; `what` needs them.
void require_room(const std::string& path, uint64_t bytes, const std::string& what);

}  // namespace voyager
