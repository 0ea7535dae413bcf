#pragma once
// Views of several instances, and scenes to be their parts.
#include <span>

#include "tests/support/render_scene.h"

namespace voyager::test {

// p + s·R·x with R turning by `degrees` about an axis that is no view's.
inline InstancePose pose_of(const Vec3d& position, double degrees = 0, double scale = 1) {
  const double half = degrees * 3.14159265358979323846 / 360, s = std::sin(half);
  const Quatd q = normalise(Quatd{std::cos(half), 0.6 * s, -0.48 * s, 0.64 * s});
  return {rotation(q), position, scale};
}

inline Vec3d to_world(const InstancePose& pose, const Vec3d& x) {
  return pose.position + pose.scale * (pose.rotation * x);
}

// What a camera sees of a scene at the identity, another sees of the posed scene: the frame of
// that other one, with the pose. (frame/instance.h goes the other way.)
inline FrameInput seen_posed(const FrameInput& input, const InstancePose& pose) {
  FrameInput moved = input;
  moved.eyes[0].camera.eye = to_world(pose, input.eyes[0].camera.eye);
  for (Vec3d& axis : moved.eyes[0].camera.world_to_view.row) axis = pose.rotation * axis;
  moved.eyes[0].camera.near_z = pose.scale * input.eyes[0].camera.near_z;
  moved.instances = {pose};
  return moved;
}

// Gaussians [first, last) of a cloud, by themselves.
inline GaussianCloud part_of(const GaussianCloud& cloud, size_t first, size_t last) {
  GaussianCloud part;
  part.sh_degree = cloud.sh_degree;
  part.origin = cloud.origin;
  part.native = cloud.native;
  const auto copy = [&](const auto& from, auto& into) {
    const auto each = static_cast<std::ptrdiff_t>(from.size() / cloud.size());
    into.assign(from.begin() + each * static_cast<std::ptrdiff_t>(first),
                from.begin() + each * static_cast<std::ptrdiff_t>(last));
  };
  copy(cloud.position, part.position);
  copy(cloud.log_scale, part.log_scale);
  copy(cloud.rotation, part.rotation);
  copy(cloud.opacity, part.opacity);
  copy(cloud.sh, part.sh);
  return part;
}

// Two clouds side by side, so far apart that a tree's root keeps them apart.
inline GaussianCloud two_clusters(size_t each, int sh_degree) {
  GaussianCloud cloud = random_cloud(2 * each, 21, sh_degree);
  for (size_t i = 0; i < cloud.size(); ++i) cloud.position[3 * i] += i < each ? -15.0f : 15.0f;
  return cloud;
}

// By a view that has drawn nothing before.
inline Frame render(Backend& backend, const Scenes& scenes, const PipelineDesc& desc,
                    const FrameInput& input) {
  Workers workers;
  View view(scenes, backend, desc, std::pmr::get_default_resource(), workers);
  return render(view, input);
}

inline std::vector<uint32_t> cut_of(View& view, size_t instance) {
  return {view.cut(instance).begin(), view.cut(instance).end()};
}

}  // namespace voyager::test
