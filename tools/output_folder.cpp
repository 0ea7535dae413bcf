#include "tools/output_folder.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include "runtime/base/error.h"
#include "runtime/base/output_path.h"
#include "tools/output_paths.h"

namespace voyager::tools {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::error_code& error) {
  throw Error(ErrorCode::io, fmt::format("{}: folder: {}", path.string(), error.message()));
}

constexpr const char* kStaging = ".partial-";

// Its notes list the files.
constexpr FolderKind kPartialOutput = {
    "an output that is not complete", "remove it",
    [](std::string_view name, const std::vector<std::string>& notes) {
      return std::find(notes.begin(), notes.end(), name) != notes.end();
    }};

void clear_left_over(const std::filesystem::path& path) {
  std::error_code error;
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(path, error))
    if (entry.path().filename().string().starts_with(kStaging)) found.push_back(entry.path());
  for (const auto& folder : found) OwnedFolder::remove_abandoned(folder.string(), kPartialOutput);
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, std::vector<std::string> inputs,
                           std::vector<std::string> outputs)
    : path_(path), inputs_(std::move(inputs)), outputs_(std::move(outputs)) {
  created_ = !std::filesystem::exists(path_);
  clear_left_over(path_);
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) fail(path_, error);
  std::string name = (path_ / kStaging).string() + "XXXXXX";
  try {
    if (::mkdtemp(name.data()) == nullptr)
      fail(path_, std::error_code(errno, std::generic_category()));
    staging_ = std::make_unique<OwnedFolder>(name, kPartialOutput, "", true);
  } catch (...) {
    ::rmdir(name.c_str());
    if (created_) ::rmdir(path_.c_str());
    throw;
  }
}

OutputFolder::~OutputFolder() {
  staging_->remove();
  ::rmdir(staging_->path().c_str());
  if (created_) ::rmdir(path_.c_str());  // only if it is empty
}

void OutputFolder::require_place(const std::string& name) const {
  const std::string file = (path_ / name).string();
  require_distinct({file}, inputs_);
  for (const std::string& output : outputs_) require_distinct({output, file}, {});
  require_replaceable(file);
}

std::string OutputFolder::place(const std::string& name) {
  staging_->add_note(name);
  names_.push_back(name);
  return staging_->path() + "/" + name;
}

void OutputFolder::commit() {
  for (const std::string& name : names_) require_place(name);
  for (const std::string& name : names_) {
    std::error_code error;
    std::filesystem::rename(staging_->path() + "/" + name, path_ / name, error);
    if (error) fail(path_ / name, error);
  }
  created_ = false;
}

}  // namespace voyager::tools
