#pragma once
// Where a file will be written, and whether it can be.
#include <cstdint>
#include <string>
#include <vector>

namespace voyager {

// What symbolic links at `path` lead to, whether that is there or not: a file is written through
// them. Throws Error(io) for links in a circle.
std::string written_path(const std::string& path);

// Throws Error(io) where something is there that no file may replace: a folder, a device, a named
// pipe, a file that must not be written to.
void require_replaceable(const std::string& path);

// What a file at `path`, or files in a folder that ends in /, will take at least, and its name in
// messages.
struct Room {
  std::string path;
  uint64_t bytes = 0;
  std::string what;
};

// Of files that are there at the same time: throws Error(io) where a device has not as many bytes
// free as all files on it take together.
void require_room(const std::vector<Room>& files);
// Of one file.
void require_room(const std::string& path, uint64_t bytes);

}  // namespace voyager
