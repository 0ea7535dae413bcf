#include "runtime/bake/work_folder.h"

#include <unistd.h>

#include <filesystem>

#include "runtime/bake/work_files.h"
#include "runtime/base/file.h"
#include "runtime/base/output_path.h"

namespace voyager {
namespace {

constexpr FolderKind kBake = {
    "a bake", "give another --work, or remove the folder",
    [](std::string_view name, std::string_view) { return is_work_file(name); }};

}  // namespace

WorkFolder::WorkFolder(std::string path, const std::string& request, bool alone, bool temporary)
    : folder_(std::move(path), kBake, request, alone), temporary_(temporary && folder_.made()) {}

WorkFolder::~WorkFolder() {
  if (!temporary_) return;
  try {
    remove();
  } catch (const std::exception&) {
    // A folder that cannot be read stays.
  }
}

bool WorkFolder::has(const std::string& name) const {
  std::error_code ignored;
  return std::filesystem::exists(file(name), ignored);
}

void WorkFolder::drop(const std::string& name) const {
  ::unlink(file(name).c_str());
}

void WorkFolder::drop_all() const {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(path(), ignored))
    names.push_back(entry.path().filename().string());
  for (const char* done : {kSplitDone, kSpoolDone}) drop(done);
  for (const std::string& name : names)
    if (name != kMerged && is_work_file(without_partial(name)) && is_plain_file(file(name)))
      drop(name);
  drop(kMerged);
}

std::vector<std::string> WorkFolder::remove() {
  temporary_ = false;
  drop_all();
  return folder_.remove();
}

void WorkFolder::require_space(uint64_t bytes, const std::string& what) const {
  require_room(file(kSpoolDone), bytes, what);
}

}  // namespace voyager
