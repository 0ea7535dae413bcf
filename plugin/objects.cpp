// How objects go while frames are under way.
#include "plugin/objects.h"

#include <algorithm>

namespace voyager {

DeviceObject::~DeviceObject() {
  if (abandoned) static_cast<void>(backend.release());
}

void DeviceObject::abandon() noexcept {
  if (abandoned.exchange(true)) return;
  log.write(
      VOY_LOG_LEVEL_ERROR,
      "a frame into a Vulkan target did not finish, because `released` was not signalled. The "
      "memory that it may still use is not freed, and the device draws no more frames");
}

namespace {

void finish(vulkan::Ring& ring, DeviceObject& device) noexcept {
  if (!device.abandoned && !ring.finish()) device.abandon();
}

}  // namespace

SceneObject::~SceneObject() {
  scene.reset();
  device().device_budget.give_back(device_bytes);
}

// Frames that wait for what will not come would be waited for.
void SceneObject::removed() noexcept {
  if (scene != nullptr && scene->streamed()) scene->stream->abandon();
}

// Threads of ours must leave the library's code, whatever else stays.
bool SceneObject::stays_at_unload() noexcept {
  if (!Child::stays_at_unload()) return false;
  if (scene != nullptr && scene->streamed()) scene->stream->stop();
  return true;
}

void ViewObject::drop_view() noexcept {
  for (const auto& used : rings)
    if (const auto ring = used.lock()) finish(*ring, device());
  rings.clear();
  if (device().abandoned) static_cast<void>(view.release());
  view.reset();
  scenes.clear();
}

bool ViewObject::draws(const std::shared_ptr<Object>& scene) const {
  return std::any_of(drawn_.begin(), drawn_.end(), [&](const auto& drawn) {
    return !drawn.owner_before(scene) && !scene.owner_before(drawn);
  });
}

TargetObject::~TargetObject() {
  if (ring == nullptr) return;
  finish(*ring, device());
  if (device().abandoned) ring->abandon();
}

}  // namespace voyager
