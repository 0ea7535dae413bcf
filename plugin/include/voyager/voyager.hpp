// voy::Device, Scene, Target and View own the handles of the C ABI, in C++17. This header is all
// there is: every call goes to voyager.h, and no C++ type crosses the boundary of the library.
// Each object closes or destroys its handle. An object may outlive its parent; it is then of no
// use, like its handle. Objects are as thread-safe as their handles, except for moving and
// destroying them. The head of voyager.h says what of this is promised.
//
// A call that fails throws voy::Error. Where the compiler has no exceptions, or
// VOYAGER_NO_EXCEPTIONS is defined before this header is included, calls return what went wrong:
// those with a value return voy::Result, which holds the value only if `result` is not negative,
// and the others return VoyResult. voyGetLastErrorMessage has the message. Both kinds of source
// files may be linked into one program.
#ifndef VOYAGER_VOYAGER_HPP_
#define VOYAGER_VOYAGER_HPP_

#if !defined(VOYAGER_NO_EXCEPTIONS) && !defined(__cpp_exceptions)
#define VOYAGER_NO_EXCEPTIONS
#endif

#include <algorithm>
#ifndef VOYAGER_NO_EXCEPTIONS
#include <stdexcept>
#endif
#include <string>
#include <utility>
#include <vector>

#include "voyager/voyager.h"

namespace voy {

#ifdef VOYAGER_NO_EXCEPTIONS

inline namespace without_exceptions {

template <class T>
struct Result {
  VoyResult result;
  T value;
  explicit operator bool() const { return result >= 0; }
};

template <class T>
using Returned = Result<T>;
using Done = VoyResult;

namespace detail {
template <class T>
Returned<T> returned(VoyResult result, T value) {
  return {result, std::move(value)};
}
inline Done done(VoyResult result) {
  return result;
}
}  // namespace detail

#else

inline namespace with_exceptions {

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

template <class T>
using Returned = T;
using Done = void;

namespace detail {
template <class T>
Returned<T> returned(VoyResult result, T value) {
  check(result);
  return value;
}
inline Done done(VoyResult result) {
  check(result);
}
}  // namespace detail

#endif

namespace detail {
// The elements of an array that list(capacity, elements, count) fills.
template <class T, class List>
Returned<std::vector<T>> listed(const T& initial, const List& list) {
  uint32_t count = 0;
  std::vector<T> elements;
  VoyResult result = list(0, nullptr, &count);
  if (result >= 0) {
    elements.assign(count, initial);
    result = list(count, elements.data(), &count);
    elements.resize(std::min<size_t>(count, elements.size()));
  }
  return returned(result, std::move(elements));
}
}  // namespace detail

// Lists the devices of this machine. See voyEnumerateDevices.
inline Returned<std::vector<VoyDeviceInfo>> devices() {
  return detail::listed(VoyDeviceInfo VOY_DEVICE_INFO_INIT, voyEnumerateDevices);
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

  Returned<VoySceneInfo> info() const {
    VoySceneInfo info = VOY_SCENE_INFO_INIT;
    const VoyResult result = voyGetSceneInfo(get(), &info);
    return detail::returned(result, info);
  }
  Returned<VoySceneProfile> profile() const {
    VoySceneProfile profile = VOY_SCENE_PROFILE_INIT;
    VoySceneInfo info = VOY_SCENE_INFO_INIT;
    info.next = &profile;
    const VoyResult result = voyGetSceneInfo(get(), &info);
    return detail::returned(result, profile);
  }
  Returned<std::vector<VoySceneNote>> notes() const {
    return detail::listed(VoySceneNote VOY_SCENE_NOTE_INIT,
                          [&](uint32_t capacity, VoySceneNote* notes, uint32_t* count) {
                            return voyGetSceneNotes(get(), capacity, notes, count);
                          });
  }
  // Of a streamed scene.
  Done set_memory_budget(uint64_t bytes) {
    return detail::done(voySetSceneMemoryBudget(get(), bytes));
  }
  // Of a streamed scene.
  Returned<VoyStreamingStats> streaming_stats() const {
    VoyStreamingStats stats = VOY_STREAMING_STATS_INIT;
    const VoyResult result = voyGetStreamingStats(get(), &stats);
    return detail::returned(result, stats);
  }
};

class Target : public Handle<VoyTarget, voyDestroyTarget> {
 public:
  using Handle::Handle;
};

class View : public Handle<VoyView, voyDestroyView> {
 public:
  using Handle::Handle;

  Done set_tau(double pixels) { return detail::done(voySetViewTau(get(), pixels)); }
  Done set_time_budget(const VoyTimeBudget& budget) {
    return detail::done(voySetViewTimeBudget(get(), &budget));
  }
  // Elements start as VoyInstance VOY_INSTANCE_INIT.
  Done set_instances(const std::vector<VoyInstance>& instances) {
    return detail::done(voySetViewInstances(get(), static_cast<uint32_t>(instances.size()),
                                            instances.empty() ? nullptr : instances.data()));
  }
  Done render(const VoyFrame& frame) { return detail::done(voyRenderFrame(get(), &frame)); }
  // The node ids of the instance's cut in the last frame, in ascending order.
  Returned<std::vector<uint32_t>> cut(uint32_t instance = 0) const {
    return detail::listed(uint32_t{0}, [&](uint32_t capacity, uint32_t* nodes, uint32_t* count) {
      return voyGetViewCut(get(), instance, capacity, nodes, count);
    });
  }
  Returned<std::vector<VoyOmission>> omissions() const {
    return detail::listed(VoyOmission VOY_OMISSION_INIT,
                          [&](uint32_t capacity, VoyOmission* omissions, uint32_t* count) {
                            return voyGetViewOmissions(get(), capacity, omissions, count);
                          });
  }
  Returned<VoyFrameStats> stats() const {
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    const VoyResult result = voyGetFrameStats(get(), &stats);
    return detail::returned(result, stats);
  }
};

class Device : public Handle<VoyDevice, voyDestroyDevice> {
 public:
  using Handle::Handle;

  static Returned<Device> create(const VoyDeviceDesc& desc = VOY_DEVICE_DESC_INIT) {
    VoyDevice device = nullptr;
    const VoyResult result = voyCreateDevice(&desc, &device);
    return detail::returned(result, Device(device));
  }
  Returned<VoyCapabilities> capabilities() const {
    VoyCapabilities capabilities = VOY_CAPABILITIES_INIT;
    const VoyResult result = voyGetCapabilities(get(), &capabilities);
    return detail::returned(result, capabilities);
  }
  Returned<Scene> open_scene(const std::string& path) const {
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.path = path.c_str();
    return open_scene(desc);
  }
  Returned<Scene> open_scene(const VoySceneDesc& desc) const {
    VoyScene scene = nullptr;
    const VoyResult result = voyOpenScene(get(), &desc, &scene);
    return detail::returned(result, Scene(scene));
  }
  Returned<Target> create_target(const VoyTargetDesc& desc) const {
    VoyTarget target = nullptr;
    const VoyResult result = voyCreateTarget(get(), &desc, &target);
    return detail::returned(result, Target(target));
  }
  Returned<View> create_view(const VoyViewDesc& desc) const {
    VoyView view = nullptr;
    const VoyResult result = voyCreateView(get(), &desc, &view);
    return detail::returned(result, View(view));
  }
};

}  // inline namespace
}  // namespace voy

#endif
