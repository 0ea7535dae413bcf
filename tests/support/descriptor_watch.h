#pragma once
// File descriptors under watch. It replaces close() in its program.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

namespace voyager::test {

// Calls of close() that closed something, and that found nothing open: it was closed twice.
inline std::atomic<int> closes = 0, bad_closes = 0;

inline bool is_open(int fd) {
  return ::fcntl(fd, F_GETFD) >= 0;
}

inline std::set<int> open_descriptors() {
  std::set<int> open;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    open.insert(std::stoi(entry.path().filename()));
  for (auto at = open.begin(); at != open.end();)
    at = is_open(*at) ? std::next(at) : open.erase(at);  // the iterator's own
  return open;
}

// Of the file behind it, whatever its number.
using FileIdentity = std::pair<dev_t, ino_t>;
inline FileIdentity identity_of(int fd) {
  struct stat found {};
  return ::fstat(fd, &found) == 0 ? FileIdentity{found.st_dev, found.st_ino} : FileIdentity{};
}

// A file of its own, in memory.
inline int new_descriptor() {
  return ::memfd_create("voyager-test", MFD_CLOEXEC);
}

}  // namespace voyager::test

// Seen by shared libraries too.
extern "C" __attribute__((visibility("default"), used)) inline int close(int fd) {
  const auto status = static_cast<int>(::syscall(SYS_close, fd));
  ++(status == 0 ? voyager::test::closes : voyager::test::bad_closes);
  return status;
}
