#pragma once
// Where a scene is looked at from while its nodes learn. No camera of the scene's is needed; where
// some are known, they guide up to half of the views.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/frame/node_trainer.h"
#include "runtime/lod/baked_scene.h"
#include "runtime/scene/training_camera.h"

namespace voyager {

// What views look at.
struct LookedAt {
  size_t leaves;     // the scene's first ones, at least one
  double leaf_size;  // metres: the extent of nodes that stand as leaves, 0 where none do
  // The greatest extent of what learns, which is drawn at the default τ from the farthest eye; 0:
  // the scene is whole, and eyes are as far as three of its radii.
  double largest;
};

// Each looks at a leaf, from outside or from amid the scene. The k-th is the same whatever comes
// before it; those from 0 to any k are spread evenly (Halton's sequence) over leaves, directions
// and the logarithm of the distance. Where there are cameras, up to half of the views stand near
// one that has their leaf in its picture: as many as find one among 64.
class TrainingViews {
 public:
  // cameras: in the scene's world.
  TrainingViews(const BakedScene& baked, const LookedAt& looked_at,
                std::span<const TrainingCamera> cameras = {});

  // At the default τ.
  TrainingView operator()(uint32_t k) const;
  // The k-th picture to learn from. Each view gives four, one after another, of cuts from fine to
  // coarse. The truth costs more than a cut, and is then drawn once for all four.
  TrainingView picture(uint32_t k) const;
  // From the eye to the leaf, metres.
  double distance(uint32_t k) const;

 private:
  struct Look {
    Vec3d target, outward, right;  // scene-local; the eye is at target + distance * outward
    double distance;
  };
  Look look(uint32_t k) const;
  // None where no camera that is tried has the target in its picture.
  std::optional<Look> look_from_camera(uint64_t index, const Vec3d& target) const;

  const BakedScene& baked_;
  size_t leaves_;       // that are looked at
  Mat3d axes_;          // rows: two level ones, and up
  double lowest_rise_;  // sine of the elevation
  double nearest_, farthest_;
  // Scene-local. aside: metres, how far from it eyes stand at most, along each level axis.
  struct Stand {
    TrainingCamera camera;
    double aside;
  };
  static std::vector<Stand> stands_of(std::span<const TrainingCamera> cameras, const Vec3d& origin);
  std::vector<Stand> stands_;
  uint32_t smaller_;  // than 1920×1080 at a focal length of 1400: by so much along each side
};

}  // namespace voyager
