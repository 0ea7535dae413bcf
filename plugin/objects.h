#pragma once
// What stands behind each handle.
#include <atomic>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <optional>
#include <vector>

#include "plugin/handles.h"
#include "plugin/memory.h"
#include "runtime/base/workers.h"
#include "runtime/frame/backend.h"
#include "runtime/frame/scene.h"
#include "runtime/frame/view.h"
#include "voyager/voyager_vulkan.h"
#include "vulkan_interop/composite.h"
#include "vulkan_interop/ring.h"

namespace voyager {

// The host's log. Used on the thread of the call only.
struct Log {
  VoyLogFunction function = nullptr;
  void* user = nullptr;
  int32_t level = VOY_LOG_LEVEL_WARNING;

  void write(VoyLogLevel message_level, const char* message) const noexcept {
    if (function == nullptr || static_cast<int32_t>(message_level) > level) return;
    try {
      function(user, message_level, message);
    } catch (...) {
      // A log that throws does not fail the call.
    }
  }
};

struct DeviceObject final : Object {
  using Handle = VoyDevice;
  static constexpr Kind kKind = Kind::device;
  DeviceObject(const VoyDeviceDesc& desc, VoyBackend kind, std::unique_ptr<Backend> chosen);
  ~DeviceObject() override;
  // A frame never ends: it waits for a host that does not come, or its device is lost. To free
  // anything on the backend would be to wait for it, so all of it is left to the process.
  void abandon() noexcept;

  Log log;
  std::optional<HostMemory> host_memory;
  std::pmr::memory_resource* memory;  // views and frames
  Budget budget, device_budget;       // scene data, on the host and on a device
  Workers workers;
  VoyBackend backend_kind;
  std::unique_ptr<Backend> backend;
  std::atomic<bool> abandoned{false};
  // Held while a scene's budget is changed, so that no two share out the same rest of the device's.
  std::mutex resizing;
  std::shared_ptr<const vulkan::Device> vulkan;  // or NULL

 private:
  // Its VkDevice may be destroyed, and frames may wait for the host's queue.
  bool stays_at_unload() noexcept override {
    if (vulkan == nullptr) return false;
    std::destroy_at(&workers);  // oneTBB's threads leave the library's code; the rest stays
    return true;
  }
};

struct Child : Object {
  Child(Kind kind, std::shared_ptr<DeviceObject> device) : Object(kind, std::move(device)) {}
  DeviceObject& device() const { return static_cast<DeviceObject&>(*parent()); }

 protected:
  bool stays_at_unload() noexcept override { return device().vulkan != nullptr; }
};

struct SceneObject final : Child {
  using Handle = VoyScene;
  static constexpr Kind kKind = Kind::scene;
  explicit SceneObject(std::shared_ptr<DeviceObject> owner)
      : Child(kKind, std::move(owner)), memory(device().memory, device().budget) {}

  ~SceneObject() override;
  Budget& pool_budget() const;  // that a streamed scene's pool counts on
  // What the pool and the views that read it take from now on. Throws Error(over_budget) where
  // other scenes have taken what it would need, and nothing has changed. One call at a time.
  void count(uint64_t bytes);

  // Of a streamed scene: nothing calls its source any more. Whoever still holds it draws what is
  // there.
  void stop_reading() noexcept;

  SceneMemory memory;
  std::shared_ptr<Scene> scene;  // lives in `memory`, so is declared after it

 private:
  uint64_t device_bytes_ = 0;  // counted that `memory` does not count: in a device's own memory
  void removed() noexcept override;
  bool stays_at_unload() noexcept override;
};

struct ViewObject final : Child {
  using Handle = VoyView;
  static constexpr Kind kKind = Kind::view;
  ViewObject(std::shared_ptr<DeviceObject> owner, std::vector<std::shared_ptr<SceneObject>> drawn,
             uint32_t drawn_eyes)
      : Child(kKind, std::move(owner)), eyes(drawn_eyes), scenes(std::move(drawn)) {
    for (const auto& scene : scenes) drawn_.push_back(scene.get());
  }

  ~ViewObject() override { drop_view(); }
  // A view waits for its frames in flight, which may wait for the host: so rings first see
  // to it that they end. False, and the device is abandoned, where they do not.
  bool finish_frames() noexcept;
  void drop_view() noexcept;
  // The scene was closed: the view draws no instance of it any more. Under `state`.
  void lose(const std::shared_ptr<Object>& scene) noexcept;
  // As View has it; the frames in flight are finished. Under `state`.
  void set_scenes(std::vector<std::shared_ptr<SceneObject>> next);
  // Whether it draws the scene. Any thread, without `state`.
  bool draws(const std::shared_ptr<Object>& scene) const;

  const uint32_t eyes;
  uint32_t max_width = 0, max_height = 0;
  std::mutex busy;                                 // held by a call of the host's
  std::mutex state;                                // guards what follows; taken after `busy`
  std::vector<std::weak_ptr<vulkan::Ring>> rings;  // that it has drawn into
  double tau = 0;                                  // without a time budget
  bool scene_lost = false;                         // one was closed, and no list came since
  // Of the host's list, as FrameInput has them.
  std::vector<InstancePose> poses;
  std::vector<InstanceLook> looks;
  // One an instance. The view reads the scenes' memory, so is declared after them. It is missing
  // where closing a scene went wrong.
  std::vector<std::shared_ptr<SceneObject>> scenes;
  std::unique_ptr<View> view;

 private:
  mutable std::mutex listing_;  // guards what follows
  std::vector<const Object*> drawn_;
};

struct TargetObject final : Child {
  using Handle = VoyTarget;
  static constexpr Kind kKind = Kind::target;
  TargetObject(std::shared_ptr<DeviceObject> owner, const Image& pixels)
      : Child(kKind, std::move(owner)), image(pixels) {}
  ~TargetObject() override;

  Image image;                         // of a ring: its size and format alone
  std::mutex busy;                     // held while a frame writes, or commands are recorded
  std::shared_ptr<vulkan::Ring> ring;  // of a Vulkan target
};

struct CompositeObject final : Child {
  using Handle = VoyVulkanComposite;
  static constexpr Kind kKind = Kind::composite;
  CompositeObject(std::shared_ptr<DeviceObject> owner, const vulkan::CompositeDesc& desc)
      : Child(kKind, std::move(owner)), composite(device().vulkan, desc) {}

  const vulkan::Composite composite;
};

}  // namespace voyager
