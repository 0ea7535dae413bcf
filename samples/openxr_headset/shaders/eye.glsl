// An eye's layer of Voyager's image into the swapchain's, pixel by pixel.
layout(set = 0, binding = 0) uniform texture2DArray color_image;

layout(push_constant) uniform Push {
  layout(offset = 16) int layer;
  float a, b;  // of the depth a + b / z that the compositor is told of
} push;

ivec3 image_pixel() {
  return ivec3(ivec2(gl_FragCoord.xy), push.layer);
}

// Voyager's colours are code values. A compositor reads linear light: from an _SRGB format it
// decodes, and writing to one encodes, so that code values come out; others hold light as it is.
vec4 linear_color() {
  const vec3 code = texelFetch(color_image, image_pixel(), 0).rgb;
  return vec4(mix(pow((code + 0.055) / 1.055, vec3(2.4)), code / 12.92,
                  lessThanEqual(code, vec3(0.04045))),
              1.0);
}
