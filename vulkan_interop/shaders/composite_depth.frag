#version 450
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "composite.glsl"

// Pixels without a depth are left out; else they are at the far plane.
layout(constant_id = 1) const bool kOnlyDepth = false;

layout(location = 0) out vec4 color;

void main() {
  const Source source = source_of_pixel();
  const float inverse_z = inverse_z_of(source);
  if (inverse_z == 0.0 && kOnlyDepth) discard;
  const float t = clamp((inverse_z - push.inverse_far) / push.slope, 0.0, 1.0);
  gl_FragDepth = abs(push.far_code - t);
  color = color_of(source);
}
