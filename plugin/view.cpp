#include <algorithm>

#include "plugin/call.h"
#include "plugin/claim.h"
#include "plugin/experiment.h"
#include "plugin/instances.h"
#include "plugin/structs.h"
#include "plugin/time_budget.h"

using namespace voyager;

namespace {

// Counts come first: the arrays of a count that is refused are never read.
void check_counts(const VoyViewDesc& desc) {
  check_instance_count(desc.instanceCount, "desc.instanceCount");
  check_count(desc.eyeCount, 1, UINT32_MAX, "desc.eyeCount");
  if (desc.eyeCount > kMaxEyes)
    throw ApiError(VOY_ERROR_UNSUPPORTED, "desc.eyeCount: found " + std::to_string(desc.eyeCount) +
                                              ", this version draws up to " +
                                              std::to_string(kMaxEyes) + " eyes in a view");
  if (desc.instanceCount > 0) check_pointer(desc.scenes, "desc.scenes");
  check_count(desc.maxWidth, 1, kMaxImageSide, "desc.maxWidth");
  check_count(desc.maxHeight, 1, kMaxImageSide, "desc.maxHeight");
}

PipelineDesc checked_choices(const VoyViewDesc& desc, const VoyExperiment* experiment,
                             VoyBackend backend) {
  check_tau(desc.tau, "desc.tau");
  check_enum(desc.lod, VOY_LOD_ALL_LEAVES, "desc.lod");
  check_enum(desc.antialias, VOY_ANTIALIAS_OFF, "desc.antialias");
  check_count(desc.reserved, 0, 0, "desc.reserved");
  PipelineDesc choices;
  choices.eyes = desc.eyeCount;
  choices.lod = desc.lod == VOY_LOD_ALL_LEAVES ? Lod::all_leaves : Lod::cut;
  choices.antialias = desc.antialias == VOY_ANTIALIAS_OFF ? Antialias::off : Antialias::on;
  apply_experiment(experiment, backend, choices);
  return choices;
}

void check_instance(uint32_t instance, size_t count) {
  if (count == 0) refuse("instance: found a view without instances, expected one that has some");
  check_count(instance, 0, count - 1, "instance");
}

std::vector<std::shared_ptr<SceneObject>> checked_scenes(Call& call, const VoyViewDesc& desc,
                                                         const DeviceObject& owner) {
  std::vector<std::shared_ptr<SceneObject>> scenes;
  for (uint32_t i = 0; i < desc.instanceCount; ++i)
    scenes.push_back(instance_scene(call, desc.scenes[i], owner, {"desc.scenes", i}));
  return scenes;
}

}  // namespace

VoyResult VOY_CALL voyCreateView(VoyDevice device, const VoyViewDesc* desc, VoyView* view) {
  return guarded("voyCreateView", [&](Call& call) {
    const auto owner = call.use<DeviceObject>(device);
    const VoyTimeBudget* budget = nullptr;
    const VoyExperiment* experiment = nullptr;
    check_structure(desc, VOY_STRUCTURE_TYPE_VIEW_DESC, "VoyViewDesc",
                    Extension{VOY_STRUCTURE_TYPE_TIME_BUDGET, budget},
                    Extension{VOY_STRUCTURE_TYPE_EXPERIMENT, experiment});
    check_pointer(view, "view");
    check_counts(*desc);
    const PipelineDesc choices = checked_choices(*desc, experiment, owner->backend_kind);
    if (budget != nullptr) check_time_budget(*budget);
    const auto object =
        std::make_shared<ViewObject>(owner, checked_scenes(call, *desc, *owner), desc->eyeCount);
    object->max_width = desc->maxWidth;
    object->max_height = desc->maxHeight;
    object->tau = desc->tau;
    Scenes scenes;
    for (const auto& scene : object->scenes) scenes.push_back(scene->scene);
    object->view = std::make_unique<View>(std::move(scenes), *owner->backend, choices,
                                          owner->memory, owner->workers);
    if (budget != nullptr) set_time_budget(*object, *budget);
    *view = static_cast<VoyView>(HandleTable::instance().insert(object));
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyDestroyView(VoyView view) {
  return guarded("voyDestroyView", [&](Call& call) {
    call.remove<ViewObject>(view);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voySetViewTau(VoyView view, double tau) {
  return guarded("voySetViewTau", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    check_tau(tau, "tau");
    const auto frame = claim(*object);
    object->tau = tau;
    object->view->end_time_budget();
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voySetViewTimeBudget(VoyView view, const VoyTimeBudget* budget) {
  return guarded("voySetViewTimeBudget", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    check_structure(budget, VOY_STRUCTURE_TYPE_TIME_BUDGET, "VoyTimeBudget");
    check_time_budget(*budget);
    const auto frame = claim(*object);
    set_time_budget(*object, *budget);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyGetViewCut(VoyView view, uint32_t instance, uint32_t capacity,
                                 uint32_t* nodes, uint32_t* count) {
  return guarded("voyGetViewCut", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    check_pointer(count, "count");
    if (capacity > 0) check_pointer(nodes, "nodes");
    const auto frame = claim(*object);
    check_instance(instance, object->scenes.size());
    if (!object->view->draws_cut(instance))
      throw ApiError(VOY_ERROR_UNSUPPORTED,
                     "instance: found an instance of which the view draws every leaf, expected "
                     "one of which it draws a cut");
    check_has_frame(*object);
    if (!object->view->has_cuts())
      refuse(
          "view: found that voySetViewInstances has changed the scenes since the last frame, "
          "expected voyRenderFrame before this call");
    const auto& cut = object->view->cut(instance);
    const size_t written = std::min<size_t>(capacity, cut.size());
    std::copy_n(cut.begin(), written, nodes);
    *count = static_cast<uint32_t>(cut.size());
    return capacity > 0 && written < cut.size() ? VOY_INCOMPLETE : VOY_SUCCESS;
  });
}
