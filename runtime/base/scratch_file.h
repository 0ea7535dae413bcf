#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "runtime/base/file_descriptor.h"

namespace voyager {

// A file that grows in no order: writes and reads may come from several threads at
// once. Throws Error(io) naming the file and, where the device is full, saying so.
class ScratchFile {
 public:
  // Made anew.
  static ScratchFile create(const std::string& path);
  static ScratchFile open(const std::string& path);  // what is there

  const std::string& path() const { return path_; }
  uint64_t size() const;
  void write(uint64_t offset, std::span<const std::byte> bytes);
  void read(uint64_t offset, std::span<std::byte> into) const;

 private:
  ScratchFile(std::string path, int flags);
  std::string path_;
  FileDescriptor fd_;
};

}  // namespace voyager
