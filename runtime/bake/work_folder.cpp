#include "runtime/bake/work_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/statvfs.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "runtime/bake/sealed_file.h"
#include "runtime/base/error.h"

namespace voyager {
namespace {

constexpr const char* kRequest = "request";

void compare(const std::string& path, const std::string& kept, const std::string& asked) {
  std::istringstream before(kept), now(asked);
  for (std::string old_line, new_line; before || now;) {
    if (!std::getline(before, old_line)) old_line.clear();
    if (!std::getline(now, new_line)) new_line.clear();
    if (old_line == new_line) continue;
    const auto named = [](const std::string& line) { return line.empty() ? "nothing" : line; };
    throw Error(ErrorCode::refused_input, path + ": found a bake of \"" + named(old_line) +
                                              "\", expected \"" + named(new_line) +
                                              "\": give another --work, or remove the folder");
  }
}

}  // namespace

WorkFolder::WorkFolder(std::string path, const std::string& request, bool alone)
    : path_(std::move(path)) {
  std::error_code problem;
  std::filesystem::create_directories(path_, problem);
  if (problem) throw Error(ErrorCode::io, path_ + ": create: " + problem.message());
  lock_ = FileDescriptor(::open(file("lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (lock_.get() < 0) throw Error(ErrorCode::io, path_ + ": lock: " + std::strerror(errno));
  if (::flock(lock_.get(), (alone ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Error(ErrorCode::io, path_ + ": found another bake at work in it, expected none");
  if (has(kRequest)) {
    const std::vector<std::byte> kept = read_sealed(file(kRequest));
    compare(path_, {reinterpret_cast<const char*>(kept.data()), kept.size()}, request);
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    if (const std::string name = entry.path().filename().string();
        name != "lock" && name.rfind("request.", 0) != 0)
      throw Error(ErrorCode::refused_input,
                  path_ + ": found " + name + ", expected an empty folder or one of a bake");
  write_sealed(file(kRequest), std::as_bytes(std::span(request)));
}

bool WorkFolder::has(const std::string& name) const {
  std::error_code ignored;
  return std::filesystem::exists(file(name), ignored);
}

void WorkFolder::drop(const std::string& name) const {
  std::error_code ignored;
  std::filesystem::remove(file(name), ignored);
}

void WorkFolder::drop_all() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void WorkFolder::require_space(uint64_t bytes, const std::string& what) const {
  struct statvfs info = {};
  if (::statvfs(path_.c_str(), &info) != 0) return;
  const uint64_t free = uint64_t{info.f_bavail} * info.f_frsize;
  if (free < bytes)
    throw Error(ErrorCode::io, path_ + ": found " + std::to_string(free / 1000000) +
                                   " MB free on the device, expected " +
                                   std::to_string(bytes / 1000000 + 1) + " MB for " + what);
}

}  // namespace voyager
