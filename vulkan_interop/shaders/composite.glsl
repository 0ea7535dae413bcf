// An image of a ring over the host's, pixel by pixel, or as another eye sees it.
layout(set = 0, binding = 0) uniform texture2DArray color_image;
layout(set = 0, binding = 1) uniform texture2DArray depth_image;

layout(push_constant) uniform Push {
  ivec2 first;  // pixel of the attachment where the image begins
  int layer;
  float slope, inverse_far;  // the host's depth encoding, as runtime/math/host_depth.h has it
  float far_code;            // the depth of the far plane
  int last_row;              // of the area, where the image is drawn upside down; else -1
  vec4 rows[3];              // of a Reprojection (runtime/math/reprojection.h), as the last two
  vec4 drawn, now;
} push;

// The attachment encodes what it is given, so code values are decoded first.
layout(constant_id = 0) const bool kDecode = false;
// Another eye sees it.
layout(constant_id = 2) const bool kReprojected = false;

// What a pixel shows: where in the image, in pixels, and 1/z there; 0 is infinitely far.
struct Source {
  vec2 at;
  float inverse_z;
};

// Of the pixel that is drawn, in the image's rows.
vec2 pixel_center() {
  const vec2 center = gl_FragCoord.xy - vec2(push.first);
  return push.last_row < 0 ? center : vec2(center.x, float(push.last_row + 1) - center.y);
}

float inverse_depth(ivec2 pixel) {
  const float z = texelFetch(depth_image, ivec3(pixel, push.layer), 0).r;
  return isinf(z) ? 0.0 : 1.0 / z;
}

#include "reprojection.glsl"

Source source_of_pixel() {
  const ivec2 pixel = ivec2(pixel_center());
  return kReprojected ? reprojected() : Source(vec2(pixel), 0.0);
}

vec3 decode(vec3 code) {
  return mix(pow((code + 0.055) / 1.055, vec3(2.4)), code / 12.92,
             lessThanEqual(code, vec3(0.04045)));
}

vec4 color_of(Source source) {
  const vec4 color = kReprojected ? between_pixels(source.at)
                                  : texelFetch(color_image, ivec3(ivec2(source.at), push.layer), 0);
  if (!kDecode || color.a <= 0.0) return color;
  return vec4(decode(max(color.rgb / color.a, 0.0)) * color.a, color.a);
}

float inverse_z_of(Source source) {
  return kReprojected ? source.inverse_z : inverse_depth(ivec2(source.at));
}
