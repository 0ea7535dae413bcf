#pragma once
// METHOD §5 and §12 in float64. The order of splats, the near plane, clip boxes and the
// interpolated mean are binary32 by contract (§6).
#include <optional>

#include "runtime/frame/backend.h"
#include "runtime/math/projection.h"
#include "runtime/stages/interpolate.h"

namespace voyager::reference {

struct Splat {
  double x, y;  // centre, pixels
  Conic<double> conic;
  double half_width, half_height;  // of the support, pixels, with slack
  double rho_min, opacity;
  Vec3d colour;
  double t, inverse_k;
  float depth;
};

// camera: in the scene's coordinates. look: the instance's.
std::optional<Splat> project(const Scene& scene, const Camera& camera, const PipelineDesc& desc,
                             const InstanceLook& look, const DrawItem& cut_item);

}  // namespace voyager::reference
