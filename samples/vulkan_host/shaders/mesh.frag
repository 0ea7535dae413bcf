#version 450
// A sun, and a sky that is brighter above. encode: into an attachment that holds
// display-referred code values and does not encode by itself.
layout(constant_id = 0) const bool encode = true;
layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 colour;
layout(location = 0) out vec4 out_colour;

const vec3 to_sun = normalize(vec3(0.4, 0.8, 0.45));

vec3 srgb(vec3 linear) {
  return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear,
             lessThanEqual(linear, vec3(0.0031308)));
}

void main() {
  vec3 n = normalize(normal);
  vec3 light = vec3(0.75) * max(dot(n, to_sun), 0.0) + mix(vec3(0.12), vec3(0.3), 0.5 + 0.5 * n.y);
  vec3 lit = clamp(colour * light, 0.0, 1.0);
  out_colour = vec4(encode ? srgb(lit) : lit, 1.0);
}
