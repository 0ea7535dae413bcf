#pragma once
// Where the image of one eye shows what another eye sees.
//
// Let A and b take view space of the eye now to that of the eye drawn from: p' = A p + b. A pixel
// now looks along d = (tx, ty, 1), and what it sees has z there and w = 1/z. It is seen at
//   p' / z = A d + b w
// in the image that was drawn, of any w from 0, infinitely far. Its depth there, z' = 1/w', says
//   1/w = z = (Aᵀ (z' d' - b))_z,   so   w = w' / (Aᵀ (d' - b w'))_z.
// The two are solved for w and the place by turns (shaders/reprojection.glsl).
#include "runtime/math/affine.h"

namespace voyager {

// An eye: rows right, down, forward; tangents as in a VoyFrustum.
struct EyeView {
  Mat3d world_to_view;
  Vec3d position;
  double left = 0, right = 0, up = 0, down = 0;
};

// As the shader takes it: tangents are first, and span over the image, to the right and down.
struct Reprojection {
  float rows[3][4];  // of A, and b
  float drawn[4], now[4];
};

inline Reprojection reprojection(const EyeView& drawn, const EyeView& now) {
  const Mat3d turn = drawn.world_to_view * transposed(now.world_to_view);
  const Vec3d apart = now.position - drawn.position;
  Reprojection out{};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) out.rows[i][k] = static_cast<float>(turn.row[i][k]);
    out.rows[i][3] = static_cast<float>(dot(drawn.world_to_view.row[i], apart));
  }
  const auto tangents = [](const EyeView& eye, float(&to)[4]) {
    to[0] = static_cast<float>(eye.left);
    to[1] = static_cast<float>(-eye.up);
    to[2] = static_cast<float>(eye.right - eye.left);
    to[3] = static_cast<float>(eye.up - eye.down);
  };
  tangents(drawn, out.drawn);
  tangents(now, out.now);
  return out;
}

}  // namespace voyager
