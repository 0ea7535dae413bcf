#pragma once
// The box of an instance outside of which nothing of its scene is drawn.
#include <cmath>
#include <limits>

#include "runtime/math/vec.h"

namespace voyager {

// least > greatest on no axis.
template <class T>
struct ClipBox {
  Vec3<T> least, greatest;
};

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();
inline constexpr ClipBox<double> kNoClip{{-kNoLimit, -kNoLimit, -kNoLimit},
                                         {kNoLimit, kNoLimit, kNoLimit}};

// METHOD §6: a limit relative to the scene's origin, as means are, rounded once.
inline float local_limit(double limit, double origin) {
  const double local = limit - origin;
  if (std::fabs(local) <= double{std::numeric_limits<float>::max()})
    return static_cast<float>(local);
  return local < 0 ? -std::numeric_limits<float>::infinity()
                   : std::numeric_limits<float>::infinity();
}

// box: in the scene's axes, its origin included. The result is scene-local, metres.
inline ClipBox<float> local_clip(const ClipBox<double>& box, const Vec3d& origin) {
  ClipBox<float> local;
  for (int i = 0; i < 3; ++i) {
    local.least[i] = local_limit(box.least[i], origin[i]);
    local.greatest[i] = local_limit(box.greatest[i], origin[i]);
  }
  return local;
}

// mean: scene-local, as it is drawn. The boundary is inside.
VOYAGER_HD bool is_inside(const ClipBox<float>& box, const Vec3f& mean) {
  return mean.x >= box.least.x && mean.x <= box.greatest.x && mean.y >= box.least.y &&
         mean.y <= box.greatest.y && mean.z >= box.least.z && mean.z <= box.greatest.z;
}

}  // namespace voyager
