// A file without a name until commit(), so that nothing is left however the process ends; on file
// systems that have none, a file beside the target.
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstring>

#include "runtime/base/file.h"
#include "runtime/base/output_path.h"
#include "runtime/base/system_error.h"

namespace voyager {
namespace {

constexpr const char* kPartial = ".partial-";

// A name beside `path` that no other thread or process uses.
std::string unused_name(const std::string& path) {
  static std::atomic<unsigned> count{0};
  for (;;) {
    std::string name = path + kPartial + std::to_string(::getpid()) + "-" + std::to_string(count++);
    if (::access(name.c_str(), F_OK) == 0) continue;
    if (errno != ENOENT) throw_system_error(path, "create");  // also where such a name is too long
    return name;
  }
}

}  // namespace

std::string_view without_partial(std::string_view name) {
  const size_t at = name.rfind(kPartial);
  if (at == std::string_view::npos) return name;
  const std::string_view rest = name.substr(at + std::strlen(kPartial));
  const size_t dash = rest.find('-');
  const auto digits = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const bool whole = dash != std::string_view::npos && digits(rest.substr(0, dash)) &&
                     digits(rest.substr(dash + 1));
  return whole ? name.substr(0, at) : name;
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(written_path(path_)) {
  require_replaceable(path_);
  const std::string beside = unused_name(target_);
  const size_t slash = target_.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : target_.substr(0, slash + 1);
  fd_ = FileDescriptor(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666));
  if (fd_.get() >= 0) return;
  fd_ = FileDescriptor(::open(beside.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666));
  if (fd_.get() < 0) throw_system_error(path_, "create");
  temporary_ = beside;
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  write_at(position_, bytes);
  position_ += bytes.size();
}

void AtomicFile::write_at(uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw_system_error(path_, "write");
    offset += static_cast<uint64_t>(put);
    bytes = bytes.subspan(static_cast<size_t>(put));
  }
}

bool AtomicFile::link_to(const std::string& name) {
  const std::string unnamed = "/proc/self/fd/" + std::to_string(fd_.get());
  if (::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0)
    return true;
  if (errno != EEXIST) throw_system_error(path_, "finish");
  return false;
}

void AtomicFile::commit() {
  if (::fsync(fd_.get()) != 0) throw_system_error(path_, "finish");
  commit_unflushed();
}

void AtomicFile::commit_unflushed() {
  if (temporary_.empty()) {
    if (link_to(target_)) return;
    const std::string beside = unused_name(target_);
    if (!link_to(beside)) throw_system_error(path_, "finish");
    temporary_ = beside;
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) throw_system_error(path_, "finish");
  temporary_.clear();
}

bool AtomicFile::commit_new() {
  if (temporary_.empty()) return link_to(target_);
  if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0) {
    temporary_.clear();
    return true;
  }
  // Not every file system can do this, but those have links. The other name goes with the object.
  if (errno == EINVAL && ::link(temporary_.c_str(), target_.c_str()) == 0) return true;
  if (errno != EEXIST) throw_system_error(path_, "finish");
  return false;
}

}  // namespace voyager
