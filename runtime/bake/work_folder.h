#pragma once
// The folder that a bake in parts works in. What is finished stands in files that
// appear in one step, so that a bake killed at any moment goes on from the last of
// them. docs/baking.md lists them.
#include <string>
#include <vector>

#include "runtime/base/file_descriptor.h"

namespace voyager {

class WorkFolder {
 public:
  // Made if absent, and then marked with `request`, lines of what is baked and how. A
  // folder of another request is refused (Error(refused_input), naming the first line
  // that differs). `alone` keeps others out while the object lives; else others that
  // are not alone may be in, too (Error(io) where that cannot be had).
  WorkFolder(std::string path, const std::string& request, bool alone);

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  bool has(const std::string& name) const;
  void drop(const std::string& name) const;  // no error where it is not there
  void drop_all();                           // the folder, too

  // Error(io) where the device has not so many bytes free; `what` needs them.
  void require_space(uint64_t bytes, const std::string& what) const;

 private:
  std::string path_;
  FileDescriptor lock_;
};

}  // namespace voyager
