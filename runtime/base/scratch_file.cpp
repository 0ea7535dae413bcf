#include "runtime/base/scratch_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

#include "runtime/base/error.h"
#include "runtime/base/system_error.h"

namespace voyager {

ScratchFile::ScratchFile(std::string path, int flags)
    : path_(std::move(path)), fd_(::open(path_.c_str(), flags | O_CLOEXEC, 0666)) {
  if (fd_.get() < 0) throw_system_error(path_, "open");
}

ScratchFile ScratchFile::create(const std::string& path) {
  // A new one: what a link of that name leads to is not emptied.
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) throw_system_error(path, "remove");
  return {path, O_RDWR | O_CREAT | O_EXCL};
}

ScratchFile ScratchFile::open(const std::string& path) {
  return {path, O_RDWR};
}

uint64_t ScratchFile::size() const {
  struct stat info = {};
  if (::fstat(fd_.get(), &info) != 0) throw_system_error(path_, "stat");
  return static_cast<uint64_t>(info.st_size);
}

void ScratchFile::write(uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw_system_error(path_, "write");
    offset += static_cast<uint64_t>(put);
    bytes = bytes.subspan(static_cast<size_t>(put));
  }
}

void ScratchFile::read(uint64_t offset, std::span<std::byte> into) const {
  while (!into.empty()) {
    const ssize_t got = ::pread(fd_.get(), into.data(), into.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_system_error(path_, "read");
    if (got == 0)
      throw Error(ErrorCode::io, path_ + ": offset " + std::to_string(offset) +
                                     ": found the end of the file, expected " +
                                     std::to_string(into.size()) + " bytes more");
    offset += static_cast<uint64_t>(got);
    into = into.subspan(static_cast<size_t>(got));
  }
}

}  // namespace voyager
