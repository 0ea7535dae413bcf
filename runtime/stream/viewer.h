#pragma once
// Who looks at a scene, as residency sees it: which chunks that takes, and how much.
#include <array>
#include <cmath>
#include <vector>

#include "runtime/lod/subtrees.h"
#include "runtime/select/cut.h"

namespace voyager {

// What an eye sees, from a point outwards: the side planes and that through the eye, with
// unit normals that point inwards. Scene-local.
struct Wedge {
  Vec3f eye;
  std::array<Vec3f, 5> normals;

  bool operator==(const Wedge&) const = default;

  // Whether a box comes within `reach` metres of it.
  bool meets(const Vec3f& least, const Vec3f& most, float reach) const {
    for (const Vec3f& n : normals) {
      float inside = reach;
      for (int axis = 0; axis < 3; ++axis)
        inside += n[axis] * ((n[axis] > 0 ? most[axis] : least[axis]) - eye[axis]);
      if (inside < 0) return false;
    }
    return true;
  }
};

// The margin. Wedges are wider than what an eye sees by so many τ* (tangents) on each side: a cut
// node is below 2 τ* in size, and none is drawn further than that from its mean. And what hangs
// from a node of extent E is taken to reach E beyond the node's box: a leaf is drawn to 3.33 σ
// where its box has 3, a merged Gaussian over a uniform patch (σ = 0.29 E) to 0.46 E beyond.
inline constexpr float kWedgeMargin = 10.0f;
inline constexpr float kHullReach = 1.0f;

// One camera, or two eyes that share a cut, in a scene's coordinates.
struct Viewer {
  CutQuery query;
  std::vector<Wedge> eyes;
  bool ahead = false;  // where it will be, by its way so far

  bool operator==(const Viewer&) const = default;

  bool sees(const EntryHull& hull) const {
    if (!std::isfinite(hull.extent)) return true;
    for (const Wedge& eye : eyes)
      if (eye.meets(hull.box_min, hull.box_max, kHullReach * hull.extent)) return true;
    return false;
  }
};

}  // namespace voyager
