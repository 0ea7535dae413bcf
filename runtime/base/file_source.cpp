// A local file: pread, and past the page cache where that is asked for and can be had.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "runtime/base/bounce_buffers.h"
#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/base/file_data.h"
#include "runtime/base/file_descriptor.h"
#include "runtime/base/file_kind.h"
#include "runtime/base/path_beside.h"

namespace voyager {
namespace {

// What the same read may not meet again: the medium, the network below the file system, memory.
bool may_pass(int error) {
  return error == EIO || error == EAGAIN || error == ETIMEDOUT || error == ENOMEM ||
         error == ENOBUFS || error == EBUSY;
}

class FileSource final : public ByteSource {
 public:
  explicit FileSource(const std::string& path);
  const std::string& name() const override { return name_; }
  uint64_t size() const override { return size_; }
  void read(uint64_t offset, std::span<std::byte> into) const override;
  void expect(Access access) const noexcept override;
  std::unique_ptr<ByteSource> open_beside(const std::string& path) const override;

 private:
  void read_cached(uint64_t offset, std::span<std::byte> into) const;
  void read_direct(uint64_t offset, std::span<std::byte> into) const;
  bool set_direct(bool on) const noexcept;
  // At least one byte and more than `skip`, for the read of `into` at `offset` needs more.
  size_t read_some(uint64_t at, std::span<std::byte> bytes, size_t skip) const;

  std::string name_;
  FileDescriptor fd_;
  uint64_t size_ = 0;
  mutable std::atomic<bool> direct_{false};
  mutable BounceBuffers buffers_;
};

[[noreturn]] void fail_to_open(const std::string& path) {
  throw Error(errno == ENOENT ? ErrorCode::file_not_found : ErrorCode::io,
              path + ": open: " + std::strerror(errno));
}

void require_regular(const std::string& path, mode_t mode) {
  if (!S_ISREG(mode))
    throw Error(ErrorCode::refused_input,
                path + ": found " + file_kind(mode) + ", expected a regular file");
}

// What is no regular file is not even opened: that may wait for a writer, rewind a tape, or take a
// terminal. It may have come after the look at it, so that the opening waits for nothing either.
int open_regular(const std::string& path) {
  struct stat info = {};
  if (::stat(path.c_str(), &info) != 0) fail_to_open(path);
  require_regular(path, info.st_mode);
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (fd < 0) fail_to_open(path);
  return fd;
}

FileSource::FileSource(const std::string& path) : name_(path), fd_(open_regular(path)) {
  struct stat info = {};
  if (::fstat(fd_.get(), &info) != 0) fail_to_open(path);
  require_regular(path, info.st_mode);
  size_ = static_cast<uint64_t>(info.st_size);
  require_data(fd_.get(), path);
}

bool FileSource::set_direct(bool on) const noexcept {
  const int flags = ::fcntl(fd_.get(), F_GETFL);
  if (flags < 0) return false;
  return ::fcntl(fd_.get(), F_SETFL, on ? flags | O_DIRECT : flags & ~O_DIRECT) == 0;
}

void FileSource::expect(Access access) const noexcept {
  direct_ = set_direct(access == Access::uncached) && access == Access::uncached;
  ::posix_fadvise(fd_.get(), 0, 0,
                  access == Access::forward ? POSIX_FADV_NORMAL : POSIX_FADV_RANDOM);
}

std::unique_ptr<ByteSource> FileSource::open_beside(const std::string& path) const {
  return open_file_source(path_beside(name_, path));
}

void FileSource::read(uint64_t offset, std::span<std::byte> into) const {
  check_range(*this, offset, into.size());
  if (direct_)
    read_direct(offset, into);
  else
    read_cached(offset, into);
}

void FileSource::read_cached(uint64_t offset, std::span<std::byte> into) const {
  while (!into.empty()) {
    const size_t got = read_some(offset, into, 0);
    offset += got;
    into = into.subspan(got);
  }
}

// Whole blocks around the range go through a buffer that is aligned as the device wants it.
void FileSource::read_direct(uint64_t offset, std::span<std::byte> into) const {
  constexpr uint64_t kAlign = BounceBuffers::kAlign;
  const auto buffer = buffers_.take();
  while (!into.empty()) {
    const size_t skip = offset % kAlign;
    const size_t blocks = (skip + into.size() + kAlign - 1) / kAlign * kAlign;
    const size_t got = read_some(
        offset - skip, buffer.bytes().first(std::min(blocks, buffer.bytes().size())), skip);
    const size_t count = std::min(got - skip, into.size());
    std::memcpy(into.data(), buffer.bytes().data() + skip, count);
    offset += count;
    into = into.subspan(count);
  }
}

size_t FileSource::read_some(uint64_t at, std::span<std::byte> bytes, size_t skip) const {
  for (;;) {
    const ssize_t got = ::pread(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (got > static_cast<ssize_t>(skip)) return static_cast<size_t>(got);
    if (got < 0 && errno == EINTR) continue;
    // Some file systems refuse direct reads only now. Reads in flight go on without.
    if (got < 0 && errno == EINVAL && direct_.exchange(false) && set_direct(false)) continue;
    if (got < 0)
      throw Error(
          may_pass(errno) ? ErrorCode::io_transient : ErrorCode::io,
          name_ + ": offset " + std::to_string(at + skip) + ": read: " + std::strerror(errno));
    struct stat info = {};
    const bool known = ::fstat(fd_.get(), &info) == 0;
    throw Error(ErrorCode::io,
                name_ + ": offset " + std::to_string(at + skip) + ": found the end of the file" +
                    (known ? " at " + std::to_string(info.st_size) : "") + ", expected it at " +
                    std::to_string(size_) + ": truncated while open");
  }
}

}  // namespace

std::unique_ptr<ByteSource> open_file_source(const std::string& path) {
  return std::make_unique<FileSource>(path);
}

}  // namespace voyager
