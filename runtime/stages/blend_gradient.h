#pragma once
// The adjoint of blending (METHOD §4, §6): how a loss changes with a splat at one pixel. Splats
// come front to back a second time, when the finished pixel is known.
#include "runtime/math/alpha.h"
#include "runtime/stages/project_gradient.h"

namespace voyager {

// Of a loss: the squared error of the coverage, beside that of each colour. What is behind a scene
// is not always black.
inline constexpr float kCoverageWeight = 0.1f;

// A pixel in progress. `colour` and `transmittance` are those of the finished pixel, over black;
// by_colour and by_alpha how the loss changes with its colour and with 1 - transmittance.
template <class T>
struct PixelAdjoint {
  Vec3<T> by_colour{T(0), T(0), T(0)};
  T by_alpha = T(0);
  T behind = T(0);  // by_colour · (the colour of what is not yet blended)
  T end = T(0);     // by_alpha · the finished transmittance
  T transmittance = T(1);

  PixelAdjoint() = default;
  VOYAGER_HD PixelAdjoint(const Vec3<T>& finished, T finished_transmittance, const Vec3<T>& colour,
                          T alpha)
      : by_colour(colour),
        by_alpha(alpha),
        behind(dot(colour, finished)),
        end(alpha * finished_transmittance) {}
};

// How METHOD §4's correction changes with α.
template <class T>
VOYAGER_HD T sibling_alpha_slope(T alpha, T t, T inverse_k) {
  return t + (T(1) - t) * inverse_k * std::exp((inverse_k - T(1)) * std::log(T(1) - alpha));
}

// One splat at one pixel: what it adds to the splat's sums. False where the pixel takes no more.
// alpha: as blended, below 1; slope: how it changes with ln α of METHOD §6, 0 where α is cut off.
template <class T>
struct PixelShare {
  T weight;  // of the splat's colour
  T g;       // the change of the loss with ln α
};
template <class T>
VOYAGER_HD bool blend_adjoint(T alpha, T slope, const Vec3<T>& colour, PixelAdjoint<T>& pixel,
                              PixelShare<T>& share) {
  const T before = pixel.transmittance, after = before - alpha * before;
  if (after < T(kTransmittanceEnd)) return false;
  share.weight = alpha * before;
  const T own = dot(pixel.by_colour, colour);
  pixel.behind -= share.weight * own;
  pixel.transmittance = after;
  share.g = slope * (before * own - (pixel.behind - pixel.end) / (T(1) - alpha));
  return true;
}

}  // namespace voyager
