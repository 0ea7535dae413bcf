#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace voyager::tools {

// A folder that fills in one step: files are written to a hidden folder inside
// it and take their places in commit(). Destroyed before that, it removes what
// it wrote, and the folder itself if it made it. What a process that was killed
// left there is removed by the next. Throws Error(io).
class OutputFolder {
 public:
  explicit OutputFolder(const std::string& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Where to write the file that will be `name`.
  std::string place(const std::string& name);
  void commit();

 private:
  std::filesystem::path path_, staging_;
  std::vector<std::string> names_;
  bool created_ = false;
  int lock_ = -1;  // of staging_
};

}  // namespace voyager::tools
