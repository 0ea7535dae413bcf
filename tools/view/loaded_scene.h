#pragma once
// A scene that can be drawn, with what the viewer has to know of it.
#include <memory>
#include <string>
#include <vector>

#include "tools/cameras.h"
#include "voyager/voyager.hpp"

namespace voyager::view {

// A file in memory, as Voyager reads it. Its address must not change while a scene reads it.
class MemoryFile {
 public:
  MemoryFile(std::string name, std::vector<std::byte> bytes)
      : name_(std::move(name)), bytes_(std::move(bytes)) {}
  VoyByteSource source() const;

 private:
  std::string name_;
  std::vector<std::byte> bytes_;
};

struct LoadedScene {
  std::unique_ptr<MemoryFile> memory;  // of a sample; destroyed after the scene
  voy::Scene scene;
  VoySceneInfo info = VOY_SCENE_INFO_INIT;
  std::string path;        // as it was asked for
  std::string file;        // that is drawn: `path`, or its bake; "" for a sample
  uint64_t gaussians = 0;  // of the whole scene
  bool first = true;       // of its path: the view goes to `camera`
  tools::Camera camera = {};

  bool has_tree() const { return info.storage != VOY_SCENE_STORAGE_FLAT; }
  bool streamed() const { return has_tree(); }
};

}  // namespace voyager::view
