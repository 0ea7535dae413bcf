#pragma once
// Where a scene is looked at from, to find out what shows.
#include <cstdint>

#include "runtime/lod/baked_scene.h"

namespace voyager {

// Scene-local metres; x right, y down, z forward.
struct Viewpoint {
  Vec3d eye;
  Mat3d world_to_view;
};

// Of the picture from each, pixels: 1920×1080 at a focal length of 1400, by four.
inline constexpr int kPictureWidth = 480, kPictureHeight = 270;
inline constexpr double kPictureFocal = 350;

// Viewpoints of a scene with at least one leaf: each looks at a leaf from some way off, in any
// direction. The k-th is the same whatever comes before it; those from 0 to any k are spread evenly
// (Halton's sequence) over leaves, directions and the logarithm of the distance.
class Viewpoints {
 public:
  explicit Viewpoints(const BakedScene& baked);
  Viewpoint operator()(uint32_t k) const;

 private:
  const BakedScene& baked_;
  double radius_;  // of the scene without what is far out
};

}  // namespace voyager
