#pragma once
// Who looks at a scene, as residency sees it: which chunks that takes, and how much.
#include <algorithm>
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

// The margin. Wedges are wider than what an eye sees by so many τ* (tangents) on each side: what is
// drawn is blurred by 1.8 pixels (METHOD §5), and τ* is one pixel or more. And what hangs from
// nodes in a box of longest side L is taken to reach L beyond it: a leaf is drawn to 3.33 σ where
// its box has 3, a merged Gaussian over a uniform patch (σ = 0.29 L) to 0.46 L beyond. The extent
// says nothing of that: it is an error (docs/lod-tree.md), between 0.006 and thousands of L.
// A footprint widens what is drawn and no box: √(s² + v) ≤ s + √v, and 4 of its standard deviations
// are what a splat reaches whose opacity is 11.
inline constexpr float kWedgeMargin = 10.0f;
inline constexpr float kHullReach = 1.0f;
inline constexpr float kFootprintReach = 4.0f;

// One camera, or two eyes that share a cut, in a scene's coordinates.
struct Viewer {
  CutQuery query;
  std::vector<Wedge> eyes;
  bool ahead = false;  // where it will be, by its way so far
  // The standard deviation of the scene's largest footprint (METHOD §12), metres.
  float footprint = 0;
  std::vector<Wedge> turned = {};  // what the eyes see if the head turns

  bool operator==(const Viewer&) const = default;

  bool sees(const EntryHull& hull) const { return meets(eyes, hull); }
  bool sees_turned(const EntryHull& hull) const { return meets(turned, hull); }

 private:
  bool meets(const std::vector<Wedge>& wedges, const EntryHull& hull) const {
    if (!std::isfinite(hull.extent)) return true;
    const Vec3f side = hull.box_max - hull.box_min;
    const float reach =
        kHullReach * std::max({side.x, side.y, side.z}) + kFootprintReach * footprint;
    for (const Wedge& wedge : wedges)
      if (wedge.meets(hull.box_min, hull.box_max, reach)) return true;
    return false;
  }
};

}  // namespace voyager
