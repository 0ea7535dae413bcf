#pragma once
// What a report compares with: the float64 reference's images of the scene as it is in its file.
#include <filesystem>
#include <memory>
#include <vector>

#include "tools/frame_bench.h"

namespace voyager::tools {

// What images show: every leaf, or what is chosen at a tau.
struct Detail {
  Lod lod = Lod::all_leaves;
  std::vector<double> taus;  // of a cut: one an image

  bool operator==(const Detail&) const = default;
};

class ReferenceImages {
 public:
  // Of `chosen` of a path's frames. Kept in `folder`, so that a report that goes on does not draw
  // them again.
  ReferenceImages(std::shared_ptr<const Scene> scene, std::vector<FrameInput> path,
                  std::vector<size_t> chosen, std::filesystem::path folder, Workers& workers);
  ~ReferenceImages();

  // Good until another cut's are asked for: of all that were, those of every leaf and those of the
  // last cut are in memory.
  const std::vector<RgbaImage>& of(Detail detail);

 private:
  struct Held {
    Detail detail;
    std::vector<RgbaImage> images;
  };
  struct Key {
    size_t frame;
    Lod lod;
    double tau;
  };

  RgbaImage image(const Key& key);
  RgbaImage draw(const Key& key);

  std::shared_ptr<const Scene> scene_;
  std::vector<FrameInput> path_;
  std::vector<size_t> chosen_;
  std::filesystem::path folder_;
  Workers& workers_;
  std::unique_ptr<Backend> backend_;
  Held all_leaves_, cut_;
};

}  // namespace voyager::tools
