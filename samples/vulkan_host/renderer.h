#pragma once
// A frame of this host, in a window or not: meshes, Voyager's image among them, the HUD.
// Two frames are in flight.
#include <functional>
#include <optional>

#include "frame_commands.h"
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
  // mesh: NULL for none. mesh_place: its axes (glTF's: y up) to the scene's. half_rate: Voyager
  // draws every second frame, and those between are reprojected from the one before.
  Renderer(const Device& device, VoyagerLayer& voyager, VkFormat colour_format,
           const DepthConvention& depth, const Mesh* mesh, const glm::dmat4& mesh_place,
           bool half_rate);

  VkRenderPass overlay_pass() const { return passes_.overlay(); }
  VkExtent2D extent() const { return targets_.extent; }

  // Waits until the queue is idle; the images are new.
  void resize(VkExtent2D extent);
  // The slot of the next frame, once the frame before it there is done.
  uint32_t wait_for_slot() const { return frames_.wait_for_slot(); }
  // The camera's size must be the extent.
  void draw(const Camera& camera, const Look& look, const Delivery& delivery);

 private:
  VkCommandBuffer record_before(const Camera& camera, const Look& look, bool renders);
  VkCommandBuffer record_after(const Camera& camera, const Look& look, bool renders,
                               const Delivery& delivery);
  void record_meshes(VkCommandBuffer commands, const Camera& camera, bool mesh) const;

  const Device& device_;
  VoyagerLayer& voyager_;
  const VkFormat colour_format_;
  const DepthConvention depth_;
  const glm::dmat4 mesh_place_;
  const bool half_rate_;
  RenderPasses passes_;
  std::optional<MeshPipeline> meshes_;
  RenderTargets targets_;
  FrameCommands frames_;
  uint32_t image_ = kFramesInFlight - 1;  // the last that Voyager drew
  bool reuses_next_ = false;              // the next frame may show it again
};

}  // namespace host
