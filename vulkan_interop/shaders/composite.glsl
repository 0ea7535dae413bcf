// An image of a ring over the host's, pixel by pixel.
layout(set = 0, binding = 0) uniform texture2DArray color_image;
layout(set = 0, binding = 1) uniform texture2DArray depth_image;

layout(push_constant) uniform Push {
  ivec2 first;  // pixel of the attachment where the image begins
  int layer;
  float slope, inverse_far;  // the host's depth encoding, as runtime/math/host_depth.h has it
  float far_code;            // the depth of the far plane
} push;

// The attachment encodes what it is given, so code values are decoded first.
layout(constant_id = 0) const bool kDecode = false;

ivec3 image_pixel() {
  return ivec3(ivec2(gl_FragCoord.xy) - push.first, push.layer);
}

vec3 decode(vec3 code) {
  return mix(pow((code + 0.055) / 1.055, vec3(2.4)), code / 12.92,
             lessThanEqual(code, vec3(0.04045)));
}

vec4 image_color() {
  const vec4 color = texelFetch(color_image, image_pixel(), 0);
  if (!kDecode || color.a <= 0.0) return color;
  return vec4(decode(max(color.rgb / color.a, 0.0)) * color.a, color.a);
}
