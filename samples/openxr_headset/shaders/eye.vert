#version 450
// What is visible of an eye's image, as triangles: tangents of the view, or the whole.
layout(location = 0) in vec2 corner;

layout(push_constant) uniform Push {
  vec2 scale, offset;  // to clip space
} push;

void main() {
  gl_Position = vec4(corner * push.scale + push.offset, 0.0, 1.0);
}
