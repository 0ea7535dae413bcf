#version 450
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "composite.glsl"

layout(location = 0) out vec4 color;

void main() {
  color = color_of(source_of_pixel());
}
