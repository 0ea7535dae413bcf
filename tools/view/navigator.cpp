#include "tools/view/navigator.h"

#include <algorithm>
#include <cmath>

namespace voyager::view {
namespace {

constexpr glm::dvec3 kForward = {0, 0, -1};
constexpr double kNearest = 0.05, kFarthest = 1e6;  // metres to the point that orbit turns around

}  // namespace

host::Camera window_camera(const VoyPose& pose, double tan_half_height, uint32_t width,
                           uint32_t height) {
  const double up = tan_half_height, right = up * width / height;
  return {pose, {-right, right, up, -up}, width, height};
}

double tan_half_height(const tools::Camera& camera) {
  const VoyFrustum frustum = camera.frustum();
  return (frustum.up - frustum.down) / 2;
}

void Navigator::look_from(const tools::Camera& camera, double distance) {
  camera_.look_from(camera.pose);
  tan_half_height_ = tan_half_height(camera);
  distance_ = std::clamp(distance, kNearest, kFarthest);
}

void Navigator::set_mode(Navigation mode) {
  if (mode == Navigation::walk && mode_ != mode) speed_ = kWalkingSpeed;
  mode_ = mode;
}

void Navigator::turn(const glm::dvec2& radians) {
  const glm::dvec3 around = camera_.position() + distance_ * camera_.direction(kForward);
  camera_.turn(radians);
  if (mode_ == Navigation::orbit) camera_.place(around - distance_ * camera_.direction(kForward));
}

void Navigator::move(const glm::dvec3& axes, double seconds) {
  const glm::dvec3 along =
      mode_ == Navigation::walk ? camera_.level_direction(axes) : camera_.direction(axes);
  camera_.place(camera_.position() + along * (speed_ * seconds));
}

void Navigator::pan(const glm::dvec2& radians) {
  camera_.place(camera_.position() + distance_ * camera_.direction({radians.x, radians.y, 0}));
}

void Navigator::zoom(double steps) {
  if (mode_ != Navigation::orbit) {
    speed_ = std::clamp(speed_ * std::pow(1.2, steps), 1e-3, 1e5);
    return;
  }
  const double nearer = std::clamp(distance_ * std::pow(0.9, steps), kNearest, kFarthest);
  camera_.place(camera_.position() + (distance_ - nearer) * camera_.direction(kForward));
  distance_ = nearer;
}

host::Camera Navigator::camera(uint32_t width, uint32_t height) const {
  return window_camera(camera_.pose(), tan_half_height_, width, height);
}

}  // namespace voyager::view
