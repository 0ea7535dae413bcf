#include "placement.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "fly_camera.h"

namespace host {
namespace {

glm::dvec3 low(const VoySceneInfo& s) {
  return {s.boundsMin[0], s.boundsMin[1], s.boundsMin[2]};
}
glm::dvec3 high(const VoySceneInfo& s) {
  return {s.boundsMax[0], s.boundsMax[1], s.boundsMax[2]};
}

}  // namespace

double diagonal(const VoySceneInfo& scene) {
  return glm::length(high(scene) - low(scene));
}

glm::dmat4 place_mesh(const VoySceneInfo& scene, const std::optional<MeshPlace>& place) {
  glm::dvec3 at = (low(scene) + high(scene)) / 2.0;
  const glm::dvec3 size = high(scene) - low(scene);
  double scale = 0.08 * std::max(std::min(size.x, size.z), 1e-3);
  if (place) {
    at = {place->position[0], place->position[1], place->position[2]};
    scale = place->scale;
  }
  return glm::scale(glm::translate(glm::dmat4(1), at) * scene_from_upright(), glm::dvec3(scale));
}

VoyPose overview(const VoySceneInfo& scene) {
  const double tilt = 0.5, distance = 0.4 * diagonal(scene);
  const glm::dvec3 centre = (low(scene) + high(scene)) / 2.0;
  const double half = (std::acos(-1.0) - tilt) / 2;
  return {{centre.x, centre.y - distance * std::sin(tilt), centre.z - distance * std::cos(tilt)},
          {std::sin(half), 0, 0, std::cos(half)}};
}

}  // namespace host
