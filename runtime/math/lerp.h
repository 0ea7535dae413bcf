#pragma once
// METHOD §4: how much of a cut node is itself and how much its parent, and the
// interpolated Gaussian. T is float in the backends, double in the reference.
#include <cmath>

#include "runtime/math/exact.h"
#include "runtime/math/gaussian.h"

namespace voyager {

// Whether a child of a node of that size is drawn as itself, whatever its own size. share: β, of
// the parent's size, where blending starts; in [0.5, 1).
template <class T>
VOYAGER_HD bool is_drawn_whole(T parent_size, T target, T share) {
  return share * parent_size > target;
}

// t in [0, 1]; 1 is the node itself. Root: pass has_parent = false.
template <class T>
VOYAGER_HD T interpolation_weight(bool has_parent, T parent_size, T size, T target, T share) {
  if (!has_parent || is_drawn_whole(parent_size, target, share)) return T(1);
  const T least = share * parent_size;
  const T start = least > size ? least : size;
  if (parent_size <= start) return T(1);
  const T over = target - start > T(0) ? target - start : T(0);
  const T t = T(1) - over / (parent_size - start);
  return t > T(0) ? t : T(0);
}

template <class T>
VOYAGER_HD T lerp(T parent, T node, T t) {
  return parent + t * (node - parent);
}

// Of values that are not negative. A node's thin axis may be 1e-8 of its parent's: as t → 1,
// parent + t·(node − parent) leaves nothing of it, and two products lose 3 ε (docs/numerics.md).
template <class T>
VOYAGER_HD T lerp_positive(T parent, T node, T t) {
  return (T(1) - t) * parent + t * node;
}
template <class T>
VOYAGER_HD Vec3<T> lerp_positive(const Vec3<T>& parent, const Vec3<T>& node, T t) {
  return {lerp_positive(parent.x, node.x, t), lerp_positive(parent.y, node.y, t),
          lerp_positive(parent.z, node.z, t)};
}

// The mean orders splats (METHOD §6), so each operation is rounded by itself.
VOYAGER_HD float lerp_rn(float parent, float node, float t) {
  return add_rn(parent, multiply_rn(t, subtract_rn(node, parent)));
}
VOYAGER_HD Vec3f lerp_rn(const Vec3f& parent, const Vec3f& node, float t) {
  return {lerp_rn(parent.x, node.x, t), lerp_rn(parent.y, node.y, t), lerp_rn(parent.z, node.z, t)};
}

// The parent's sign is flipped where the quaternions point apart.
template <class T>
VOYAGER_HD Quat<T> lerp(const Quat<T>& parent, const Quat<T>& node, T t) {
  const T d = ((parent.w * node.w + parent.x * node.x) + parent.y * node.y) + parent.z * node.z;
  const T sign = d < T(0) ? T(-1) : T(1);
  return normalise(Quat<T>{lerp(sign * parent.w, node.w, t), lerp(sign * parent.x, node.x, t),
                           lerp(sign * parent.y, node.y, t), lerp(sign * parent.z, node.z, t)});
}

}  // namespace voyager
