#pragma once
// A camera that a player flies, upright in the scene.
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera.h"

namespace host {

// Half a turn about x: from OpenXR's and glTF's axes to a scene's (docs/conventions.md).
glm::dmat4 scene_from_upright();

class FlyCamera {
 public:
  FlyCamera(const VoyPose& start, double metres_a_second);

  void look_from(const VoyPose& pose);                // its roll is left out
  void turn(const glm::dvec2& radians);               // to the left, up
  void move(const glm::dvec3& axes, double seconds);  // right, up, back: 1 is full speed
  void change_speed(double factor) { speed_ *= factor; }
  double speed() const { return speed_; }

  const glm::dvec3& position() const { return position_; }
  void place(const glm::dvec3& position);
  // The scene's direction of one in the camera's axes (right, up, back); level: as if it did not
  // look up or down.
  glm::dvec3 direction(const glm::dvec3& axes) const;
  glm::dvec3 level_direction(const glm::dvec3& axes) const;
  VoyPose pose() const;
  // 60 degrees high.
  Camera camera(uint32_t width, uint32_t height) const;

 private:
  glm::dvec3 position_ = {};
  double yaw_ = 0, pitch_ = 0, speed_;
};

}  // namespace host
