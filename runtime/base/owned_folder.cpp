#include "runtime/base/owned_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>

#include "runtime/base/checksum.h"
#include "runtime/base/file.h"
#include "runtime/base/file_kind.h"
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

constexpr int kMostTries = 20;  // while other processes make and remove the same folder
constexpr std::string_view kFoldersMade = "folders made ", kChecksum = ", checksum ";

std::string note_line(const std::string& note) {
  return note + std::string(kChecksum) + std::to_string(checksum(std::as_bytes(std::span(note)))) +
         "\n";
}

// Of a mark: the kind, the key and the empty line.
std::string key_part(const std::string& mark) {
  const size_t empty_line = mark.rfind("\n\n");  // an input's name may have one, no note has
  return empty_line == std::string::npos ? mark : mark.substr(0, empty_line + 2);
}

// Nothing where one of them was altered.
std::optional<std::vector<std::string>> notes_of(const std::string& mark) {
  std::vector<std::string> notes;
  const std::string lines = mark.substr(key_part(mark).size());
  for (size_t begin = 0, end = 0; begin < lines.size(); begin = end) {
    end = std::min(lines.find('\n', begin), lines.size() - 1) + 1;
    const std::string line = lines.substr(begin, end - begin);
    const std::string note = line.substr(0, line.rfind(kChecksum));
    if (line != note_line(note)) return std::nullopt;
    notes.push_back(note);
  }
  return notes;
}

unsigned folders_made(const std::vector<std::string>& notes) {
  unsigned made = 0;
  for (const std::string& note : notes)
    if (note.starts_with(kFoldersMade))
      std::from_chars(note.data() + kFoldersMade.size(), note.data() + note.size(), made);
  return made;
}

[[noreturn]] void refuse_other(const std::string& path, const FolderKind& kind,
                               const std::string& kept, const std::string& asked) {
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
  refuse(path, std::string("an altered ") + kFolderMark, "it as it was written", kind);
}

// Where folders above are to be made, the path without . and .. in it: of a/./b/../c no b is made.
// Others stay as they are, for messages.
std::string as_made(const std::string& path) {
  const fs::path given(path);
  std::error_code problem;
  if (std::none_of(given.begin(), given.end(),
                   [](const fs::path& name) { return name == "." || name == ".."; }) ||
      fs::exists(given.parent_path(), problem))
    return path;
  const fs::path absolute = fs::absolute(given, problem);
  if (problem) return path;
  const fs::path found = fs::weakly_canonical(absolute, problem);
  return problem ? path : found.string();
}

int lock_file(int fd, bool alone) {
  return ::flock(fd, (alone ? LOCK_EX : LOCK_SH) | LOCK_NB);
}

}  // namespace

