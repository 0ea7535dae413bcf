#include "runtime/base/owned_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <sstream>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/base/system_error.h"

namespace voyager {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& found,
                         const std::string& expected, const FolderKind& kind) {
  throw Error(ErrorCode::refused_input,
              path + ": found " + found + ", expected " + expected + ": " + kind.advice);
}

std::string first_line(const FolderKind& kind) {
  return "voyager: the folder of " + std::string(kind.of) + "\n";
}

void require_same(const std::string& path, const FolderKind& kind, const std::string& kept,
                  const std::string& asked) {
  std::istringstream before(kept), now(asked);
  for (std::string old_line, new_line; before || now;) {
    if (!std::getline(before, old_line)) old_line.clear();
    if (!std::getline(now, new_line)) new_line.clear();
    if (old_line == new_line) continue;
    const auto quoted = [](const std::string& line) {
      return "\"" + (line.empty() ? "nothing" : line) + "\"";
    };
    refuse(path, std::string(kind.of) + " of " + quoted(old_line), quoted(new_line), kind);
  }
}

int lock_file(int fd, bool alone) {
  return ::flock(fd, (alone ? LOCK_EX : LOCK_SH) | LOCK_NB);
}

}  // namespace

bool is_plain_file(const std::string& path) {
  struct stat info = {};
  return ::lstat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

OwnedFolder::OwnedFolder(std::string path, const FolderKind& kind, const std::string& key,
                         bool alone, OtherKey other)
    : OwnedFolder(std::move(path), kind) {
  const std::string text = first_line(kind) + key;
  for (;;) {
    std::error_code problem;
    fs::create_directories(path_, problem);
    if (problem) throw Error(ErrorCode::io, path_ + ": create: " + problem.message());
    if (!open_mark()) {
      if (is_empty() && mark(text, alone)) return;
      continue;
    }
    const std::string found = read_key();
    if (!found.starts_with(first_line(kind)))
      refuse(path_, std::string("another file named ") + kFolderMark,
             std::string("that of ") + kind.of, kind);
    if (found != text && other == OtherKey::refused) require_same(path_, kind, found, text);
    const Lock locked = lock(alone);
    if (locked == Lock::refused)
      throw Error(ErrorCode::io, path_ + ": found another process at work in the folder of " +
                                     kind.of + ", expected none");
    if (locked == Lock::stale) continue;
    if (found == text) return;
    remove();
  }
}

bool OwnedFolder::open_mark() {
  mark_ = FileDescriptor(::open(mark_path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (mark_.get() < 0 && errno != ENOENT) throw_system_error(mark_path(), "open");
  return mark_.get() >= 0;
}

// The file has its name only when it is whole and locked.
bool OwnedFolder::mark(const std::string& text, bool alone) try {
  AtomicFile file(mark_path());
  file.write(std::as_bytes(std::span(text)));
  lock_file(file.descriptor().get(), alone);
  made_ = file.commit_new();
  if (made_) mark_ = std::move(file.descriptor());
  return made_;
} catch (const Error&) {
  if (!fs::exists(path_)) return false;  // removed by the process that was in it
  throw;
}

// Where a file system has no locks, processes are not kept apart.
OwnedFolder::Lock OwnedFolder::lock(bool alone) {
  if (lock_file(mark_.get(), alone) != 0 && errno == EWOULDBLOCK) return Lock::refused;
  // The process that was in the folder may have removed it since the file was opened.
  struct stat opened = {}, named = {};
  if (::fstat(mark_.get(), &opened) != 0 || ::lstat(mark_path().c_str(), &named) != 0 ||
      opened.st_dev != named.st_dev || opened.st_ino != named.st_ino)
    return Lock::stale;
  return Lock::held;
}

std::string OwnedFolder::read_key() const {
  std::string text;
  char block[4096];
  for (ssize_t got = 0;
       (got = ::pread(mark_.get(), block, sizeof block, static_cast<off_t>(text.size()))) > 0;)
    text.append(block, static_cast<size_t>(got));
  return text;
}

bool OwnedFolder::is_empty() const {
  std::error_code problem, ignored;
  for (const auto& entry : fs::directory_iterator(path_, problem)) {
    const std::string name = entry.path().filename().string();
    if (without_partial(name) == kFolderMark) continue;
    // Between two looks at the folder one process may leave it and another come.
    for (int look = 0; look < 20; ++look) {
      if (fs::exists(mark_path(), ignored) ||
          !fs::exists(fs::symlink_status(entry.path(), ignored)))
        return false;
      ::usleep(500);
    }
    refuse(path_, name, std::string("an empty folder or one of ") + kind_.of, kind_);
  }
  if (problem && problem != std::errc::no_such_file_or_directory)
    throw Error(ErrorCode::io, path_ + ": read: " + problem.message());
  return !problem;
}

void OwnedFolder::add_to_key(std::string_view text) {
  struct stat info = {};
  if (::fstat(mark_.get(), &info) != 0 ||
      ::pwrite(mark_.get(), text.data(), text.size(), info.st_size) !=
          static_cast<ssize_t>(text.size()))
    throw_system_error(mark_path(), "write");
}

std::vector<std::string> OwnedFolder::remove() {
  const std::string key = read_key();
  std::vector<std::string> names, left;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(path_, ignored))
    names.push_back(entry.path().filename().string());
  for (const std::string& name : names) {
    const std::string_view own = without_partial(name);
    if (name == kFolderMark) continue;
    const std::string file = path_ + "/" + name;
    const bool known = own == kFolderMark || kind_.is_own(own, key);
    if (!known || !is_plain_file(file) || ::unlink(file.c_str()) != 0) left.push_back(name);
  }
  ::unlink(mark_path().c_str());  // last: what a kill leaves is still marked
  ::rmdir(path_.c_str());
  mark_ = {};
  return left;
}

void OwnedFolder::remove_abandoned(const std::string& path, const FolderKind& kind) try {
  OwnedFolder folder(path, kind);
  if (!folder.open_mark()) {
    ::rmdir(path.c_str());  // killed before it was marked, or after: then it is empty
    return;
  }
  if (!folder.read_key().starts_with(first_line(kind))) return;
  if (lock_file(folder.mark_.get(), true) == 0 && folder.lock(true) == Lock::held) folder.remove();
} catch (const Error&) {
  // Left as it is.
}

}  // namespace voyager
