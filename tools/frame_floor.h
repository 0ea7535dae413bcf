#pragma once
// The least time that a frame's work takes on a device that does nothing else, whatever
// the kernels: memory bounds projection, sorting and output, issue slots bound blending.
//   project = (Gp·12 + V·(b_attr − 12 + 28)) / B      every mean is read; of visible ones
//                                                     the rest is too, and a splat written
//   sort    = (V·68 + K·26) / B                       splats by depth in 32-bit keys, then
//                                                     pairs stably by 16-bit tile keys
//   blend   = Pu·11 / I                               the shortest binary32 loop that is known
//   out     = pixels·bytes / B
// with B bytes and I lane-instructions a second. The search is not in the model.
#include "runtime/frame/backend.h"

namespace voyager::tools {

// Of one frame, or means over several.
struct FrameWork {
  double cut = 0;             // Gp: Gaussians in the cut
  double splats = 0;          // V: visible ones
  double pairs = 0;           // K: (tile, splat)
  double pixels_blended = 0;  // Pu: (pixel, splat)
  double pixels = 0;          // of the image
  double pixel_bytes = 0;
  double attribute_bytes = 0;  // b_attr: what is read of a visible Gaussian, its mean included
};

// Milliseconds.
struct FrameFloor {
  double project = 0, sort = 0, blend = 0, out = 0;
  double frame() const { return project + sort + blend + out; }
};

// Jetson AGX Orin 64: 16 multiprocessors at 1.3 GHz.
inline constexpr DeviceRates kOrin{2.66e12, 204.8e9};

inline constexpr double kBlendInstructions = 11;  // issue slots of a blended (pixel, splat) pair

// Both rates are above 0.
FrameFloor frame_floor(const FrameWork& work, const DeviceRates& rates);

// Milliseconds of a stage that has to move so many bytes and issue so many lane-instructions.
double stage_floor(double bytes, double instructions, const DeviceRates& rates);

// b_attr of binary32 Gaussians: mean, rotation, scale, opacity and SH coefficients.
double stored_bytes(int sh_degree);

// b_attr of a backend that stores so many bytes a Gaussian; 0: unknown, then stored_bytes().
double attribute_bytes(double gaussian_bytes, int sh_degree);

}  // namespace voyager::tools
