// How objects go while frames are in flight.
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
  device().device_budget.give_back(device_bytes_);
}

// Frames that wait for what will not come would be waited for.
void SceneObject::removed() noexcept {
  if (scene != nullptr && scene->streamed()) scene->stream->abandon();
}

void SceneObject::stop_reading() noexcept {
  if (scene != nullptr && scene->streamed()) scene->stream->stop();
}

// Threads of ours must leave the library's code, whatever else stays.
bool SceneObject::stays_at_unload() noexcept {
  if (!Child::stays_at_unload()) return false;
  stop_reading();
  return true;
}

bool ViewObject::finish_frames() noexcept {
  for (const auto& used : rings)
    if (const auto ring = used.lock()) finish(*ring, device());
  return !device().abandoned;
}

void ViewObject::drop_view() noexcept {
  if (!finish_frames()) static_cast<void>(view.release());
  rings.clear();
  view.reset();
  scenes.clear();
}

void ViewObject::lose(const std::shared_ptr<Object>& scene) noexcept {
  if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) return;
  scene_lost = true;
  if (!finish_frames()) return drop_view();
  try {
    auto kept = scenes;
    std::erase(kept, scene);
    set_scenes(std::move(kept));
  } catch (const std::exception&) {
    drop_view();
  }
}

void ViewObject::set_scenes(std::vector<std::shared_ptr<SceneObject>> next) {
  std::vector<const Object*> drawn;
  Scenes of_view;
  for (const auto& scene : next) {
    drawn.push_back(scene.get());
    of_view.push_back(scene->scene);
  }
  view->set_scenes(std::move(of_view));
  // From here on nothing fails. Who closes a scene that is listed waits for `state`, so what is
  // gone goes first.
  scenes.swap(next);
  next.clear();
  const std::lock_guard lock(listing_);
  drawn_.swap(drawn);
}

bool ViewObject::draws(const std::shared_ptr<Object>& scene) const {
  const std::lock_guard lock(listing_);
  return std::find(drawn_.begin(), drawn_.end(), scene.get()) != drawn_.end();
}

TargetObject::~TargetObject() {
  if (ring == nullptr) return;
  finish(*ring, device());
  if (device().abandoned) ring->abandon();
}

}  // namespace voyager
