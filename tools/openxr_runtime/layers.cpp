#include "layers.h"

#include <cmath>

#include "readback.h"
#include "spaces.h"
#include "swapchain.h"

namespace test_runtime {
namespace {

// The swapchain of a sub-image whose most recently released image covers it.
Swapchain& check_sub_image(const XrSwapchainSubImage& sub, const std::string& name) {
  Swapchain& swapchain =
      context().handles.find<Swapchain>(sub.swapchain, (name + ".swapchain").c_str());
  if (swapchain.last_released < 0)
    violation(XR_ERROR_LAYER_INVALID, name + ".swapchain: found no released image, expected one");
  if (swapchain.images[static_cast<size_t>(swapchain.last_released)].acquired)
    violation(
        XR_ERROR_LAYER_INVALID,
        name + ".swapchain: found its last released image acquired again, expected it released");
  const auto& [offset, extent] = sub.imageRect;
  const int64_t width = swapchain.info.width, height = swapchain.info.height;
  if (offset.x < 0 || offset.y < 0 || extent.width < 1 || extent.height < 1 ||
      int64_t{offset.x} + extent.width > width || int64_t{offset.y} + extent.height > height)
    violation(XR_ERROR_SWAPCHAIN_RECT_INVALID,
              name + ".imageRect: found " + std::to_string(extent.width) + "x" +
                  std::to_string(extent.height) + " at " + std::to_string(offset.x) + "," +
                  std::to_string(offset.y) + ", expected it within " + std::to_string(width) + "x" +
                  std::to_string(height));
  if (sub.imageArrayIndex >= swapchain.info.arraySize)
    violation(XR_ERROR_VALIDATION_FAILURE,
              name + ".imageArrayIndex: found " + std::to_string(sub.imageArrayIndex) +
                  ", expected below " + std::to_string(swapchain.info.arraySize));
  if (!swapchain.acquired.empty())
    remark(name + ".swapchain has an acquired image: the one released before is shown");
  return swapchain;
}

void check_fov(const XrFovf& fov, const std::string& name) {
  constexpr float kQuarter = 1.57079632f;
  for (const float angle : {fov.angleLeft, fov.angleRight, fov.angleUp, fov.angleDown})
    if (!(std::abs(angle) < kQuarter))
      violation(XR_ERROR_VALIDATION_FAILURE, name + ": found " + std::to_string(angle) +
                                                 ", expected angles within a quarter turn");
  if (fov.angleLeft == fov.angleRight || fov.angleUp == fov.angleDown)
    violation(XR_ERROR_VALIDATION_FAILURE, name + ": found an empty field of view");
  if (fov.angleLeft > fov.angleRight || fov.angleDown > fov.angleUp) remark(name + " is flipped");
}

const XrCompositionLayerDepthInfoKHR* check_depth(const Session& session, const void* next,
                                                  const std::string& name) {
  const auto* depth =
      chained<XrCompositionLayerDepthInfoKHR>(next, XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR);
  if (!depth) return nullptr;
  if (!session.instance.enabled(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME))
    violation(XR_ERROR_VALIDATION_FAILURE,
              name + ": found depth, expected XR_KHR_composition_layer_depth enabled for it");
  if (!check_sub_image(depth->subImage, name + ".depth.subImage").format.depth)
    violation(XR_ERROR_VALIDATION_FAILURE, name + ".depth: expected a depth format");
  if (!(depth->minDepth >= 0 && depth->maxDepth <= 1 && depth->minDepth < depth->maxDepth))
    violation(XR_ERROR_VALIDATION_FAILURE, name + ".depth: expected 0 <= minDepth < maxDepth <= 1");
  if (!(depth->nearZ >= 0 && depth->farZ >= 0) || depth->nearZ == depth->farZ)
    violation(XR_ERROR_VALIDATION_FAILURE, name + ".depth: expected nearZ and farZ that differ");
  return depth;
}

void check_projection(const Session& session, const XrCompositionLayerProjection& layer,
                      const std::string& name) {
  const uint32_t count = view_count(session.configuration);
  if (layer.viewCount != count)
    violation(XR_ERROR_VALIDATION_FAILURE, name + ".viewCount: found " +
                                               std::to_string(layer.viewCount) + ", expected " +
                                               std::to_string(count));
  checked_pointer(layer.views, (name + ".views").c_str());
  for (uint32_t i = 0; i < count; ++i) {
    const XrCompositionLayerProjectionView& view = layer.views[i];
    const std::string view_name = name + ".views[" + std::to_string(i) + "]";
    checked(&view, XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, view_name.c_str());
    check_pose(view.pose, view_name + ".pose");
    check_fov(view.fov, view_name + ".fov");
    if (check_sub_image(view.subImage, view_name + ".subImage").format.depth)
      violation(XR_ERROR_VALIDATION_FAILURE, view_name + ": expected a colour format");
    check_depth(session, view.next, view_name);
  }
}

void check_quad(const XrCompositionLayerQuad& layer, const std::string& name) {
  check_pose(layer.pose, name + ".pose");
  check_sub_image(layer.subImage, name + ".subImage");
  if (!(layer.size.width > 0 && layer.size.height > 0))
    violation(XR_ERROR_VALIDATION_FAILURE, name + ".size: expected metres above 0");
}

const XrCompositionLayerProjection* check_layer(const Session& session,
                                                const XrCompositionLayerBaseHeader* layer,
                                                const std::string& name) {
  if (!layer) violation(XR_ERROR_LAYER_INVALID, name + ": found NULL");
  const bool projection = layer->type == XR_TYPE_COMPOSITION_LAYER_PROJECTION;
  if (!projection && layer->type != XR_TYPE_COMPOSITION_LAYER_QUAD)
    violation(XR_ERROR_LAYER_INVALID, name + "->type: found " + name_of(layer->type) +
                                          ", expected a projection or quad layer");
  if (&find_space(layer->space, (name + ".space").c_str()).session != &session)
    violation(XR_ERROR_VALIDATION_FAILURE, name + ".space: expected one of this session");
  if (!projection) {
    check_quad(*reinterpret_cast<const XrCompositionLayerQuad*>(layer), name);
    return nullptr;
  }
  const auto& checked_layer = *reinterpret_cast<const XrCompositionLayerProjection*>(layer);
  check_projection(session, checked_layer, name);
  return &checked_layer;
}

// One release, one frame: else the same picture is shown under another pose.
void use_release(const XrSwapchainSubImage& sub, uint32_t view) {
  Swapchain& swapchain = context().handles.find<Swapchain>(sub.swapchain, "swapchain");
  if (swapchain.releases == swapchain.used_release && view == 0 &&
      !(swapchain.info.createFlags & XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT))
    remark("an image released for an earlier frame is shown again");
  swapchain.used_release = swapchain.releases;
}

ViewImage read_view(const Session& session, const XrCompositionLayerProjection& layer,
                    uint32_t index, XrTime time) {
  const XrCompositionLayerProjectionView& view = layer.views[index];
  ViewImage image;
  image.in_root = locate(find_space(layer.space, "space"), time).in_root * from_xr(view.pose);
  image.fov = view.fov;
  image.extent = view.subImage.imageRect.extent;
  image.rgb = read_colour(session.device, view.subImage);
  if (const auto* depth = check_depth(session, view.next, "view"))
    image.depth = read_depth(session.device, *depth, image.depth_extent);
  return image;
}

}  // namespace

void end_with_layers(Session& session, const Frame& frame, const XrFrameEndInfo& info) {
  if (info.layerCount > XR_MIN_COMPOSITION_LAYERS_SUPPORTED)
    violation(XR_ERROR_LAYER_LIMIT_EXCEEDED, "layerCount: expected at most 16");
  if (info.layerCount > 0) checked_pointer(info.layers, "layers");
  const XrCompositionLayerProjection* first = nullptr;
  for (uint32_t i = 0; i < info.layerCount; ++i) {
    const auto* projection =
        check_layer(session, info.layers[i], "layers[" + std::to_string(i) + "]");
    if (!first) first = projection;
  }
  if (!first) return;
  run().report.count("frames_with_projection");
  for (uint32_t i = 0; i < first->viewCount; ++i) use_release(first->views[i].subImage, i);
  if (!run().capture.wants(frame.number)) return;
  std::vector<ViewImage> views;
  for (uint32_t i = 0; i < first->viewCount; ++i)
    views.push_back(read_view(session, *first, i, info.displayTime));
  run().report.add_to("captures", run().capture.add(views, frame.number, frame.display_time));
}

}  // namespace test_runtime
