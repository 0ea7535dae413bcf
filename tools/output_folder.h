#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/owned_folder.h"

namespace voyager::tools {

// A folder that fills in one step: files are written to a hidden folder inside
// it and take their places in commit(), over files of their names. Destroyed
// before that, it removes what it wrote, and the folder itself if it made it.
// What a process that was killed left there is removed by the next; nothing
// else ever is. Throws Error(io).
class OutputFolder {
 public:
  // `inputs` and `outputs` are files that the command reads, and writes elsewhere.
  OutputFolder(const std::string& path, std::vector<std::string> inputs,
               std::vector<std::string> outputs = {});
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Before the work: throws where no file of that name could be put, and
  // Error(invalid_argument) where it is one of the inputs or outputs, whatever links lead there.
  void require_place(const std::string& name) const;
  // Where to write the file that will be `name`.
  std::string place(const std::string& name);
  void commit();

 private:
  std::filesystem::path path_;
  std::vector<std::string> inputs_, outputs_;
  std::unique_ptr<OwnedFolder> staging_;
  std::vector<std::string> names_;
  bool created_ = false;
};

}  // namespace voyager::tools
