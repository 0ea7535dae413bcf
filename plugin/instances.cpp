#include "plugin/instances.h"

#include <cmath>

#include "plugin/claim.h"
#include "plugin/frame_input.h"
#include "plugin/structs.h"

using namespace voyager;

namespace {

// A host's list, checked and in the runtime's terms.
struct InstanceList {
  std::vector<std::shared_ptr<SceneObject>> scenes;
  std::vector<InstancePose> poses;
  std::vector<InstanceLook> looks;
};

ClipBox<double> clip_box(const VoyInstance& instance, const FieldName& field) {
  ClipBox<double> box;
  const auto check = [&](const char* limit, int axis, double found, bool right,
                         const char* expected) {
    if (!right)
      refuse_number((field + limit).str() + "[" + std::to_string(axis) + "]", found, expected);
  };
  for (int i = 0; i < 3; ++i) {
    const double least = instance.clipMin[i], greatest = instance.clipMax[i];
    check(".clipMin", i, least, !std::isnan(least), "a number or an infinity");
    check(".clipMax", i, greatest, greatest >= least, "a number >= clipMin");
    box.least[i] = least;
    box.greatest[i] = greatest;
  }
  return box;
}

InstanceLook look_of(const VoyInstance& instance, const FieldName& field) {
  if (!(instance.opacity >= 0 && instance.opacity <= 1))
    refuse_number(field + ".opacity", static_cast<double>(instance.opacity), "0 to 1");
  check_count(instance.reserved, 0, 0, field + ".reserved");
  return {instance.opacity, clip_box(instance, field)};
}

InstanceList checked_list(Call& call, uint32_t count, const VoyInstance* instances,
                          const DeviceObject& device) {
  InstanceList list;
  for (uint32_t i = 0; i < count; ++i) {
    const VoyInstance& instance = instances[i];
    const FieldName field("instances", i);
    check_structure(&instance, VOY_STRUCTURE_TYPE_INSTANCE, field);
    list.scenes.push_back(instance_scene(call, instance.scene, device, field + ".scene"));
    list.poses.push_back(instance_pose(instance.pose, instance.scale, field));
    list.looks.push_back(look_of(instance, field));
  }
  list.poses = without_identities(std::move(list.poses));
  return list;
}

}  // namespace

namespace voyager {

void check_instance_count(uint32_t count, const FieldName& field) {
  if (count > kMaxInstances)
    throw ApiError(VOY_ERROR_UNSUPPORTED, field.str() + ": found " + std::to_string(count) +
                                              ", this version draws up to " +
                                              std::to_string(kMaxInstances) +
                                              " instances in a view");
}

std::shared_ptr<SceneObject> instance_scene(Call& call, VoyScene scene, const DeviceObject& device,
                                            const FieldName& field) {
  auto object = call.use<SceneObject>(scene, field);
  if (object->parent().get() != &device)
    refuse(field.str() + ": found a scene of another device, expected one of this device");
  return object;
}

}  // namespace voyager

VoyResult VOY_CALL voySetViewInstances(VoyView view, uint32_t count, const VoyInstance* instances) {
  return guarded("voySetViewInstances", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    check_instance_count(count, "count");
    if (count > 0) check_pointer(instances, "instances");
    InstanceList list = checked_list(call, count, instances, object->device());
    const auto frame = claim_for_instances(*object);
    if (list.scenes != object->scenes) object->set_scenes(std::move(list.scenes));
    object->poses.swap(list.poses);
    object->looks.swap(list.looks);
    object->scene_lost = false;
    return VOY_SUCCESS;
  });
}
