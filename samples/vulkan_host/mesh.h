#pragma once
// A glTF scene as one list of triangles: its nodes' transforms are applied, its materials
// are their base colours. Textures, skins and animations are left out.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace host {

struct Vertex {
  std::array<float, 3> position;
  std::array<float, 3> normal;
  std::array<float, 3> colour;  // linear
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;   // three a triangle, each below vertices.size()
  std::vector<std::string> files;  // that it was read from
};

// .gltf or .glb. Throws Failure(kRefusedInput) with file, place and what was expected.
Mesh read_mesh(const std::string& path);

}  // namespace host
