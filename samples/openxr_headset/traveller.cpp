#include "traveller.h"

#include <algorithm>

#include "ground.h"

namespace host {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSpeed = 3, kClimb = 2;         // metres a second
constexpr double kSnap = kPi / 6;                // one flick of the stick turns so far
constexpr double kFlick = 0.7, kReleased = 0.4;  // of the stick's way
constexpr double kLongestStep = 0.1;             // seconds: a pause is no journey

// The axis of the scene that is up: the nearest to the cameras' own.
glm::dvec3 up_axis(const std::vector<Camera>& cameras) {
  glm::dvec3 sum(0);
  for (const Camera& camera : cameras)
    sum += glm::normalize(from_voyager(camera.pose).orientation) * glm::dvec3(0, 1, 0);
  glm::dvec3 best(0, -1, 0);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      glm::dvec3 candidate(0);
      candidate[axis] = sign;
      if (glm::dot(candidate, sum) > glm::dot(best, sum)) best = candidate;
    }
  return best;
}

Pose stand_up(const glm::dvec3& up) {
  const glm::dvec3 y(0, 1, 0);
  if (up == y) return {};
  if (up == -y) return scene_from_upright();
  return {{0, 0, 0}, glm::angleAxis(kPi / 2, glm::cross(y, up))};
}

}  // namespace

Traveller::Traveller(const std::vector<Camera>& cameras)
    : world_from_upright_(stand_up(up_axis(cameras))), start_(from_voyager(cameras.front().pose)) {
  stand(inverse(world_from_upright_) * start_);
}

Traveller::Traveller(const Pose& upright)
    : world_from_upright_(scene_from_upright()), start_(world_from_upright_ * upright) {
  stand(upright);
}

void Traveller::stand(const Pose& upright) {
  place_ = turned(yaw(upright));
  place_.position = upright.position;
}

void Traveller::steer(const Steering& steering, const Pose& head, double seconds) {
  walk(steering, yaw(place_ * centre_ * head), std::clamp(seconds, 0.0, kLongestStep));
  turn(steering, head);
  if (steering.recentre && !recentring_) {
    Pose level = turned(yaw(head));
    level.position = head.position;
    centre_ = inverse(level);
  }
  recentring_ = steering.recentre;
}

void Traveller::walk(const Steering& steering, double heading, double seconds) {
  const glm::dvec3 step(kSpeed * steering.right, kClimb * steering.up, -kSpeed * steering.forward);
  place_.position += turned(heading).orientation * step * seconds;
}

void Traveller::turn(const Steering& steering, const Pose& head) {
  const double asked = std::abs(steering.turn);
  if (asked > kFlick && !turning_) {
    // About the head, wherever in the room it is.
    const glm::dvec3 at = (place_ * centre_ * head).position;
    const Pose snap = turned(steering.turn > 0 ? -kSnap : kSnap);
    place_ = Pose{at, {1, 0, 0, 0}} * snap * Pose{-at, {1, 0, 0, 0}} * place_;
    turning_ = true;
  } else if (asked < kReleased) {
    turning_ = false;
  }
}

}  // namespace host
