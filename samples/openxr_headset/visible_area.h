#pragma once
// What of a view's image can be seen, as triangles: the runtime's visibility mask, or the whole.
// Pixels outside are not drawn; what no one sees is not missed.
#include "camera.h"
#include "resources.h"
#include "runtime.h"

namespace host {

// From the triangles' vertices to clip space: x·scale + offset.
struct ToClip {
  float scale[2], offset[2];
};

class VisibleArea {
 public:
  // The whole image.
  explicit VisibleArea(const Gpu& gpu);
  // What the runtime says of this view; the whole where it says nothing, or fails
  // (told on standard error).
  VisibleArea(const Gpu& gpu, const Runtime& runtime, XrSession session, uint32_t view);

  void record(VkCommandBuffer commands) const;
  ToClip to_clip(const VoyFrustum& frustum) const;

 private:
  VisibleArea(const Gpu& gpu, const std::vector<XrVector2f>& mask);

  bool whole_;
  uint32_t count_;
  Buffer vertices_;
};

}  // namespace host
