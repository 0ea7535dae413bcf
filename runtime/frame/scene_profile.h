#pragma once
// What a scene holds, as far as it decides what is stored, loaded and launched for it
// (docs/omissions.md). Found at open; a bake has left out by then what it says of SH.
#include <array>
#include <cstdint>

#include "runtime/base/workers.h"

namespace voyager {

struct Scene;

struct SceneProfile {
  int input_sh_degree =
      0;                // of the file that was opened or baked; Scene::sh_degree is what is kept
  bool merged = false;  // has nodes that stand for several Gaussians
  bool interpolated = false;  // a cut may draw a node between its parent and itself
  // False of a streamed scene, which has not read its chunks: what follows is then not known.
  bool complete = false;
  std::array<uint64_t, 4> chunks_of_degree{};  // chunks by the SH degree that they use
  uint64_t opacities_above_one = 0;            // nodes
  // Longest axis over shortest, of any node's Gaussian; 0 where there is none.
  float least_anisotropy = 0, greatest_anisotropy = 0;
};

// What the loaded Gaussians show: opacities and anisotropy.
void complete_profile(Scene& scene, Workers& workers);

}  // namespace voyager
