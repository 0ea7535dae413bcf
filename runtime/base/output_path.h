#pragma once
// Where a file will be written, and whether it can be.
#include <cstdint>
#include <string>
#include <vector>

namespace voyager {

// The path to which symbolic links at `path` lead, whether a file exists there or not. Files are
// written to that path, so that the links stay. Throws Error(io) for links in a circle.
std::string written_path(const std::string& path);

// Throws Error(io) if `path` is something that no file may replace: a folder, a device, a named
// pipe, or a file without write permission.
void require_replaceable(const std::string& path);

// Disk space that files will need.
struct Room {
  std::string path;    // a file, or a folder that ends in /
  uint64_t bytes = 0;  // at least
  std::string what;    // name in messages
};

// `files` exist at the same time. Throws Error(io) if a device has fewer bytes free than all files
// on it need together.
void require_room(const std::vector<Room>& files);
// The same for one file.
void require_room(const std::string& path, uint64_t bytes);

}  // namespace voyager
