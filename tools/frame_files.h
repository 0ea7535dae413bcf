#pragma once
// Where the results of each frame go (the contract in docs/command-line.md).
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/base/output_path.h"
#include "tools/output_folder.h"
#include "tools/renderer.h"

namespace voyager::tools {

struct OutputPaths {
  std::string image;       // a .png or .pfm, or a folder
  std::string depth;       // "", a .pfm, or a folder
  std::string cut;         // "", a .txt, or a folder
  std::string stats;       // "" or a .json
  bool images_in = false;  // folders: image and depth; files are 0000.png, ...
  bool cuts_in = false;    // a folder: cut
  bool floats = false;
};

class FrameFiles {
 public:
  // Throws Error(io) where an output cannot be written. expect() refuses to replace the inputs.
  FrameFiles(OutputPaths paths, std::vector<std::string> inputs);

  // Before the first frame, with the numbers and cameras of all that write() will be given: throws
  // Error(io) where one of their files could not be put in its place, or all of them have no room;
  // Error(invalid_argument) where one is an input or another output.
  void expect(size_t first, std::span<const Camera> cameras, size_t eyes) const;
  // Writes a frame's images and depths, numbered by camera from `first` on, and its cut, numbered
  // by frame; and keeps its statistics.
  void write(size_t first, std::span<const Camera> cameras, const Renderer& renderer);
  // Puts the files of folders in their places, and writes the statistics.
  void finish(const Renderer& renderer);

 private:
  // One of the outputs: a file, or a folder.
  struct Output {
    std::string file;
    std::unique_ptr<OutputFolder> folder;
    bool wanted() const { return !file.empty() || folder; }
    std::string place(size_t index, const char* extension) const;
    void expect(size_t index, const char* extension) const;
    // Of all its files, where it is wanted.
    std::vector<Room> room(uint64_t bytes, const char* what) const;
  };
  struct OtherFiles {
    std::vector<std::string> inputs, outputs;
  };
  static Output open(const std::string& path, bool folder, const OtherFiles& others);
  const char* image_extension() const { return floats_ ? ".pfm" : ".png"; }
  void write_image(size_t index, const Camera& camera, const RenderedImage& image);
  void write_stats(const Renderer& renderer) const;

  bool floats_;
  std::string stats_;
  Output image_, depth_, cut_;
  nlohmann::ordered_json frames_ = nlohmann::json::array();
};

}  // namespace voyager::tools
