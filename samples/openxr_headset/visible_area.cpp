#include "visible_area.h"

#include "warn_once.h"

namespace host {
namespace {

const std::vector<XrVector2f> kWhole = {{-1, -1}, {3, -1}, {-1, 3}};  // one triangle, in clip space

// Triangle by triangle, in tangents of the view; none where the runtime has no mask.
std::vector<XrVector2f> read_mask(const Runtime& runtime, XrSession session, uint32_t view) {
  const auto get = runtime.function<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR");
  std::vector<XrVector2f> vertices;
  std::vector<uint32_t> indices;
  for (;;) {
    XrVisibilityMaskKHR mask = xr_struct<XrVisibilityMaskKHR>(XR_TYPE_VISIBILITY_MASK_KHR);
    mask.vertexCapacityInput = static_cast<uint32_t>(vertices.size());
    mask.vertices = vertices.empty() ? nullptr : vertices.data();
    mask.indexCapacityInput = static_cast<uint32_t>(indices.size());
    mask.indices = indices.empty() ? nullptr : indices.data();
    const XrResult result = get(session, runtime.view_configuration(), view,
                                XR_VISIBILITY_MASK_TYPE_VISIBLE_TRIANGLE_MESH_KHR, &mask);
    if (result != XR_ERROR_SIZE_INSUFFICIENT) check(result, "xrGetVisibilityMaskKHR");
    if (mask.indexCountOutput == 0 || mask.vertexCountOutput == 0) return {};
    const bool complete = result != XR_ERROR_SIZE_INSUFFICIENT && !vertices.empty();
    vertices.resize(mask.vertexCountOutput);
    indices.resize(mask.indexCountOutput);
    if (complete) break;
  }
  std::vector<XrVector2f> corners;
  for (const uint32_t index : indices) {
    if (index >= vertices.size())
      throw Failure(kMachine, "xrGetVisibilityMaskKHR: found vertex " + std::to_string(index) +
                                  ", expected one of " + std::to_string(vertices.size()));
    corners.push_back(vertices[index]);
  }
  corners.resize(corners.size() / 3 * 3);
  return corners;
}

// A view is as well shown whole: what goes wrong with a mask ends nothing.
std::vector<XrVector2f> mask_or_whole(const Runtime& runtime, XrSession session, uint32_t view) {
  try {
    return read_mask(runtime, session, view);
  } catch (const Failure& failure) {
    warn_once(std::string(failure.what()) + ": whole images are drawn");
    return {};
  }
}

}  // namespace

VisibleArea::VisibleArea(const Gpu& gpu) : VisibleArea(gpu, std::vector<XrVector2f>()) {}

VisibleArea::VisibleArea(const Gpu& gpu, const Runtime& runtime, XrSession session, uint32_t view)
    : VisibleArea(gpu, mask_or_whole(runtime, session, view)) {}

VisibleArea::VisibleArea(const Gpu& gpu, const std::vector<XrVector2f>& mask)
    : whole_(mask.empty()),
      count_(static_cast<uint32_t>(whole_ ? kWhole.size() : mask.size())),
      vertices_(gpu, std::as_bytes(std::span(whole_ ? kWhole : mask)),
                VK_BUFFER_USAGE_VERTEX_BUFFER_BIT) {}

void VisibleArea::record(VkCommandBuffer commands) const {
  const VkBuffer buffer = vertices_.buffer.get();
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
  vkCmdDraw(commands, count_, 1, 0, 0);
}

ToClip VisibleArea::to_clip(const VoyFrustum& f) const {
  if (whole_) return {{1, 1}, {0, 0}};
  const double width = f.right - f.left, height = f.up - f.down;  // clip space has y down
  return {{static_cast<float>(2 / width), static_cast<float>(-2 / height)},
          {static_cast<float>(-(f.right + f.left) / width),
           static_cast<float>((f.up + f.down) / height)}};
}

}  // namespace host
