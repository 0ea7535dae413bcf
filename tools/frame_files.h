#pragma once
// Where the results of each frame go (the contract in docs/command-line.md).
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/renderer.h"

namespace voyager::tools {

struct OutputPaths {
  std::string image;  // a .png or .pfm, or a folder for a walk
  std::string depth;  // "", a .pfm, or a folder
  std::string cut;    // "", a .txt, or a folder
  std::string stats;  // "" or a .json
  bool walk = false;  // the first three are folders; files are 0000.png, ...
  bool floats = false;
};

class FrameFiles {
 public:
  explicit FrameFiles(OutputPaths paths);  // creates the folders of a walk

  // Writes camera `index`'s image, depth and cut, and keeps its statistics.
  void write(size_t index, const Camera& camera, const Renderer& renderer);
  void write_stats(const std::vector<VoySceneNote>& notes);

 private:
  std::string place(const std::string& path, size_t index, const char* extension) const;

  OutputPaths paths_;
  nlohmann::ordered_json frames_ = nlohmann::json::array();
};

}  // namespace voyager::tools
