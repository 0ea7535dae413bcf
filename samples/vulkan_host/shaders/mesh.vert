#version 450
// A mesh's vertex. The normal and the light stay in the mesh's own axes.
layout(push_constant) uniform Draw { mat4 clip_from_mesh; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
layout(location = 0) out vec3 out_normal;
layout(location = 1) out vec3 out_colour;

void main() {
  gl_Position = clip_from_mesh * vec4(position, 1.0);
  out_normal = normal;
  out_colour = colour;
}
