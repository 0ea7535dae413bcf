#version 450
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "eye.glsl"

layout(set = 0, binding = 1) uniform texture2DArray depth_image;  // metres; +inf: nothing

layout(location = 0) out vec4 color;

void main() {
  const float z = texelFetch(depth_image, image_pixel(), 0).r;
  gl_FragDepth = isinf(z) ? 1.0 : clamp(push.a + push.b / z, 0.0, 1.0);
  color = linear_color();
}
