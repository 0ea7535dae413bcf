#version 450
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "eye.glsl"

layout(location = 0) out vec4 color;

void main() {
  color = linear_color();
}
