#pragma once
// Draws a mesh with depth.
#include <glm/mat4x4.hpp>

#include "camera.h"
#include "device.h"
#include "mesh.h"
#include "resources.h"

namespace host {

class MeshPipeline {
 public:
  // encode: the attachment holds code values (_UNORM).
  MeshPipeline(const Device& device, VkRenderPass render_pass, VkFormat colour_format,
               VoyDepthEncoding encoding, const Mesh& mesh);

  // Inside the render pass.
  void record(VkCommandBuffer commands, VkExtent2D extent, const glm::mat4& clip_from_mesh) const;

 private:
  Buffer vertices_, indices_;
  uint32_t index_count_;
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
};

}  // namespace host
