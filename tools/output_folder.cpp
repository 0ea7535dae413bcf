#include "tools/output_folder.h"

#include <fmt/core.h>
#include <unistd.h>

#include "runtime/base/error.h"

namespace voyager::tools {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::error_code& error) {
  throw Error(ErrorCode::io, fmt::format("{}: folder: {}", path.string(), error.message()));
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path)
    : path_(path), staging_(path_ / fmt::format(".partial-{}", ::getpid())) {
  created_ = !std::filesystem::exists(path_);
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
