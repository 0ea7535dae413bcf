#pragma once
// The SH coefficients of a scene's Gaussians in memory: those of a compact file as rows of bytes
// (runtime/math/sh_code.h), the others in binary32. Both give the same bits.
#include "runtime/frame/scene.h"

namespace voyager {

// Whether a scene keeps rows: what a compact file stores, where there is more than the constant.
inline bool packs_sh(Storage storage, int degree) {
  return storage == Storage::compact && degree > 0;
}
inline bool packs_sh(const Scene& scene) {
  return packs_sh(scene.storage, scene.sh_degree);
}
// Bytes of a Gaussian.
size_t sh_bytes(Storage storage, int degree);
inline size_t sh_bytes(const Scene& scene) {
  return sh_bytes(scene.storage, scene.sh_degree);
}

// Empties the arrays, then makes room; groups: of Gaussians that have their scales in common.
void make_sh_room(size_t gaussians, size_t groups, Scene& scene);
// scales: that the chunk's coefficients were restored with. The groups of one chunk at a time.
void set_sh_scales(size_t group, const ShScales& scales, Scene& scene);
void set_sh(size_t index, size_t group, const float* sh, Scene& scene);

// coefficients() * 3 floats, [k][rgb].
void copy_sh(const Scene& scene, size_t index, float* sh);
// Leaves out the bands above.
void lower_sh_degree(int degree, Scene& scene);

}  // namespace voyager
