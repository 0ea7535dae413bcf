#pragma once
// Where things are, in double: a city may lie far from the origin. OpenXR's axes (x right, y up,
// -z forward), metres.
#include <voyager/voyager.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "xr.h"

namespace host {

struct Pose {
  glm::dvec3 position = {0, 0, 0};
  glm::dquat orientation = {1, 0, 0, 0};  // w, x, y, z
};

// b, which is given in the frame of a, in the frame that a is given in.
inline Pose operator*(const Pose& a, const Pose& b) {
  return {a.position + a.orientation * b.position, glm::normalize(a.orientation * b.orientation)};
}

inline Pose inverse(const Pose& a) {
  const glm::dquat back = glm::conjugate(a.orientation);
  return {back * -a.position, back};
}

inline Pose turned(double yaw) {  // to the left, radians
  return {{0, 0, 0}, glm::angleAxis(yaw, glm::dvec3(0, 1, 0))};
}

// The heading alone: as the eyes' axis would lie were the head upright.
inline double yaw(const Pose& a) {
  const glm::dvec3 right = a.orientation * glm::dvec3(1, 0, 0);
  return std::atan2(-right.z, right.x);
}

inline Pose from_xr(const XrPosef& p) {
  return {{p.position.x, p.position.y, p.position.z},
          glm::normalize(
              glm::dquat(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z))};
}

inline XrVector3f to_xr(const glm::dvec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

inline Pose from_voyager(const VoyPose& p) {
  return {{p.position[0], p.position[1], p.position[2]},
          {p.orientation[3], p.orientation[0], p.orientation[1], p.orientation[2]}};
}

inline VoyPose to_voyager(const Pose& p) {
  const glm::dquat& q = p.orientation;
  return {{p.position.x, p.position.y, p.position.z}, {q.x, q.y, q.z, q.w}};
}

// Between two eyes, the head.
inline Pose middle(const Pose& a, const Pose& b) {
  return {(a.position + b.position) / 2.0, glm::slerp(a.orientation, b.orientation, 0.5)};
}

}  // namespace host
