#pragma once
// How a merged Gaussian moves by the gradient of what was drawn of it (node_trainer.h): Adam
// (Kingma and Ba, 2015), with steps that follow the Gaussian's own size.
#include <cmath>

#include "runtime/stages/project_gradient.h"

namespace voyager {

// By number of a row: mean, scale, rotation, log opacity; coefficients [k][rgb] follow.
inline constexpr int kShapeNumbers = 11;
VOYAGER_HD constexpr int numbers_of(int sh_degree) {
  return kShapeNumbers + 3 * sh_coefficients(sh_degree);
}

// How far one step of Adam moves each number, in the units of what it moves, while `pace` is 1.
struct LearningRates {
  float mean = 0;  // in the Gaussian's largest scale
  float log_scale = 0, rotation = 0, log_opacity = 0;
  float colour = 0;  // code values, of the constant term
  float shine = 0;   // code values, of the others
  float pace = 0;

  VOYAGER_HD float of_shape(int i, float largest_scale) const {
    return i < 3 ? mean * largest_scale : i < 6 ? log_scale : i < 10 ? rotation : log_opacity;
  }
  // Of coefficient number k of a row, [k][rgb].
  VOYAGER_HD float of_coefficient(int k) const {
    return (k < 3 ? colour : shine) / static_cast<float>(kSh0);
  }
};

// By number, of a stored Gaussian: scales by their logarithms, the rotation at the unit quaternion.
struct ShapeGradient {
  float by[kShapeNumbers] = {};
};

// What a drawn Gaussian's gradient says of one that it was interpolated from (METHOD §4). share: of
// that one in what was drawn; sign: of its rotation there; drawn_opacity: what was drawn.
VOYAGER_HD void add_share(const float* drawn, float share, float sign, float drawn_opacity,
                          const Gaussian& of, ShapeGradient& sum) {
  for (int i = 0; i < 3; ++i) {
    sum.by[i] += share * drawn[i];
    sum.by[3 + i] += share * drawn[3 + i] * of.scale[i];
  }
  for (int i = 6; i < 10; ++i) sum.by[i] += share * sign * drawn[i];
  sum.by[10] += share * drawn[10] * of.opacity / drawn_opacity;
}

// The sign with which a parent's rotation is blended into its child's.
template <class Arrays>
VOYAGER_HD float parent_sign(const Arrays& arrays, const DrawItem& item) {
  if (item.t == 1.0f) return 1.0f;
  Quatf own = arrays.gaussian(item.gaussian).rotation;
  const int code = axis_code_of(arrays.node_code(item.gaussian));
  if (code != 0) own = own * cube_rotation<float>(code);
  const Quatf parent = arrays.gaussian(item.parent).rotation;
  const float d = ((parent.w * own.w + parent.x * own.x) + parent.y * own.y) + parent.z * own.z;
  return d < 0.0f ? -1.0f : 1.0f;
}

// Of a row that has moved number - 1 times before. Gradients are taken by what the loss changes in
// one step, so that kNegligible has the loss's unit: what changes less hardly moves, where plain
// Adam would move it as far as anything.
struct AdamStep {
  static constexpr float kFirstDecay = 0.9f, kSecondDecay = 0.99f, kNegligible = 0.01f;
  static constexpr float kWarmSteps = 8;  // in which a row comes up to its pace

  uint32_t number;
  float first, second;  // what makes up for moments that begin at zero
  float pace;

  VOYAGER_HD AdamStep(const LearningRates& rates, uint32_t n) : number(n) {
    const auto steps = static_cast<float>(n);
    first = 1.0f / (1.0f - std::pow(kFirstDecay, steps));
    second = 1.0f / (1.0f - std::pow(kSecondDecay, steps));
    pace = rates.pace * (steps < kWarmSteps ? steps / kWarmSteps : 1.0f);
  }

  // How far a number moves down; the moments are its own.
  VOYAGER_HD float move(float gradient, float rate, float& first_moment,
                        float& second_moment) const {
    const float change = rate * gradient;
    first_moment = kFirstDecay * first_moment + (1.0f - kFirstDecay) * change;
    second_moment = kSecondDecay * second_moment + (1.0f - kSecondDecay) * change * change;
    return pace * rate * first_moment * first / (std::sqrt(second_moment * second) + kNegligible);
  }
};

namespace detail {
VOYAGER_HD float clamped(float x, float low, float high) {
  return x < low ? low : (x > high ? high : x);
}
}  // namespace detail

// moves: by number, down. Scales stay within what importers take (runtime/scene/sanitise.h) and
// opacities between e^-6, which is fainter than α*, and e².
VOYAGER_HD void move_shape(const float* moves, Gaussian& g) {
  for (int i = 0; i < 3; ++i) {
    g.mean[i] -= moves[i];
    g.scale[i] = detail::clamped(g.scale[i] * std::exp(-moves[3 + i]), 1e-6f, 1e6f);
  }
  g.rotation = normalise(Quatf{g.rotation.w - moves[6], g.rotation.x - moves[7],
                               g.rotation.y - moves[8], g.rotation.z - moves[9]});
  g.log_opacity = detail::clamped(g.log_opacity - moves[10], -6.0f, 2.0f);
  g.opacity = std::exp(g.log_opacity);
}

}  // namespace voyager
