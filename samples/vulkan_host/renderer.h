#pragma once
// A frame of this host, in a window or not: meshes, Voyager's image among them, the HUD.
// Two frames are in flight.
#include <array>
#include <functional>
#include <optional>

#include "frames_in_flight.h"
#include "mesh_pipeline.h"
#include "options.h"
#include "render_targets.h"
#include "voyager_layer.h"

namespace host {

// What becomes of a frame's image, and what is drawn over it.
struct Delivery {
  std::function<void(VkCommandBuffer)> overlay;  // in the render pass, or empty
  // After it: colour and depth are in TRANSFER_SRC_OPTIMAL.
  std::function<void(VkCommandBuffer, const RenderTargets&)> record;
  VkSemaphore wait = VK_NULL_HANDLE, signal = VK_NULL_HANDLE;  // binary, at the transfers
};

struct Look {
  Composite composite;
  bool mesh;
};

class Renderer {
 public:
  // mesh: NULL for none. mesh_place: its axes (glTF's: y up) to the scene's.
  Renderer(const Device& device, VoyagerLayer& voyager, VkFormat colour_format,
           const DepthConvention& depth, const Mesh* mesh, const glm::dmat4& mesh_place);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  VkRenderPass overlay_pass() const { return passes_.overlay(); }
  VkExtent2D extent() const { return targets_.extent; }

  // Waits until the queue is idle; the images are new.
  void resize(VkExtent2D extent);
  // The slot of the next frame, once the frame before it there is done.
  uint32_t wait_for_slot();
  // The camera's size must be the extent.
  void draw(const Camera& camera, const Look& look, const Delivery& delivery);

 private:
  struct Slot {
    VkCommandBuffer before = VK_NULL_HANDLE, after = VK_NULL_HANDLE;  // Voyager's frame
    UniqueFence before_done, after_done;
  };

  void record_before(const Slot& slot, const Camera& camera, const Look& look);
  void record_after(const Slot& slot, const Look& look, const Delivery& delivery);
  void submit_before(const Slot& slot, bool splats);
  void submit_after(const Slot& slot, bool splats, const Delivery& delivery);
  void record_meshes(VkCommandBuffer commands, const Camera& camera, bool mesh) const;

  const Device& device_;
  VoyagerLayer& voyager_;
  const VkFormat colour_format_;
  const DepthConvention depth_;
  const glm::dmat4 mesh_place_;
  RenderPasses passes_;
  std::optional<MeshPipeline> meshes_;
  RenderTargets targets_;
  UniqueCommandPool pool_;
  std::array<Slot, kFramesInFlight> slots_;
  uint32_t slot_ = 0;
};

}  // namespace host
