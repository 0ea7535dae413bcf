#pragma once
// Where the player stands in the scene: the start, and where the thumbsticks went from there.
#include <vector>

#include "camera.h"
#include "pose.h"

namespace host {

// What the controllers ask for, at one time.
struct Steering {
  double right = 0, forward = 0;  // -1 to 1: walk, as the head faces
  double up = 0;                  // -1 to 1
  double turn = 0;                // -1 (left) to 1
  bool recentre = false;
};

class Traveller {
 public:
  // At the first camera, upright.
  explicit Traveller(const std::vector<Camera>& cameras);
  // In the frame of scene_from_upright.
  explicit Traveller(const Pose& upright);

  // The scene's world from OpenXR's LOCAL space.
  Pose world_from_local() const { return world_from_upright_ * place_ * centre_; }
  // The start itself, as the camera looks: for --fixed-pose.
  const Pose& start() const { return start_; }

  // head: in LOCAL space. One metre is one of the scene's.
  void steer(const Steering& steering, const Pose& head, double seconds);
  // LOCAL space has been recentred by the runtime: what the button did is void.
  void recentred() { centre_ = {}; }

 private:
  void stand(const Pose& upright);
  void walk(const Steering& steering, double heading, double seconds);
  void turn(const Steering& steering, const Pose& head);

  Pose world_from_upright_;  // from a frame with y up, as OpenXR's spaces have it
  Pose start_;
  Pose place_;   // of the player's origin in the upright frame: level
  Pose centre_;  // of LOCAL space in the player's: level
  bool turning_ = false, recentring_ = false;
};

}  // namespace host
