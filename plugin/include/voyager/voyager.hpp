// voy::Device, Scene, Target and View own the handles of the C ABI, in C++17. This header is all
// there is: every call goes to voyager.h, and no C++ type crosses the boundary of the library.
// Each object destroys its handle. An object may outlive its parent; it is then of no use, like its
// handle. Objects are as thread-safe as their handles, except for moving and destroying them.
// The header needs C++ exceptions. Without them, use voyager.h.
#ifndef VOYAGER_VOYAGER_HPP_
#define VOYAGER_VOYAGER_HPP_

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "voyager/voyager.h"

namespace voy {

// Thrown when a call returns an error. what() is the result's name and the library's message.
class Error : public std::runtime_error {
 public:
  Error(VoyResult result, const char* message)
      : std::runtime_error(std::string(voyResultName(result)) + ": " + message), result_(result) {}
  VoyResult result() const { return result_; }

 private:
  VoyResult result_;
};

// Returns a success, VOY_INCOMPLETE included, and throws Error for an error.
inline VoyResult check(VoyResult result) {
  if (result < 0) throw Error(result, voyGetLastErrorMessage());
  return result;
}

// Lists the devices of this machine. See voyEnumerateDevices.
inline std::vector<VoyDeviceInfo> devices() {
  uint32_t count = 0;
  check(voyEnumerateDevices(0, nullptr, &count));
  std::vector<VoyDeviceInfo> devices(count);
  check(voyEnumerateDevices(count, devices.data(), &count));
  return devices;
}

// Owns one handle. It can be moved, not copied.
template <class T, VoyResult(VOY_CALL* destroy)(T)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(T handle) : handle_(handle) {}
  Handle(Handle&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Handle() { destroy(handle_); }
  T get() const { return handle_; }
  explicit operator bool() const { return handle_ != nullptr; }

 private:
  T handle_ = nullptr;
};

class Scene : public Handle<VoyScene, voyCloseScene> {
 public:
  using Handle::Handle;

  VoySceneInfo info() const {
    VoySceneInfo info = VOY_SCENE_INFO_INIT;
    check(voyGetSceneInfo(get(), &info));
    return info;
  }
  VoySceneProfile profile() const {
    VoySceneProfile profile = VOY_SCENE_PROFILE_INIT;
    VoySceneInfo info = VOY_SCENE_INFO_INIT;
    info.next = &profile;
    check(voyGetSceneInfo(get(), &info));
    return profile;
  }
  std::vector<VoySceneNote> notes() const {
    uint32_t count = 0;
    check(voyGetSceneNotes(get(), 0, nullptr, &count));
    std::vector<VoySceneNote> notes(count);
    check(voyGetSceneNotes(get(), count, notes.data(), &count));
    return notes;
  }
};

class Target : public Handle<VoyTarget, voyDestroyTarget> {
 public:
  using Handle::Handle;
};

class View : public Handle<VoyView, voyDestroyView> {
 public:
  using Handle::Handle;

  void set_tau(double pixels) { check(voySetViewTau(get(), pixels)); }
  void set_time_budget(const VoyTimeBudget& budget) { check(voySetViewTimeBudget(get(), &budget)); }
  void render(const VoyFrame& frame) { check(voyRenderFrame(get(), &frame)); }
  // The node ids of the instance's cut in the last frame, in ascending order.
  std::vector<uint32_t> cut(uint32_t instance = 0) const {
    uint32_t count = 0;
    check(voyGetViewCut(get(), instance, 0, nullptr, &count));
    std::vector<uint32_t> nodes(count);
    check(voyGetViewCut(get(), instance, count, nodes.data(), &count));
    return nodes;
  }
  std::vector<VoyOmission> omissions() const {
    uint32_t count = 0;
    check(voyGetViewOmissions(get(), 0, nullptr, &count));
    std::vector<VoyOmission> omissions(count);
    check(voyGetViewOmissions(get(), count, omissions.data(), &count));
    return omissions;
  }
  VoyFrameStats stats() const {
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    check(voyGetFrameStats(get(), &stats));
    return stats;
  }
};

class Device : public Handle<VoyDevice, voyDestroyDevice> {
 public:
  using Handle::Handle;

  static Device create(const VoyDeviceDesc& desc = VOY_DEVICE_DESC_INIT) {
    VoyDevice device = nullptr;
    check(voyCreateDevice(&desc, &device));
    return Device(device);
  }
  VoyCapabilities capabilities() const {
    VoyCapabilities capabilities = VOY_CAPABILITIES_INIT;
    check(voyGetCapabilities(get(), &capabilities));
    return capabilities;
  }
  Scene open_scene(const std::string& path) const {
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.path = path.c_str();
    return open_scene(desc);
  }
  Scene open_scene(const VoySceneDesc& desc) const {
    VoyScene scene = nullptr;
    check(voyOpenScene(get(), &desc, &scene));
    return Scene(scene);
  }
  Target create_target(const VoyTargetDesc& desc) const {
    VoyTarget target = nullptr;
    check(voyCreateTarget(get(), &desc, &target));
    return Target(target);
  }
  View create_view(const VoyViewDesc& desc) const {
    VoyView view = nullptr;
    check(voyCreateView(get(), &desc, &view));
    return View(view);
  }
};

}  // namespace voy

#endif
