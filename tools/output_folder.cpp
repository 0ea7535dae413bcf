#include "tools/output_folder.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "runtime/base/error.h"

namespace voyager::tools {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::error_code& error) {
  throw Error(ErrorCode::io, fmt::format("{}: folder: {}", path.string(), error.message()));
}

constexpr const char* kStaging = ".partial-";

// Held for as long as its process lives, in whatever container; -1 where another holds it.
int lock(const std::filesystem::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0 || ::flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
  ::close(fd);
  return -1;
}

// What nobody has locked is a killed process's.
void clear_left_over(const std::filesystem::path& path) {
  std::error_code error;
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(path, error))
    if (entry.path().filename().string().starts_with(kStaging)) found.push_back(entry.path());
  for (const auto& folder : found)
    if (const int fd = lock(folder); fd >= 0) {
      std::filesystem::remove_all(folder, error);
      ::close(fd);
    }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path) : path_(path) {
  created_ = !std::filesystem::exists(path_);
  clear_left_over(path_);
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) fail(path_, error);
  std::string name = (path_ / kStaging).string() + "XXXXXX";
  if (::mkdtemp(name.data()) == nullptr)
    fail(path_, std::error_code(errno, std::generic_category()));
  staging_ = name;
  lock_ = lock(staging_);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(staging_, ignored);
  if (lock_ >= 0) ::close(lock_);
  if (created_) std::filesystem::remove(path_, ignored);  // only if it is empty
}

std::string OutputFolder::place(const std::string& name) {
  names_.push_back(name);
  return (staging_ / name).string();
}

void OutputFolder::commit() {
  for (const std::string& name : names_) {
    std::error_code error;
    std::filesystem::rename(staging_ / name, path_ / name, error);
    if (error) fail(path_ / name, error);
  }
  created_ = false;
}

}  // namespace voyager::tools
