#include "tools/synth/pieces.h"

namespace voyager::synth {

void add_wall(Surfaces& out, const WallPlane& plane, double s0, double s1, double h0, double h1,
              const Vec3f& colour, Material material, double outwards) {
  if (s1 - s0 < 0.02 || h1 - h0 < 0.02) return;
  const Vec3d up{0.0, -1.0, 0.0};
  const Vec3d corner = plane.left + s0 * plane.right + h0 * up + outwards * plane.normal;
  out.push_back(
      {corner, (s1 - s0) * plane.right, (h1 - h0) * up, plane.normal, 0, 0, colour, material});
}

void add_level(Surfaces& out, double x0, double z0, double x1, double z1, double height,
               const Vec3f& colour, Material material) {
  if (x1 - x0 < 0.02 || z1 - z0 < 0.02) return;
  out.push_back(
      {{x0, -height, z0}, {x1 - x0, 0, 0}, {0, 0, z1 - z0}, {0, -1, 0}, 0, 0, colour, material});
}

void add_box(Surfaces& out, double x0, double z0, double x1, double z1, double low, double high,
             const Vec3f& colour, Material material) {
  add_wall(out, {{x0, 0, z0}, {1, 0, 0}, {0, 0, -1}}, 0, x1 - x0, low, high, colour, material);
  add_wall(out, {{x0, 0, z1}, {1, 0, 0}, {0, 0, 1}}, 0, x1 - x0, low, high, colour, material);
  add_wall(out, {{x0, 0, z0}, {0, 0, 1}, {-1, 0, 0}}, 0, z1 - z0, low, high, colour, material);
  add_wall(out, {{x1, 0, z0}, {0, 0, 1}, {1, 0, 0}}, 0, z1 - z0, low, high, colour, material);
  add_level(out, x0, z0, x1, z1, high, colour, material);
}

}  // namespace voyager::synth
