#include "runtime/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "runtime/base/error.h"

namespace voyager {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& doing) {
  throw Error(ErrorCode::io, name + ": " + doing + ": " + std::strerror(errno));
}

// A name beside `path` that no other thread or process uses.
std::string unused_name(const std::string& path) {
  static std::atomic<unsigned> count{0};
  std::string name;
  do {
    name = path + ".partial-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
  } while (::access(name.c_str(), F_OK) == 0);
  return name;
}

class SourceReader final : public ByteReader {
 public:
  explicit SourceReader(const ByteSource& source) : source_(source) {}
  const std::string& name() const override { return source_.name(); }
  size_t read(std::span<std::byte> into) override {
    const size_t count =
        static_cast<size_t>(std::min<uint64_t>(into.size(), source_.size() - offset_));
    source_.read(offset_, into.first(count));
    offset_ += count;
    return count;
  }
  uint64_t skip(uint64_t count) override {
    const uint64_t skipped = std::min(count, source_.size() - offset_);
    offset_ += skipped;
    return skipped;
  }
  std::optional<uint64_t> remaining() const override { return source_.size() - offset_; }
  uint64_t offset() const override { return offset_; }

 private:
  const ByteSource& source_;
  uint64_t offset_ = 0;
};

class StdinReader final : public ByteReader {
 public:
  const std::string& name() const override { return name_; }
  size_t read(std::span<std::byte> into) override {
    size_t count = 0;
    while (count < into.size()) {
      const ssize_t got = ::read(STDIN_FILENO, into.data() + count, into.size() - count);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(name_, "read");
      if (got == 0) break;
      count += static_cast<size_t>(got);
    }
    offset_ += count;
    return count;
  }
  std::optional<uint64_t> remaining() const override { return std::nullopt; }
  uint64_t offset() const override { return offset_; }

 private:
  std::string name_ = "standard input";
  uint64_t offset_ = 0;
};

}  // namespace

void check_range(const ByteSource& source, uint64_t offset, size_t count) {
  const uint64_t size = source.size();
  if (offset <= size && count <= size - offset) return;
  throw Error(ErrorCode::refused_input, source.name() + ": offset " + std::to_string(offset) +
                                            ": found " +
                                            std::to_string(size - std::min(offset, size)) +
                                            " bytes, expected " + std::to_string(count));
}

MemorySource::MemorySource(std::string name, std::span<const std::byte> bytes)
    : name_(std::move(name)), bytes_(bytes) {}

void MemorySource::read(uint64_t offset, std::span<std::byte> into) const {
  check_range(*this, offset, into.size());
  if (!into.empty()) std::memcpy(into.data(), bytes_.data() + offset, into.size());
}

uint64_t ByteReader::skip(uint64_t count) {
  std::array<std::byte, 16384> unused;
  uint64_t skipped = 0;
  while (skipped < count) {
    const size_t wanted = static_cast<size_t>(std::min<uint64_t>(unused.size(), count - skipped));
    const size_t got = read(std::span(unused).first(wanted));
    skipped += got;
    if (got < wanted) break;
  }
  return skipped;
}

std::unique_ptr<ByteReader> read_source(const ByteSource& source) {
  return std::make_unique<SourceReader>(source);
}

std::unique_ptr<ByteReader> read_stdin() {
  return std::make_unique<StdinReader>();
}

// A file without a name until commit(), so that nothing is left however the
// process ends; on file systems that have none, a file beside the target.
AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  struct stat info = {};
  if (::stat(path_.c_str(), &info) == 0 && !S_ISREG(info.st_mode))
    throw Error(ErrorCode::io, path_ +
                                   ": found something that is not a regular file, expected a "
                                   "file or a free name");
  const size_t slash = path_.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path_.substr(0, slash + 1);
  fd_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (fd_ >= 0) return;
  temporary_ = unused_name(path_);
  fd_ = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
  if (fd_ < 0) fail(path_, "create");
}

AtomicFile::~AtomicFile() {
  if (fd_ < 0) return;
  ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  write_at(position_, bytes);
  position_ += bytes.size();
}

void AtomicFile::write_at(uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) fail(path_, "write");
    offset += static_cast<uint64_t>(put);
    bytes = bytes.subspan(static_cast<size_t>(put));
  }
}

void AtomicFile::commit() {
  if (::fsync(fd_) != 0) fail(path_, "finish");
  commit_unflushed();
}

void AtomicFile::commit_unflushed() {
  if (temporary_.empty()) {
    const std::string unnamed = "/proc/self/fd/" + std::to_string(fd_);
    temporary_ = unused_name(path_);
    if (::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      temporary_.clear();
      fail(path_, "finish");
    }
  }
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "finish");
  ::close(fd_);
  fd_ = -1;
}

}  // namespace voyager
