#include "mesh_pipeline.h"

#include <cstddef>
#include <iterator>

#include "graphics_states.h"
#include "mesh.frag.h"
#include "mesh.vert.h"

namespace host {
namespace {

constexpr VkPushConstantRange kConstants = {VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(glm::mat4)};
constexpr VkVertexInputBindingDescription kBinding = {0, sizeof(Vertex),
                                                      VK_VERTEX_INPUT_RATE_VERTEX};
constexpr VkVertexInputAttributeDescription kAttributes[] = {
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
    {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
    {2, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, colour)}};

struct MeshStates : GraphicsStates {
  explicit MeshStates(VoyDepthEncoding encoding) {
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &kBinding;
    input.vertexAttributeDescriptionCount = std::size(kAttributes);
    input.pVertexAttributeDescriptions = kAttributes;
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = encoding == VOY_DEPTH_ENCODING_REVERSED ? VK_COMPARE_OP_GREATER_OR_EQUAL
                                                                   : VK_COMPARE_OP_LESS_OR_EQUAL;
  }
};

UniquePipeline make_mesh_pipeline(VkDevice device, VkPipelineLayout layout,
                                  VkRenderPass render_pass, bool encode,
                                  VoyDepthEncoding encoding) {
  const UniqueShaderModule vertex = make_shader(device, mesh_vert);
  const UniqueShaderModule fragment = make_shader(device, mesh_frag);
  const VkBool32 encode_value = encode;
  const VkSpecializationMapEntry entry = {0, 0, sizeof encode_value};
  const VkSpecializationInfo constants = {1, &entry, sizeof encode_value, &encode_value};
  VkPipelineShaderStageCreateInfo stages[] = {shader_stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                                              shader_stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
  stages[1].pSpecializationInfo = &constants;
  return make_pipeline(device, stages, MeshStates(encoding), layout, render_pass);
}

}  // namespace

MeshPipeline::MeshPipeline(const Device& device, VkRenderPass render_pass, VkFormat colour_format,
                           VoyDepthEncoding encoding, const Mesh& mesh)
    : vertices_(device, std::as_bytes(std::span(mesh.vertices)), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT),
      indices_(device, std::as_bytes(std::span(mesh.indices)), VK_BUFFER_USAGE_INDEX_BUFFER_BIT),
      index_count_(static_cast<uint32_t>(mesh.indices.size())),
      layout_(make_pipeline_layout(device.get(), VK_NULL_HANDLE, kConstants)),
      pipeline_(make_mesh_pipeline(device.get(), layout_.get(), render_pass,
                                   colour_format == VK_FORMAT_R8G8B8A8_UNORM, encoding)) {}

void MeshPipeline::record(VkCommandBuffer commands, VkExtent2D extent,
                          const glm::mat4& clip_from_mesh) const {
  const VkViewport viewport = {
      0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
  const VkRect2D scissor = {{0, 0}, extent};
  const VkBuffer vertices = vertices_.buffer.get();
  const VkDeviceSize offset = 0;
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scissor);
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof clip_from_mesh,
                     &clip_from_mesh);
  vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &offset);
  vkCmdBindIndexBuffer(commands, indices_.buffer.get(), 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(commands, index_count_, 1, 0, 0, 0);
}

}  // namespace host
