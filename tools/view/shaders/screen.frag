#version 450
#extension GL_EXT_samplerless_texture_functions : require
// Two pictures of code values, one on either side of a line, in another exposure.

layout(set = 0, binding = 0) uniform texture2DArray left_image;
layout(set = 0, binding = 1) uniform texture2DArray right_image;

layout(push_constant) uniform Push {
  float split;     // pixel at which the right picture begins; beyond the width: nowhere
  float exposure;  // factor of light; 1 leaves code values as they are
} push;

// The attachment encodes what it is given, so that code values are decoded last.
layout(constant_id = 0) const bool kDecode = false;

layout(location = 0) out vec4 color;

vec3 decode(vec3 code) {
  return mix(pow((code + 0.055) / 1.055, vec3(2.4)), code / 12.92,
             lessThanEqual(code, vec3(0.04045)));
}

vec3 encode(vec3 light) {
  return mix(1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, light * 12.92,
             lessThanEqual(light, vec3(0.0031308)));
}

void main() {
  const ivec3 pixel = ivec3(ivec2(gl_FragCoord.xy), 0);
  const bool right = gl_FragCoord.x >= push.split;
  vec3 code = right ? texelFetch(right_image, pixel, 0).rgb : texelFetch(left_image, pixel, 0).rgb;
  if (push.exposure != 1.0)
    code = encode(clamp(decode(clamp(code, 0.0, 1.0)) * push.exposure, 0.0, 1.0));
  if (abs(gl_FragCoord.x - push.split) < 1.0) code = vec3(1.0);
  color = vec4(kDecode ? decode(clamp(code, 0.0, 1.0)) : code, 1.0);
}
