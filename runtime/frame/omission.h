#pragma once
// What a view does without, because its scenes or its choices do not ask for it, and what that
// saves (docs/omissions.md).
#include <cstdint>
#include <string>
#include <vector>

namespace voyager {

struct Omission {
  std::string what, why;
  uint64_t bytes;        // of memory that is not taken
  uint64_t frame_bytes;  // that a frame would move through a device's memory, at least; 0: unknown
};

// What a view's frames came with so far.
struct ViewShape {
  uint32_t eyes = 1;
  uint64_t pixels = 0;     // of the largest eye's image in the pipeline's own memory; 0: none
  bool depth = false;      // some frame had it in these images
  uint64_t eye_bytes = 0;  // that each eye takes of the view's memory, at least
};

struct Scene;

// Of a scene: what it notes itself, and what its view needs no search or residency for.
// splats: that one eye sees of it; 0: not known.
std::vector<Omission> omissions_of(const Scene& scene, bool searched, uint64_t splats);
// What every pipeline leaves out alike.
std::vector<Omission> omissions_of(const ViewShape& shape);

}  // namespace voyager
