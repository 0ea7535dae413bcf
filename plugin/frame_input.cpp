#include "plugin/frame_input.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "plugin/frustum.h"
#include "plugin/structs.h"
#include "runtime/frame/eye_camera.h"

namespace voyager {
namespace {

// Of an instance: depths in coordinates of METHOD §3 stay finite in binary32.
constexpr double kMinInstanceScale = 1e-9, kMaxInstanceScale = 1e9;

Vec3d checked_position(const double (&p)[3], const FieldName& field) {
  for (const double x : p) check_coordinate(x, field + ".position");
  return {p[0], p[1], p[2]};
}

// (x, y, z, w) of any length, to the runtime's unit (w, x, y, z).
Quatd checked_orientation(const double (&q)[4], const FieldName& field) {
  double largest = 0;
  for (const double x : q) {
    if (!std::isfinite(x)) refuse_number(field + ".orientation", x, "a finite number");
    largest = std::max(largest, std::fabs(x));
  }
  if (largest == 0) refuse(field.str() + ".orientation: found zero, expected a rotation");
  return normalise(Quatd{q[3] / largest, q[0] / largest, q[1] / largest, q[2] / largest});
}

bool is_identity(const InstancePose& pose) {
  const InstancePose identity;
  bool same = pose.scale == identity.scale;
  for (int i = 0; i < 3; ++i) {
    same = same && pose.position[i] == identity.position[i];
    for (int k = 0; k < 3; ++k)
      same = same && pose.rotation.row[i][k] == identity.rotation.row[i][k];
  }
  return same;
}

}  // namespace

InstancePose instance_pose(const VoyPose& pose, double scale, const FieldName& field) {
  if (!(scale >= kMinInstanceScale && scale <= kMaxInstanceScale))
    refuse_number(field + ".scale", scale, "1e-9 to 1e9");
  return {rotation(checked_orientation(pose.orientation, field + ".pose")),
          checked_position(pose.position, field + ".pose"), scale};
}

std::vector<InstancePose> without_identities(std::vector<InstancePose> poses) {
  if (std::all_of(poses.begin(), poses.end(), is_identity)) poses.clear();
  return poses;
}

std::vector<InstancePose> frame_poses(const VoyInstancePose* instances, size_t count) {
  std::vector<InstancePose> poses;
  for (size_t i = 0; i < count; ++i) {
    const FieldName field("frame.instances", i);
    check_structure(&instances[i], VOY_STRUCTURE_TYPE_INSTANCE_POSE, field);
    poses.push_back(instance_pose(instances[i].pose, instances[i].scale, field));
  }
  return without_identities(std::move(poses));
}

FrameInput frame_input(const VoyFrame& frame) {
  FrameInput input;
  if (!(frame.nearZ > 0) || !std::isfinite(frame.nearZ))
    refuse_number("frame.nearZ", frame.nearZ, "a finite number of metres, > 0");
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(frame.background[i]))
      refuse_number(FieldName("frame.background", static_cast<size_t>(i)),
                    static_cast<double>(frame.background[i]), "a finite number");
    input.background[i] = frame.background[i];
  }
  check_count(frame.reserved, 0, 0, "frame.reserved");
  input.eyes.clear();
  return input;
}

EyeView eye_view(const VoyPose& pose, const FieldName& pose_field, const VoyFrustum& frustum,
                 const FieldName& frustum_field) {
  check_frustum(frustum, frustum_field);
  return {world_to_view(checked_orientation(pose.orientation, pose_field)),
          checked_position(pose.position, pose_field),
          frustum.left,
          frustum.right,
          frustum.up,
          frustum.down};
}

FrameEye frame_eye(const VoyFrame& frame, const VoyFrameEye& eye, const Image& image,
                   const FieldName& field) {
  check_count(eye.reserved, 0, 0, field + ".reserved");
  FrameEye out;
  out.image = image;
  out.depth_wanted = image.depth != nullptr;
  Camera& camera = out.camera;
  camera.eye = checked_position(eye.pose.position, field + ".pose");
  camera.world_to_view = world_to_view(checked_orientation(eye.pose.orientation, field + ".pose"));
  const VoyFrustum& f = eye.frustum;
  check_frustum(f, field + ".frustum");
  camera.width = image.width;
  camera.height = image.height;
  set_frustum(camera, f.left, f.right, f.up, f.down);
  camera.near_z = frame.nearZ;
  return out;
}

}  // namespace voyager
