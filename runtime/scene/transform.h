#pragma once
// A scene that is moved, turned, scaled or mirrored.
#include <array>
#include <string>

#include "runtime/math/affine.h"
#include "runtime/math/sh_rotation.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

inline constexpr double kMostScale = 1e9;  // of a transform, and the least is one over it

// Of INRIA axes. Const and safe from several threads.
class CloudTransform {
 public:
  // Throws Error(refused_input) naming `what` unless all numbers are finite, the offset is within
  // kMaxCoordinate, and no length grows or shrinks by more than kMostScale.
  CloudTransform(const Affine& affine, const std::string& what);

  // Rotations, mirrors and uniform scales map Gaussians exactly. Any other transform M maps the
  // covariance Σ to M Σ Mᵀ exactly, and rotates SH by the rotation that is nearest to M. Words that
  // are not finite stay so. The result is relative to `origin`; the native pixel is scaled by the
  // cube root of the change of volume.
  void apply(GaussianCloud& cloud, const std::array<double, 3>& origin) const;

  NativeScale of(NativeScale native) const;

 private:
  void move(GaussianCloud& cloud, const std::array<double, 3>& origin) const;
  void turn(GaussianCloud& cloud) const;
  void reshape(GaussianCloud& cloud) const;

  Affine affine_;
  bool similar_ = true;
  double scale_ = 1;  // the cube root of the change of volume
  Quatd rotation_{1, 0, 0, 0};
  ShRotation sh_{};
};

// The origin that a scene near a place has: per axis 0 within kOriginReach, else the nearest
// multiple of kOriginStep.
std::array<double, 3> origin_near(const Vec3d& place);

}  // namespace voyager
