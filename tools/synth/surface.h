#pragma once
// What the city is made of before it becomes Gaussians: flat pieces and leafy
// crowns. Pieces that lie in one plane do not overlap, so that an order by
// depth alone draws them right.
#include <cstdint>
#include <vector>

#include "runtime/math/vec.h"

namespace voyager::synth {

enum class Material : uint8_t {
  plaster,
  brick,
  hidden_wall,
  trim,
  glass,
  metal,
  tiles,
  gravel,
  asphalt,
  paint,
  paving,
  grass,
  car_paint,
  bark,
  leaves,
};

struct Surface {
  Vec3d corner;  // metres; a crown's centre
  Vec3d u, v;    // edges, at right angles; a crown's radii are u.x (across) and v.y (along y)
  Vec3d normal;  // unit, outwards
  // The far edge (at corner + v) is shorter by these fractions of u on the left and right.
  double inset_left = 0, inset_right = 0;
  Vec3f colour;  // albedo, 0 to 1
  Material material;

  double area() const;    // square metres
  double weight() const;  // its share of the scene's Gaussians: area times the material's detail
};

// What a material is like to look at.
struct MaterialLook {
  float detail;   // Gaussians a square metre, relative
  float mottle;   // spread of brightness from one Gaussian to the next
  float gloss;    // strength of the mirrored sky and sun
  float stretch;  // length to width of its Gaussians
};
const MaterialLook& look(Material material);

// Albedo at (s, t) metres along u and v from the corner.
Vec3f albedo(const Surface& surface, double s, double t);

}  // namespace voyager::synth
