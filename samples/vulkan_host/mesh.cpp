#include "mesh.h"

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <utility>

#include "failure.h"
#include "gltf_file.h"

namespace host {
namespace {

// Elements of an accessor, checked to lie in its buffer.
struct Elements {
  const unsigned char* first;
  size_t count, stride;
};

class Reader {
 public:
  Reader(const std::string& path, const tinygltf::Model& model)
      : path_(path), model_(model), seen_(model.nodes.size()) {}

  Mesh read() {
    if (model_.scenes.empty()) refuse("scenes", "one at least");
    const size_t scene = model_.defaultScene < 0 ? 0 : static_cast<size_t>(model_.defaultScene);
    for (const int node : at(model_.scenes, scene, "scene").nodes) add_tree(node);
    if (mesh_.indices.empty()) refuse("scene", "a triangle at least");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& expected) const {
    throw Failure(kRefusedInput, path_ + ": " + place + ": expected " + expected);
  }
  template <class T>
  const T& at(const std::vector<T>& items, size_t index, const char* what) const {
    if (index >= items.size()) refuse(what, "an index below " + std::to_string(items.size()));
    return items[index];
  }

  static glm::dmat4 transform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
    glm::dmat4 m(1);
    if (node.translation.size() == 3)
      m = glm::translate(m, glm::make_vec3(node.translation.data()));
    if (node.rotation.size() == 4) {
      const auto& q = node.rotation;
      m = m * glm::mat4_cast(glm::dquat(q[3], q[0], q[1], q[2]));
    }
    if (node.scale.size() == 3) m = glm::scale(m, glm::make_vec3(node.scale.data()));
    return m;
  }

  // As deep as it may be; children in their order.
  void add_tree(int root) {
    std::vector<std::pair<int, glm::dmat4>> next = {{root, glm::dmat4(1)}};
    while (!next.empty()) {
      const auto [index, parent] = next.back();
      next.pop_back();
      const tinygltf::Node& node = at(model_.nodes, static_cast<size_t>(index), "node");
      if (seen_[static_cast<size_t>(index)]) refuse("nodes", "trees");
      seen_[static_cast<size_t>(index)] = true;
      const glm::dmat4 world = parent * transform(node);
      if (node.mesh >= 0)
        for (const tinygltf::Primitive& primitive :
             at(model_.meshes, static_cast<size_t>(node.mesh), "mesh").primitives)
          add_primitive(primitive, world);
      for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
        next.emplace_back(*child, world);
    }
  }

