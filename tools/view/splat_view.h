#pragma once
// One view of the scene with its own settings, and the images that it is drawn into.
#include "camera.h"
#include "voyager_ring.h"

namespace voyager::view {

struct SplatSettings {
  float tau = 3;
  float milliseconds = 0;  // 0: tau is fixed. Else tau is whatever takes so long, and
  float least_tau = 1;     // this or more
  VoyAntialias antialias = VOY_ANTIALIAS_ON;
  bool operator==(const SplatSettings&) const = default;
};

class SplatView {
 public:
  // All must outlive it. has_tree: whether tau has an effect.
  SplatView(const host::Device& vulkan, const voy::Device& device, const voy::Scene& scene,
            bool has_tree)
      : vulkan_(vulkan), device_(device), scene_(scene), has_tree_(has_tree) {}

  // The queue must be idle: the images are replaced.
  void resize(VkExtent2D extent);
  // From the next frame on.
  void set(const SplatSettings& settings);
  // A frame: release() in commands that are submitted before render(), acquire() in those that
  // sample picture(). wait: until all is resident, of a scene with a tree.
  void release(VkCommandBuffer commands);
  void render(const host::Camera& camera, const float* background, bool wait);
  void acquire(VkCommandBuffer commands) const { ring_.record_acquire(commands, image_); }
  host::SemaphoreUse released() const { return ring_.released(image_); }
  host::SemaphoreUse rendered() const { return ring_.rendered(image_); }
  bool host_waits() const { return ring_.host_waits(); }
  // The last frame's, until the next release.
  VkImageView picture() const { return ring_.image(image_).colorView; }

  bool has_drawn() const { return has_drawn_; }
  VoyFrameStats stats() const { return view_.stats(); }
  std::vector<uint32_t> cut() const { return view_.cut(); }

 private:
  void create_view();

  const host::Device& vulkan_;
  const voy::Device& device_;
  const voy::Scene& scene_;
  const bool has_tree_;
  SplatSettings settings_;
  VkExtent2D view_extent_ = {0, 0};
  voy::View view_;
  host::VoyagerRing ring_;
  uint32_t image_ = 0;      // of the ring, in use
  double held_tau_ = 0;     // of the last frame in a time budget
  bool has_drawn_ = false;  // stats() and cut() then are of a frame
};

}  // namespace voyager::view
