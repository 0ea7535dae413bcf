#include <algorithm>

#include "session.h"

using namespace test_runtime;

namespace {

constexpr float kCut = 0.15f;  // of a side, that a corner loses

struct Mesh {
  std::vector<XrVector2f> vertices;
  std::vector<uint32_t> indices;
};

// What an eye sees at most over the whole motion, at z = -1.
Eye widest(uint32_t eye) {
  const Motion& motion = run().script.motion;
  Eye wide = motion[0].eyes[eye];
  for (const Head& head : motion) {
    wide.left = std::min(wide.left, head.eyes[eye].left);
    wide.right = std::max(wide.right, head.eyes[eye].right);
    wide.up = std::max(wide.up, head.eyes[eye].up);
    wide.down = std::min(wide.down, head.eyes[eye].down);
  }
  return wide;
}

// Twelve points, counter-clockwise from the bottom left corner: each corner between its cut's ends.
std::vector<XrVector2f> outline(const Eye& eye) {
  const auto l = static_cast<float>(eye.left), r = static_cast<float>(eye.right);
  const auto d = static_cast<float>(eye.down), u = static_cast<float>(eye.up);
  const float x = kCut * (r - l), y = kCut * (u - d);
  return {{l, d + y}, {l, d}, {l + x, d}, {r - x, d}, {r, d}, {r, d + y},
          {r, u - y}, {r, u}, {r - x, u}, {l + x, u}, {l, u}, {l, u - y}};
}

Mesh mesh(uint32_t eye, XrVisibilityMaskTypeKHR type) {
  const auto points = outline(widest(eye));
  Mesh made;
  if (type == XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR) {
    made.vertices = points;
    for (uint32_t i = 0; i < points.size(); ++i) made.indices.push_back(i);
    return made;
  }
  for (size_t i = 0; i < points.size(); ++i)
    if (i % 3 != 1) made.vertices.push_back(points[i]);
  const auto count = static_cast<uint32_t>(made.vertices.size());
  if (type == XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR)
    for (uint32_t i = 0; i < count; ++i) made.indices.push_back(i);
  else
    for (uint32_t i = 2; i < count; ++i) made.indices.insert(made.indices.end(), {0, i - 1, i});
  return made;
}

}  // namespace

XrResult xrGetVisibilityMaskKHR(XrSession handle, XrViewConfigurationType configuration,
                                uint32_t view, XrVisibilityMaskTypeKHR type,
                                XrVisibilityMaskKHR* mask) {
  return call(__func__, [&](auto&) {
    const Session& session = find_session(handle);
    check_view_configuration(session.instance, configuration);
    checked(mask, XR_TYPE_VISIBILITY_MASK_KHR, "visibilityMask");
    if (view >= view_count(configuration))
      violation(XR_ERROR_INDEX_OUT_OF_RANGE, "viewIndex: found " + std::to_string(view) +
                                                 ", expected below " +
                                                 std::to_string(view_count(configuration)));
    if (type < XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR ||
        type > XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR)
      violation(XR_ERROR_VALIDATION_FAILURE, "visibilityMaskType: expected one of the three");
    const Mesh made = view < 2 ? mesh(view, type) : Mesh();  // all of an inner view is seen
    const uint32_t vertex_capacity = mask->vertexCapacityInput;
    enumerate(made.vertices.size(), vertex_capacity, &mask->vertexCountOutput, mask->vertices,
              [&](size_t i, XrVector2f& vertex) { vertex = made.vertices[i]; });
    enumerate(made.indices.size(), mask->indexCapacityInput, &mask->indexCountOutput, mask->indices,
              [&](size_t i, uint32_t& index) { index = made.indices[i]; });
    return success(session);
  });
}
