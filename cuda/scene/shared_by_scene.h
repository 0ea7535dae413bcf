#pragma once
// What the views of a scene share on the device, for as long as one of them is there.
#include <map>
#include <memory>
#include <mutex>

#include "runtime/frame/scene.h"

namespace voyager::cuda {

template <class T>
class SharedByScene {
 public:
  // The scene's, made by make(const Scene&) where no one holds it. Any thread.
  template <class Make>
  std::shared_ptr<const T> of(const std::shared_ptr<const Scene>& scene, const Make& make) {
    const std::lock_guard lock(mutex_);
    std::erase_if(values_, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<const T>& held = values_[scene];
    if (auto value = held.lock()) return value;
    std::shared_ptr<const T> value = make(*scene);
    held = value;
    return value;
  }

 private:
  std::mutex mutex_;
  std::map<std::weak_ptr<const Scene>, std::weak_ptr<const T>, std::owner_less<>> values_;
};

}  // namespace voyager::cuda
