#include "tools/output_folder.h"

#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string_view>

#include "runtime/base/error.h"

namespace voyager::tools {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::error_code& error) {
  throw Error(ErrorCode::io, fmt::format("{}: folder: {}", path.string(), error.message()));
}

constexpr std::string_view kStaging = ".partial-";

// The folder's name has the number of a process that is no more: that process was killed. One of
// this process's number is another's, of before.
bool is_left_over(const std::filesystem::path& folder) {
  const std::string name = folder.filename().string();
  if (!name.starts_with(kStaging)) return false;
  pid_t process = 0;
  const char* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + kStaging.size(), end, process);
  if (error != std::errc() || stop != end || process <= 0) return false;
  return process == ::getpid() || (::kill(process, 0) != 0 && errno == ESRCH);
}

void clear_left_over(const std::filesystem::path& path) {
  std::error_code error;
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(path, error))
    if (is_left_over(entry.path())) found.push_back(entry.path());
  for (const auto& folder : found) std::filesystem::remove_all(folder, error);
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path)
    : path_(path), staging_(path_ / fmt::format("{}{}", kStaging, ::getpid())) {
  created_ = !std::filesystem::exists(path_);
  clear_left_over(path_);
  std::error_code error;
  std::filesystem::create_directories(staging_, error);
  if (error) fail(path_, error);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(staging_, ignored);
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
