#pragma once
#include <sys/stat.h>

namespace voyager {

// What a message says was found at a path.
inline const char* file_kind(mode_t mode) {
  if (S_ISREG(mode)) return "a file";
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a named pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return S_ISBLK(mode) ? "a disk device" : "a device or terminal";
}

}  // namespace voyager
