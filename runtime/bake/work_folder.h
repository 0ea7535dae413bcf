#pragma once
// The folder that a bake in parts works in. What is finished stands in files that
// appear in one step, so that a bake killed at any moment goes on from the last of
// them. docs/baking.md lists them.
#include <string>
#include <vector>

#include "runtime/base/output_path.h"
#include "runtime/base/owned_folder.h"

namespace voyager {

class WorkFolder {
 public:
  // Makes the folder if it is absent, and marks it with `request`, lines of what is baked and how.
  // Throws Error(refused_input) for a folder of another request, or with files of anybody else.
  // With `alone` no other process may be in the folder while the object lives; without it, others
  // may that are not alone either. Throws FolderTaken if another process prevents that. With
  // `temporary` the object's end removes the folder, if the object has marked it. A folder in which
  // nothing was written is removed too.
  WorkFolder(const std::string& path, const std::string& request, bool alone, bool temporary);
  ~WorkFolder();
  // Removes what a bake that was killed has left, as OwnedFolder::remove_abandoned() does.
  static void remove_abandoned(const std::string& path);
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::string& path() const { return folder_.path(); }
  std::string file(const std::string& name) const { return path() + "/" + name; }
  bool has(const std::string& name) const;
  void drop(const std::string& name) const;  // no error where it is not there
  // All files of the bake, in an order in which a bake that goes on after a kill trusts none of
  // them.
  void drop_all() const;
  // The folder, too, unless it was there before. Returns what is in it that no bake has written:
  // that stays.
  std::vector<std::string> remove();

  // Before files of that many cells are written: no others are removed.
  void expect_cells(uint32_t cells);
  // For require_room().
  Room room(uint64_t bytes, const std::string& what) const;

 private:
  OwnedFolder folder_;
  bool alone_, temporary_;
};

}  // namespace voyager
