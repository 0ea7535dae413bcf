#pragma once
// A Gaussian as it is drawn, and the one place where stored words become it
// (METHOD §1): s = exp(log s), o = sigmoid(logit o) for a leaf, o itself for a
// merged Gaussian (which may exceed 1), q normalised.
#include <cmath>

#include "runtime/math/vec.h"

namespace voyager {

struct Gaussian {
  Vec3f mean;         // metres, scene-local
  float opacity;      // [0, 1]; a merged one may exceed 1
  Vec3f scale;        // metres, linear, > 0
  float log_opacity;  // natural logarithm of opacity; -inf at 0
  Quatf rotation;     // unit
};

struct GaussianWords {
  Vec3f mean;       // metres, scene-local
  Vec3f log_scale;  // natural logarithm of metres
  Quatf rotation;   // any length
  float opacity;    // leaf: logit; merged: linear
};

inline constexpr float kMaxLogit = 88.0f;  // sigmoid is 1 to the last bit, and exp(88) is finite
VOYAGER_HD float sigmoid(float x) {
  return 1.0f / (1.0f + std::exp(-x));
}
VOYAGER_HD float logit(float p) {
  return std::log(p / (1.0f - p));
}

// Of a Gaussian in a flat scene. A merged one's opacity may exceed 1: it becomes the largest logit
// whose opacity binary32 tells from 1.
VOYAGER_HD float flat_logit(float opacity) {
  const float most = 1.0f - 0x1p-24f;
  const float x = logit(opacity < most ? opacity : most);
  return x < -kMaxLogit ? -kMaxLogit : x;
}

VOYAGER_HD Gaussian activate(const GaussianWords& words, bool leaf) {
  Gaussian g;
  g.mean = words.mean;
  g.scale = {std::exp(words.log_scale.x), std::exp(words.log_scale.y), std::exp(words.log_scale.z)};
  g.rotation = normalise(words.rotation);
  g.opacity = leaf ? sigmoid(words.opacity) : words.opacity;
  g.log_opacity = std::log(g.opacity);
  return g;
}

// METHOD §2: the weight of a Gaussian in its parent is opacity times this
// (proportional to its surface, so to the pixels it covers).
template <class T>
VOYAGER_HD T surface(const Vec3<T>& s) {
  return (s.x * s.y + s.x * s.z) + s.y * s.z;
}

}  // namespace voyager
