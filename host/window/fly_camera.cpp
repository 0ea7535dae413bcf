#include "fly_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace host {
namespace {

constexpr double kSteepest = 1.55;  // radians, short of straight up

glm::dquat upright() {
  return glm::quat_cast(glm::dmat3(scene_from_upright()));
}

glm::dquat orientation(double yaw, double pitch) {
  return upright() * glm::angleAxis(yaw, glm::dvec3(0, 1, 0)) *
         glm::angleAxis(pitch, glm::dvec3(1, 0, 0));
}

}  // namespace

glm::dmat4 scene_from_upright() {
  glm::dmat4 m(1);
  m[1][1] = m[2][2] = -1;
  return m;
}

FlyCamera::FlyCamera(const VoyPose& start, double metres_a_second) : speed_(metres_a_second) {
  look_from(start);
}

void FlyCamera::look_from(const VoyPose& pose) {
  position_ = {pose.position[0], pose.position[1], pose.position[2]};
  const double* q = pose.orientation;
  const glm::dvec3 forward =
      glm::inverse(upright()) * glm::dquat(q[3], q[0], q[1], q[2]) * glm::dvec3(0, 0, -1);
  yaw_ = std::atan2(-forward.x, -forward.z);
  pitch_ = std::asin(std::clamp(forward.y, -1.0, 1.0));
}

void FlyCamera::turn(const glm::dvec2& radians) {
  yaw_ += radians.x;
  pitch_ = std::clamp(pitch_ + radians.y, -kSteepest, kSteepest);
}

void FlyCamera::move(const glm::dvec3& axes, double seconds) {
  position_ += orientation(yaw_, pitch_) * axes * (speed_ * seconds);
}

void FlyCamera::place(const glm::dvec3& position) {
  position_ = position;
}

glm::dvec3 FlyCamera::direction(const glm::dvec3& axes) const {
  return orientation(yaw_, pitch_) * axes;
}

glm::dvec3 FlyCamera::level_direction(const glm::dvec3& axes) const {
  return orientation(yaw_, 0) * axes;
}

VoyPose FlyCamera::pose() const {
  const glm::dquat q = orientation(yaw_, pitch_);
  return {{position_.x, position_.y, position_.z}, {q.x, q.y, q.z, q.w}};
}

Camera FlyCamera::camera(uint32_t width, uint32_t height) const {
  const double up = std::tan(std::acos(-1.0) / 6);
  const double right = up * width / height;
  return {pose(), {-right, right, up, -up}, width, height};
}

}  // namespace host