  void add_primitive(const tinygltf::Primitive& primitive, const glm::dmat4& world) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1) return;
    const auto positions = attribute(primitive, "POSITION");
    if (!positions) refuse("primitive", "POSITION");
    const auto normals = attribute(primitive, "NORMAL");
    if (normals && normals->count != positions->count) refuse("NORMAL", "as many as POSITION");
    const std::array<float, 3> colour = base_colour(primitive.material);
    const glm::dmat3 normal_matrix = glm::inverseTranspose(glm::dmat3(world));
    const size_t first = mesh_.vertices.size(), first_index = mesh_.indices.size();
    for (size_t i = 0; i < positions->count; ++i) {
      const glm::dvec3 p = world * glm::dvec4(vector(*positions, i), 1);
      const glm::dvec3 n = normals ? normal_matrix * vector(*normals, i) : glm::dvec3(0);
      mesh_.vertices.push_back(
          {narrow(p), narrow(glm::length(n) > 0 ? glm::normalize(n) : n), colour});
    }
    add_indices(primitive, first, positions->count);
    if (!normals) add_face_normals(first_index);
  }

  void add_indices(const tinygltf::Primitive& primitive, size_t first, size_t count) {
    const size_t begin = mesh_.indices.size();
    if (primitive.indices < 0) {
      for (size_t i = 0; i < count; ++i) mesh_.indices.push_back(static_cast<uint32_t>(first + i));
    } else {
      const tinygltf::Accessor& accessor =
          at(model_.accessors, static_cast<size_t>(primitive.indices), "indices");
      const Elements elements = open(accessor, TINYGLTF_TYPE_SCALAR);
      for (size_t i = 0; i < elements.count; ++i) {
        const size_t index = index_at(accessor.componentType, elements, i);
        if (index >= count) refuse("indices", "each below " + std::to_string(count));
        mesh_.indices.push_back(static_cast<uint32_t>(first + index));
      }
    }
    if ((mesh_.indices.size() - begin) % 3 != 0) refuse("primitive", "three indices a triangle");
  }

  size_t index_at(int component, const Elements& elements, size_t i) const {
    const unsigned char* from = elements.first + i * elements.stride;
    uint32_t whole = 0;
    uint16_t half = 0;
    switch (component) {
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return *from;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        std::memcpy(&half, from, sizeof half);
        return half;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        std::memcpy(&whole, from, sizeof whole);
        return whole;
      default:
        refuse("indices", "unsigned integers");
    }
  }

  // Of the last primitive's vertices, which came without: the sum over their triangles.
  void add_face_normals(size_t first_index) {
    const auto point = [&](size_t i) { return glm::make_vec3(mesh_.vertices[i].position.data()); };
    for (size_t i = first_index; i + 2 < mesh_.indices.size(); i += 3) {
      const uint32_t* corner = &mesh_.indices[i];
      const glm::vec3 origin = point(corner[0]);
      const glm::vec3 normal = glm::cross(point(corner[1]) - origin, point(corner[2]) - origin);
      for (int c = 0; c < 3; ++c)
        for (int axis = 0; axis < 3; ++axis)
          mesh_.vertices[corner[c]].normal[static_cast<size_t>(axis)] += normal[axis];
    }
  }

  std::array<float, 3> base_colour(int material) const {
    if (material < 0) return {0.8f, 0.8f, 0.8f};
    const auto& factor = at(model_.materials, static_cast<size_t>(material), "material")
                             .pbrMetallicRoughness.baseColorFactor;
    if (factor.size() != 4) return {1, 1, 1};
    return {static_cast<float>(factor[0]), static_cast<float>(factor[1]),
            static_cast<float>(factor[2])};
  }

  std::optional<Elements> attribute(const tinygltf::Primitive& primitive, const char* name) const {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return std::nullopt;
    const tinygltf::Accessor& accessor =
        at(model_.accessors, static_cast<size_t>(found->second), name);
    if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) refuse(name, "floats");
    return open(accessor, TINYGLTF_TYPE_VEC3);
  }

  Elements open(const tinygltf::Accessor& accessor, int type) const {
    if (accessor.type != type || accessor.sparse.isSparse)
      refuse("accessor", "dense, three numbers a vertex or one an index");
    const tinygltf::BufferView& view =
        at(model_.bufferViews, static_cast<size_t>(accessor.bufferView), "bufferView");
    const auto& bytes = at(model_.buffers, static_cast<size_t>(view.buffer), "buffer").data;
    const int component =
        tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    const int stride = accessor.ByteStride(view);
    if (component <= 0 || stride <= 0) refuse("accessor", "a type and stride that glTF knows");
    const size_t element = static_cast<size_t>(component) * (type == TINYGLTF_TYPE_VEC3 ? 3 : 1);
    const size_t step = static_cast<size_t>(stride);
    const size_t begin = view.byteOffset + accessor.byteOffset;
    if (accessor.count == 0 || begin > bytes.size() || element > bytes.size() - begin ||
        accessor.count - 1 > (bytes.size() - begin - element) / step)
      refuse("accessor", "elements inside its buffer");
    return {bytes.data() + begin, accessor.count, step};
  }

  glm::dvec3 vector(const Elements& elements, size_t i) const {
    float v[3];
    std::memcpy(v, elements.first + i * elements.stride, sizeof v);
    for (const float x : v)
      if (!std::isfinite(x)) refuse("accessor", "finite numbers");
    return {v[0], v[1], v[2]};
  }
  static std::array<float, 3> narrow(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  }

  const std::string& path_;
  const tinygltf::Model& model_;
  std::vector<bool> seen_;  // nodes: each has one parent at most
  Mesh mesh_;
};

}  // namespace

Mesh read_mesh(const std::string& path) {
  std::vector<std::string> files;
  const tinygltf::Model model = read_gltf(path, files);
  Mesh mesh = Reader(path, model).read();
  mesh.files = std::move(files);
  return mesh;
}

}  // namespace host