bool is_plain_file(const std::string& path) {
  struct stat info = {};
  return ::lstat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

OwnedFolder::OwnedFolder(const std::string& path, const FolderKind& kind, const std::string& key,
                         bool alone, OtherKey other)
    : OwnedFolder(path, kind) {
  try {
    const bool whole_lines = key.empty() || key.ends_with('\n');
    take(first_line(kind) + key + (whole_lines ? "\n" : "\n\n"), alone, other);
  } catch (...) {
    remove_made(made_);
    throw;
  }
}

OwnedFolder::OwnedFolder(const std::string& path, const FolderKind& kind)
    : path_(as_made(path)), kind_(kind) {
  while (path_.size() > 1 && path_.back() == '/') path_.pop_back();
}

void OwnedFolder::take(const std::string& text, bool alone, OtherKey other) {
  for (int stale = 0; stale < kMostTries;) {
    make();
    if (!open_mark()) {
      if (is_empty() && mark(text, alone)) return;
      continue;
    }
    const std::string found = read_mark();
    if (!found.starts_with(first_line(kind_)))
      refuse(path_, std::string("another file named ") + kFolderMark,
             std::string("that of ") + kind_.of, kind_);
    const bool same = key_part(found) == text && notes_of(found);
    if (!same && other == OtherKey::refused) refuse_other(path_, kind_, key_part(found), text);
    const Lock locked = lock(alone);
    if (locked == Lock::refused)
      throw FolderTaken(path_ + ": found another process at work in the folder of " + kind_.of +
                        ", expected none");
    if (locked == Lock::held && same) return;
    if (locked == Lock::held)
      remove();
    else
      ++stale;
  }
  throw Error(ErrorCode::io, mark_path() + ": found another file there " +
                                 std::to_string(kMostTries) +
                                 " times after it was opened, expected the same one");
}

// Another process that ends may remove a folder above this one before this one is made.
void OwnedFolder::make() {
  std::error_code problem;
  for (int tries = 0; tries < kMostTries; ++tries) {
    std::vector<fs::path> absent, made;
    for (fs::path at = path_; !at.empty() && !fs::exists(at, problem); at = at.parent_path())
      absent.push_back(at);
    for (; !absent.empty(); absent.pop_back())
      if (fs::create_directory(absent.back(), problem)) made.push_back(absent.back());
    fs::create_directories(path_, problem);
    if (!problem) {
      if (!made.empty()) made_ = static_cast<unsigned>(made.size());
      return;
    }
    for (; !made.empty(); made.pop_back()) ::rmdir(made.back().c_str());
    if (problem != std::errc::no_such_file_or_directory) break;
  }
  throw Error(ErrorCode::io, path_ + ": create: " + problem.message());
}

void OwnedFolder::remove_made(unsigned folders) const {
  fs::path at = path_;
  for (; folders != 0 && ::rmdir(at.c_str()) == 0; --folders) at = at.parent_path();
}

bool OwnedFolder::open_mark() {
  struct stat info = {};
  if (::lstat(mark_path().c_str(), &info) == 0 && !S_ISREG(info.st_mode))
    refuse(path_, std::string(file_kind(info.st_mode)) + " named " + kFolderMark,
           std::string("the file of ") + kind_.of, kind_);
  mark_ = FileDescriptor(::open(mark_path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (mark_.get() < 0 && errno != ENOENT) throw_system_error(mark_path(), "open");
  return mark_.get() >= 0;
}

// The file has its name only when it is whole and locked.
bool OwnedFolder::mark(const std::string& text, bool alone) try {
  AtomicFile file(mark_path());
  const std::string whole = text + note_line(std::string(kFoldersMade) + std::to_string(made_));
  file.write(std::as_bytes(std::span(whole)));
  lock_file(file.descriptor().get(), alone);
  marked_ = file.commit_new();
  if (marked_) mark_ = std::move(file.descriptor());
  return marked_;
} catch (const Error&) {
  if (!fs::exists(path_)) return false;  // removed by the process that was in it
  throw;
}

// Where a file system has no locks, processes are not kept apart.
OwnedFolder::Lock OwnedFolder::lock(bool alone) {
  if (lock_file(mark_.get(), alone) != 0 && errno == EWOULDBLOCK) return Lock::refused;
  // The process that was in the folder may have removed it since the file was opened.
  return is_here() ? Lock::held : Lock::stale;
}

bool OwnedFolder::is_here() const {
  struct stat opened = {}, named = {};
  return ::fstat(mark_.get(), &opened) == 0 && ::lstat(mark_path().c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

std::string OwnedFolder::read_mark() const {
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

void OwnedFolder::add_note(const std::string& note) {
  const auto notes = notes_of(read_mark());
  if (notes && std::find(notes->begin(), notes->end(), note) != notes->end()) return;
  const std::string line = note_line(note);
  struct stat info = {};
  if (::fstat(mark_.get(), &info) != 0) throw_system_error(mark_path(), "write");
  const ssize_t put = ::pwrite(mark_.get(), line.data(), line.size(), info.st_size);
  if (put == static_cast<ssize_t>(line.size())) return;
  const int reason = put < 0 ? errno : ENOSPC;
  const bool whole = ::ftruncate(mark_.get(), info.st_size) == 0;
  errno = reason;
  throw_system_error(mark_path(), whole ? "write" : "write a line");
}

std::vector<std::string> OwnedFolder::names() const {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(path_, ignored))
    if (entry.path().filename() != kFolderMark) names.push_back(entry.path().filename().string());
  return names;
}

std::vector<std::string> OwnedFolder::own_files() const {
  if (!is_here()) return {};
  const auto notes = notes_of(read_mark()).value_or(std::vector<std::string>{});
  std::vector<std::string> own = names();
  std::erase_if(own, [&](const std::string& name) {
    const std::string_view whole = without_partial(name);
    const bool known = whole == kFolderMark || kind_.is_own(whole, notes);
    return !known || !is_plain_file(path_ + "/" + name);
  });
  return own;
}

std::vector<std::string> OwnedFolder::remove() {
  if (!is_here()) {
    mark_ = {};
    return {};
  }
  for (const std::string& name : own_files()) ::unlink((path_ + "/" + name).c_str());
  std::vector<std::string> left = names();
  const unsigned made = folders_made(notes_of(read_mark()).value_or(std::vector<std::string>{}));
  ::unlink(mark_path().c_str());  // last: what a kill leaves is still marked
  remove_made(made);
  mark_ = {};
  return left;
}

void OwnedFolder::remove_abandoned(const std::string& path, const FolderKind& kind) try {
  OwnedFolder folder(path, kind);
  if (!folder.open_mark()) {
    ::rmdir(path.c_str());  // killed before it was marked, or after: then it is empty
    return;
  }
  if (!folder.read_mark().starts_with(first_line(kind))) return;
  // Where a file system has no locks, nobody knows whether a process is at work: unlike lock(),
  // this then leaves the folder.
  if (lock_file(folder.mark_.get(), true) != 0 || !folder.is_here()) return;
  folder.remove();
  ::rmdir(path.c_str());
} catch (const Error&) {
  // Left as it is.
}

}  // namespace voyager
