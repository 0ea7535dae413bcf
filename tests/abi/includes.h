#pragma once
// The #include lines of source files.
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

struct Include {
  std::string file;  // relative to the source folder
  std::string name;  // as written, without its quotes or brackets
};

// Of every C, C++ and CUDA file below `folder`, which is relative to VOYAGER_SOURCE_DIR.
inline std::vector<Include> includes_below(const std::string& folder) {
  namespace fs = std::filesystem;
  static const std::set<std::string> sources = {".c", ".cpp", ".h", ".hpp", ".cu", ".cuh"};
  const std::regex line_pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  const fs::path root = VOYAGER_SOURCE_DIR;
  std::vector<Include> found;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (sources.count(entry.path().extension().string()) == 0) continue;
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string line; std::getline(file, line);)
      if (std::regex_search(line, match, line_pattern))
        found.push_back({fs::relative(entry.path(), root).string(), match[1].str()});
  }
  return found;
}
