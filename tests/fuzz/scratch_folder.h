#pragma once
// One folder of the process, for what can only be tried through files.
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace voyager::fuzz {

inline std::string scratch_file(const char* name) {
  struct Folder {
    Folder() {
      std::string pattern =
          (std::filesystem::temp_directory_path() / "voyager-fuzz-XXXXXX").string();
      if (::mkdtemp(pattern.data()) == nullptr) std::abort();
      path = pattern;
    }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
    std::filesystem::path path;
  };
  static const Folder folder;
  return (folder.path / name).string();
}

}  // namespace voyager::fuzz
