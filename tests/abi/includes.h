#pragma once
// The #include lines of source files.
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

struct Include {
  std::string file;  // relative to the source folder
  std::string name;  // as written, without its quotes or brackets
};

// The name in an include line, else "".
inline std::string included_name(const std::string& line) {
  size_t at = line.find_first_not_of(" \t");
  if (at == std::string::npos || line[at] != '#') return "";
  at = line.find_first_not_of(" \t", at + 1);
  if (at == std::string::npos || line.compare(at, 7, "include") != 0) return "";
  const size_t open = line.find_first_of("<\"", at + 7);
  if (open == std::string::npos) return "";
  const size_t close = line.find_first_of(">\"", open + 1);
  return close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
}

// Of every C, C++ and CUDA file below `folder`, which is relative to VOYAGER_SOURCE_DIR.
inline std::vector<Include> includes_below(const std::string& folder) {
  namespace fs = std::filesystem;
  static const std::set<std::string> sources = {".c", ".cpp", ".h", ".hpp", ".cu", ".cuh"};
  const fs::path root = VOYAGER_SOURCE_DIR;
  std::vector<Include> found;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (sources.count(entry.path().extension().string()) == 0) continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      if (const std::string name = included_name(line); !name.empty())
        found.push_back({fs::relative(entry.path(), root).string(), name});
  }
  return found;
}
