#include "runtime/base/output_path.h"

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/base/file_kind.h"
#include "runtime/base/system_error.h"

namespace voyager {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

}  // namespace

// host/common/files.cpp and samples/c_minimal resolve links in the same way. They use the C ABI
// alone, so they cannot call this.
std::string written_path(const std::string& path) {
  constexpr int kMostLinks = 40;  // Linux follows as many
  fs::path target = path;
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code no_link;
    const fs::path next = fs::read_symlink(target, no_link);
    if (no_link) return target.string();
    target = target.parent_path() / next;  // equals `next` if that is absolute
  }
  throw Error(ErrorCode::io, path + ": found symbolic links in a circle, expected a file");
}

void require_replaceable(const std::string& path) {
  struct stat info = {};
  if (::stat(path.c_str(), &info) != 0) {
    if (errno == ENOENT) return;
    throw_system_error(path, "write");
  }
  if (!S_ISREG(info.st_mode))
    throw Error(ErrorCode::io, path + ": found " + file_kind(info.st_mode) +
                                   ", expected a file or a free name to write to");
  if (::access(path.c_str(), W_OK) != 0)
    throw Error(ErrorCode::io, path + ": found a file that must not be written to (" +
                                   std::strerror(errno) + "), expected another");
}

void require_room(const std::vector<Room>& files) {
  struct Device {
    dev_t id;
    const Room* first;
    uint64_t free, bytes;
    std::string what;
  };
  std::vector<Device> devices;
  for (const Room& file : files) {
    const std::string folder = folder_of(written_path(file.path));
    struct stat at = {};
    struct statvfs info = {};
    if (::stat(folder.c_str(), &at) != 0 || ::statvfs(folder.c_str(), &info) != 0 ||
        info.f_blocks == 0)
      continue;
    auto device = std::find_if(devices.begin(), devices.end(),
                               [&](const Device& known) { return known.id == at.st_dev; });
    if (device == devices.end())
      device = devices.insert(device,
                              {at.st_dev, &file, uint64_t{info.f_bavail} * info.f_frsize, 0, ""});
    device->bytes += file.bytes;
    device->what += (device->what.empty() ? "" : " and ") + file.what;
  }
  for (const Device& device : devices)
    if (device.free < device.bytes)
      throw Error(ErrorCode::io,
                  device.first->path + ": found " + std::to_string(device.free / 1000000) +
                      " MB free on the device, expected " +
                      std::to_string(device.bytes / 1000000 + 1) + " MB for " + device.what);
}

void require_room(const std::string& path, uint64_t bytes) {
  require_room({{path, bytes, "it"}});
}

}  // namespace voyager
