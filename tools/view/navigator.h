#pragma once
// How a person moves through a scene: around a point, through the air, or on one level.
#include "fly_camera.h"
#include "tools/cameras.h"

namespace voyager::view {

enum class Navigation { orbit, fly, walk };

inline constexpr double kWalkingSpeed = 1.4;  // metres a second

// A window's camera: as high as the tangent says, as wide as the window is.
host::Camera window_camera(const VoyPose& pose, double tan_half_height, uint32_t width,
                           uint32_t height);
// Of a camera of a file.
double tan_half_height(const tools::Camera& camera);

class Navigator {
 public:
  // distance: metres to the point that orbit turns around, straight ahead.
  void look_from(const tools::Camera& camera, double distance);
  Navigation mode() const { return mode_; }
  void set_mode(Navigation mode);  // walking begins at a person's speed

  void turn(const glm::dvec2& radians);               // to the left, up; orbit: around the point
  void move(const glm::dvec3& axes, double seconds);  // right, up, back: 1 is full speed
  void pan(const glm::dvec2& radians);                // to the right, up, with orbit's point
  void zoom(double steps);  // orbit: a tenth nearer a step; else: a fifth faster

  double speed() const { return speed_; }  // metres a second
  void set_speed(double speed) { speed_ = speed; }
  double distance() const { return distance_; }
  const glm::dvec3& position() const { return camera_.position(); }
  host::Camera camera(uint32_t width, uint32_t height) const;

 private:
  host::FlyCamera camera_{VoyPose{{0, 0, 0}, {1, 0, 0, 0}}, 1};
  Navigation mode_ = Navigation::orbit;
  double speed_ = 1, distance_ = 1;
  double tan_half_height_ = 0.5;
};

}  // namespace voyager::view
