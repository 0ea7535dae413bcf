#pragma once
// A view's part in streaming: says where it looks, and is going, and takes what has come.
#include <functional>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <span>
#include <vector>

#include "runtime/frame/backend.h"

namespace voyager {

// Seconds, on a clock that never goes back.
using Clock = std::function<double()>;

class FrameStreaming {
 public:
  explicit FrameStreaming(const Scenes& scenes, Clock clock = {});
  ~FrameStreaming();
  FrameStreaming(const FrameStreaming&) = delete;
  FrameStreaming& operator=(const FrameStreaming&) = delete;
  // Goes on as the one before did. from: of each instance, the one of `before` that it was
  // (match_instances.h).
  void take_over(FrameStreaming& before, std::span<const size_t> from) noexcept;

  // While these live, what is resident stays as the frame has found it.
  using Holds = std::vector<std::shared_lock<std::shared_mutex>>;
  // In front of a frame. Waits for nothing unless the frame says so; throws as
  // SceneStream::wait() does.
  Holds begin(const FrameInput& frame);
  // Of the frame.
  void collect(FrameStats& stats);
  // Behind a frame that has ended. What there is no memory for is not told: others are asked for
  // first, and no frame fails.
  void tell_shown(const Pipeline& pipeline) const noexcept;

 private:
  struct Instance {
    std::shared_ptr<const Scene> scene;
    std::unique_ptr<const char> name;  // its address is what the scene's stream knows it by
  };

  Holds hold_all() const;
  Holds hold_settled(bool stand_in) const;
  Viewer viewer_of(const FrameInput& frame, size_t instance);
  std::optional<Vec3d> velocity(const FrameInput& frame);

  std::vector<Instance> instances_;
  std::vector<const Scene*> streamed_;  // each once
  std::vector<uint64_t> bytes_read_;    // of each, as of the frame before
  Clock clock_;
  std::optional<Vec3d> velocity_;  // world, metres a second; none: unknown
  std::optional<Vec3d> eye_;
  double time_ = 0;
};

}  // namespace voyager
