#pragma once
#include "runtime/math/vec.h"
#include "tools/synth/random.h"
#include "tools/synth/surface.h"

namespace voyager::synth {

// Adds to sh[k][rgb], all 16 coefficients: what a point of the surface sends towards
// every viewer. `sunlit`: no building stands before the sun.
void light_point(const Surface& surface, const Vec3d& point, const Vec3d& normal,
                 const Vec3f& albedo, bool sunlit, Random& random, float (&sh)[16][3]);

}  // namespace voyager::synth
