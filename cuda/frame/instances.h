#pragma once
// A view's instances on the device.
#include <functional>
#include <span>
#include <vector>

#include "cuda/frame/draws.h"
#include "cuda/scene/device_parents.h"
#include "cuda/scene/device_scene.h"

namespace voyager::cuda {

struct DeviceInstance {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const DeviceScene> gaussians;  // shared by all instances of the scene
  std::shared_ptr<const DeviceParents> parents;  // as those; none but where a resident cut is drawn
  std::unique_ptr<Draws> draws;                  // its own, as its cut is

  // For a frame, as DeviceScene's.
  GaussianView view() const;
};

// The backend's: a new instance of a scene.
using MakeInstance = std::function<DeviceInstance(const std::shared_ptr<const Scene>&)>;

class DeviceInstances {
 public:
  // As set_scenes().
  DeviceInstances(MakeInstance make, const Scenes& scenes, uint32_t eyes);

  // As Pipeline has it. Throws Error(unsupported) where their lists together, for each eye, could
  // outgrow 32-bit slots, and what `make` throws.
  void set_scenes(const Scenes& scenes, std::span<const size_t> from);
  // Each instance's draws, in its scene's coordinates. Throws as Draws does.
  void update(const FrameInput& frame, cudaStream_t stream);
  // What reads the scenes' arrays in this frame has been launched, or has failed to be.
  void end_frame(cudaStream_t stream) const noexcept {
    for (const DeviceInstance& instance : all_) instance.draws->end_frame(stream);
  }

  const std::vector<DeviceInstance>& all() const { return all_; }
  // Whether one of them may draw nodes between their parent and themselves.
  bool siblings() const;
  // Of any of them, at most.
  uint32_t bytes_a_gaussian() const;
  uint32_t bytes_a_place() const;
  bool counts_changes() const;
  // Of the scenes' arrays: those of interpolation, where every leaf of a tree is drawn.
  std::vector<Omission> omissions() const;
  // As Draws has them, of all instances.
  size_t report_bytes() const;
  void report(unsigned char* into, cudaStream_t stream) const;
  void collect(const unsigned char* report, FrameStats& stats) const;

 private:
  MakeInstance make_;
  uint32_t eyes_;
  std::vector<DeviceInstance> all_;
};

// In front of update(): what is launched while this lives may read the scenes' arrays.
class SceneReading {
 public:
  SceneReading(const DeviceInstances& instances, cudaStream_t stream)
      : instances_(instances), stream_(stream) {}
  ~SceneReading() { instances_.end_frame(stream_); }
  SceneReading(const SceneReading&) = delete;
  SceneReading& operator=(const SceneReading&) = delete;

 private:
  const DeviceInstances& instances_;
  cudaStream_t stream_;
};

}  // namespace voyager::cuda
