#include "runtime/bake/work_folder.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "runtime/bake/work_files.h"
#include "runtime/base/file.h"

namespace voyager {
namespace {

constexpr std::string_view kCells = "cells ";  // the note of how many there are

bool is_own(std::string_view name, const std::vector<std::string>& notes) {
  uint32_t most = 0;
  for (const std::string& note : notes) {
    uint32_t cells = 0;
    if (note.starts_with(kCells))
      std::from_chars(note.data() + kCells.size(), note.data() + note.size(), cells);
    most = std::max(most, cells);
  }
  return is_work_file(name, most);
}

constexpr FolderKind kBake = {"a bake", "give another --work, or remove the folder", is_own};

}  // namespace

WorkFolder::WorkFolder(const std::string& path, const std::string& request, bool alone,
                       bool temporary)
    : folder_(path, kBake, request, alone),
      alone_(alone),
      temporary_(temporary && folder_.marked()) {}

WorkFolder::~WorkFolder() {
  try {
    if (temporary_ || (alone_ && folder_.own_files().empty())) remove();
  } catch (const std::exception&) {
    // A folder that cannot be read stays.
  }
}

void WorkFolder::remove_abandoned(const std::string& path) {
  OwnedFolder::remove_abandoned(path, kBake);
}

bool WorkFolder::has(const std::string& name) const {
  std::error_code ignored;
  return std::filesystem::exists(file(name), ignored);
}

void WorkFolder::drop(const std::string& name) const {
  ::unlink(file(name).c_str());
}

void WorkFolder::drop_all() const {
  const std::vector<std::string> files = folder_.own_files();
  for (const char* done : {kSplitDone, kSpoolDone}) drop(done);
  for (const std::string& name : files)
    if (name != kMerged) drop(name);
  drop(kMerged);
}

std::vector<std::string> WorkFolder::remove() {
  temporary_ = alone_ = false;
  drop_all();
  return folder_.remove();
}

void WorkFolder::expect_cells(uint32_t cells) {
  folder_.add_note(std::string(kCells) + std::to_string(cells));
}

Room WorkFolder::room(uint64_t bytes, const std::string& what) const {
  return {path() + "/", bytes, what};
}

}  // namespace voyager
