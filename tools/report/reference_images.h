#pragma once
// What a report compares with: the float64 reference's images of the scene as it is in its file.
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "tools/frame_bench.h"

namespace voyager::tools {

// What an image shows: every leaf, or what is chosen at a tau.
struct Detail {
  Lod lod = Lod::all_leaves;
  double tau = 0;
};

class ReferenceImages {
 public:
  // Kept in `folder`, so that a report that goes on does not draw them again.
  ReferenceImages(std::shared_ptr<const Scene> scene, std::vector<FrameInput> frames,
                  std::filesystem::path folder, Workers& workers);
  ~ReferenceImages();

  const RgbaImage& of(size_t frame, Detail detail);
  size_t width(size_t frame) const { return frames_[frame].eyes[0].camera.width; }
  const std::vector<FrameInput>& frames() const { return frames_; }

 private:
  using Key = std::tuple<size_t, Lod, double>;  // frame; of what

  RgbaImage draw(const Key& key);
  std::filesystem::path path_of(const Key& key) const;
  std::optional<RgbaImage> read(const Key& key) const;

  std::shared_ptr<const Scene> scene_;
  std::vector<FrameInput> frames_;
  std::filesystem::path folder_;
  Workers& workers_;
  std::unique_ptr<Backend> backend_;
  std::map<Key, RgbaImage> images_;
};

}  // namespace voyager::tools
