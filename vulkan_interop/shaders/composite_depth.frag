#version 450
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "composite.glsl"

// Pixels without a depth are left out; else they are at the far plane.
layout(constant_id = 1) const bool kOnlyDepth = false;

layout(location = 0) out vec4 color;

void main() {
  const float z = texelFetch(depth_image, image_pixel(), 0).r;
  if (isinf(z) && kOnlyDepth) discard;
  const float t = isinf(z) ? 0.0 : clamp((1.0 / z - push.inverse_far) / push.slope, 0.0, 1.0);
  gl_FragDepth = abs(push.far_code - t);
  color = image_color();
}
