#pragma once
// A view of two eyes and what it draws into: a ring with a layer for each eye, or, where the eyes'
// images differ in size, a ring an eye. What a view keeps is its own, its cut above all. With quad
// views a layer has two pairs of one scene: at the same tau, which is in pixels, the outer pair's
// coarser pixels give it the coarser cut.
#include <array>
#include <span>
#include <string>

#include "camera.h"
#include "frames_in_flight.h"
#include "graphics.h"
#include "submission.h"
#include "voyager_ring.h"

namespace host {

class EyePair {
 public:
  // All must outlive it.
  EyePair(const Graphics& graphics, const voy::Device& device, const voy::Scene& scene, double tau);

  // As VoyagerLayer has them, of this pair alone; an eye is 0 (left) or 1.
  void hold_frame_time(double milliseconds);
  void resize(std::span<const VkExtent2D> extents, bool depth);  // of the two eyes
  const VoyVulkanImage& image(uint32_t slot, size_t eye) const { return ring(eye).image(slot); }
  uint32_t layer(size_t eye) const { return rings_.size() == 1 ? static_cast<uint32_t>(eye) : 0; }
  void begin_frame();
  void record_release(VkCommandBuffer commands, uint32_t slot) const;
  void signal_released(Submission& submission, uint32_t slot) const;
  void render(std::span<const Camera> eyes, double near_z, uint32_t slot);
  void record_acquire(VkCommandBuffer commands, uint32_t slot) const;
  void wait_for_rendered(Submission& submission, uint32_t slot) const;
  std::string summary() const;

 private:
  void create_view(VkExtent2D largest);
  const VoyagerRing& ring(size_t eye) const { return rings_[rings_.size() == 1 ? 0 : eye]; }

  const Graphics* graphics_;
  const voy::Device* device_;
  const voy::Scene* scene_;
  double tau_;
  double frame_time_ = 0;  // milliseconds; 0: tau is fixed
  voy::View view_;
  VkExtent2D view_extent_ = {0, 0};
  bool has_drawn_ = false;          // with this view
  std::vector<VoyagerRing> rings_;  // one, or one an eye
};

}  // namespace host
