#include "plugin/frame_input.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "plugin/frustum.h"
#include "plugin/structs.h"
#include "runtime/frame/eye_camera.h"

namespace voyager {
namespace {

// METHOD §3: below this, squared distances stay finite in binary32.
constexpr double kMaxCoordinate = 1e18;

Vec3d checked_position(const double (&p)[3], const std::string& field) {
  for (const double x : p)
    if (!(std::fabs(x) < kMaxCoordinate))
      refuse_number(field + ".position", x, "metres below 1e18 in magnitude");
  return {p[0], p[1], p[2]};
}

// (x, y, z, w) of any length, to the runtime's unit (w, x, y, z).
Quatd checked_orientation(const double (&q)[4], const std::string& field) {
  double largest = 0;
  for (const double x : q) {
    if (!std::isfinite(x)) refuse_number(field + ".orientation", x, "a finite number");
    largest = std::max(largest, std::fabs(x));
  }
  if (largest == 0) refuse(field + ".orientation: found zero, expected a rotation");
  return normalise(Quatd{q[3] / largest, q[0] / largest, q[1] / largest, q[2] / largest});
}

void check_instance(const VoyInstancePose* instance) {
  if (instance == nullptr) return;
  check_structure(instance, VOY_STRUCTURE_TYPE_INSTANCE_POSE, "frame.instances[0]");
  const Vec3d p = checked_position(instance->pose.position, "frame.instances[0].pose");
  const Quatd q = checked_orientation(instance->pose.orientation, "frame.instances[0].pose");
  if (!(instance->scale > 0) || !std::isfinite(instance->scale))
    refuse_number("frame.instances[0].scale", instance->scale, "a finite number, > 0");
  const bool identity =
      p.x == 0 && p.y == 0 && p.z == 0 && q.x == 0 && q.y == 0 && q.z == 0 && instance->scale == 1;
  if (!identity)
    throw ApiError(VOY_ERROR_UNSUPPORTED,
                   "frame.instances[0]: found a pose or scale that is not the identity, which is "
                   "the only one that this version draws");
}

}  // namespace

FrameInput frame_input(const VoyFrame& frame, const VoyFrameEye& eye, const Image& image) {
  FrameInput input;
  if (!(frame.nearZ > 0) || !std::isfinite(frame.nearZ))
    refuse_number("frame.nearZ", frame.nearZ, "a finite number of metres, > 0");
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(frame.background[i]))
      refuse_number("frame.background", static_cast<double>(frame.background[i]),
                    "a finite number");
    input.background[i] = frame.background[i];
  }
  check_count(frame.reserved, 0, 0, "frame.reserved");
  check_instance(frame.instances);
  check_count(eye.reserved, 0, 0, "frame.eyes[0].reserved");

  Camera& camera = input.camera;
  camera.eye = checked_position(eye.pose.position, "frame.eyes[0].pose");
  camera.world_to_view =
      world_to_view(checked_orientation(eye.pose.orientation, "frame.eyes[0].pose"));
  const VoyFrustum& f = eye.frustum;
  check_frustum(f, "frame.eyes[0].frustum");
  camera.width = image.width;
  camera.height = image.height;
  set_frustum(camera, f.left, f.right, f.up, f.down);
  camera.near_z = frame.nearZ;
  input.depth_wanted = image.depth != nullptr;
  return input;
}

}  // namespace voyager
