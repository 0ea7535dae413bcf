#pragma once
// Poses in double. A pose takes its own space's coordinates to those of the space it is given in.
#include <Eigen/Geometry>

#include "api.h"

namespace test_runtime {

struct Pose {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // metres

  Pose inverse() const {
    const Eigen::Quaterniond back = orientation.conjugate();
    return {back, -(back * position)};
  }
};

inline Pose operator*(const Pose& outer, const Pose& inner) {
  return {(outer.orientation * inner.orientation).normalized(),
          outer.position + outer.orientation * inner.position};
}

inline Pose from_xr(const XrPosef& pose) {
  return {Eigen::Quaterniond(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                             pose.orientation.z)
              .normalized(),
          {pose.position.x, pose.position.y, pose.position.z}};
}

inline XrPosef to_xr(const Pose& pose) {
  const Eigen::Quaternionf q = pose.orientation.cast<float>();
  const Eigen::Vector3f p = pose.position.cast<float>();
  return {{q.x(), q.y(), q.z(), q.w()}, {p.x(), p.y(), p.z()}};
}

}  // namespace test_runtime
