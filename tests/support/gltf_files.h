#pragma once
// glTF files for tests, from clouds in INRIA axes.
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/support/sample_files.h"

namespace voyager::test {

using Json = nlohmann::json;

inline std::string khr(const std::string& attribute) {
  return "KHR_gaussian_splatting:" + attribute;
}

inline std::string base64(const Bytes& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? std::to_integer<uint32_t>(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

class GltfFile {
 public:
  Json json = {{"asset", {{"version", "2.0"}}},
               {"extensionsUsed", {"KHR_gaussian_splatting"}},
               {"scene", 0},
               {"scenes", {{{"nodes", Json::array()}}}},
               {"nodes", Json::array()},
               {"meshes", Json::array()},
               {"accessors", Json::array()},
               {"bufferViews", Json::array()}};
  Bytes binary;

  // Returns its index, as all below.
  size_t add_view(const Bytes& bytes, size_t stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4);
    Json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    binary.insert(binary.end(), bytes.begin(), bytes.end());
    return push("bufferViews", view);
  }

  template <class T>
  size_t add_accessor(const std::vector<T>& values, const std::string& type, int component,
                      bool normalised = false) {
    const size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
    Bytes bytes;
    for (const T value : values) put(bytes, value);
    Json accessor = {{"bufferView", add_view(bytes)},
                     {"componentType", component},
                     {"count", values.size() / width},
                     {"type", type}};
    if (normalised) accessor["normalized"] = true;
    return push("accessors", accessor);
  }
  size_t add_floats(const std::vector<float>& values, const std::string& type) {
    return add_accessor(values, type, 5126);
  }

  // A primitive of the cloud's Gaussians.
  Json primitive_of(const GaussianCloud& cloud);

  size_t add_mesh(const Json& primitives) { return push("meshes", {{"primitives", primitives}}); }
  // A root, or a child of `parent`.
  size_t add_node(Json node, int parent = -1) {
    const size_t index = push("nodes", std::move(node));
    if (parent < 0)
      json["scenes"][0]["nodes"].push_back(index);
    else
      json["nodes"][static_cast<size_t>(parent)]["children"].push_back(index);
    return index;
  }

  Bytes glb() const {
    Json with_buffer = json;
    with_buffer["buffers"] = {{{"byteLength", binary.size()}}};
    return glb_of(with_buffer.dump(), binary);
  }
  // With the buffer at `uri`, or inside.
  Bytes gltf(const std::string& uri = "") const {
    Json with_buffer = json;
    with_buffer["buffers"] = {
        {{"byteLength", binary.size()},
         {"uri", uri.empty() ? "data:application/octet-stream;base64," + base64(binary) : uri}}};
    return bytes_of(with_buffer.dump());
  }

  static Bytes glb_of(std::string text, Bytes binary) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    Bytes bytes;
    put<uint32_t>(bytes, 0x46546c67);
    put<uint32_t>(bytes, 2);
    put<uint32_t>(bytes, static_cast<uint32_t>(28 + text.size() + binary.size()));
    put<uint32_t>(bytes, static_cast<uint32_t>(text.size()));
    put<uint32_t>(bytes, 0x4e4f534a);
    const Bytes chunk = bytes_of(text);
    bytes.insert(bytes.end(), chunk.begin(), chunk.end());
    put<uint32_t>(bytes, static_cast<uint32_t>(binary.size()));
    put<uint32_t>(bytes, 0x004e4942);
    bytes.insert(bytes.end(), binary.begin(), binary.end());
    return bytes;
  }

 private:
  size_t push(const char* list, Json entry) {
    json[list].push_back(std::move(entry));
    return json[list].size() - 1;
  }
};

inline Json GltfFile::primitive_of(const GaussianCloud& cloud) {
  std::vector<float> position, rotation, scale, opacity;
  for (size_t i = 0; i < cloud.size(); ++i) {
    const float *p = &cloud.position[3 * i], *q = &cloud.rotation[4 * i];
    position.insert(position.end(), {-p[0], -p[1], p[2]});
    rotation.insert(rotation.end(), {-q[2], q[1], q[0], -q[3]});  // the half turn back, x y z w
    for (size_t k = 0; k < 3; ++k) scale.push_back(std::exp(cloud.log_scale[3 * i + k]));
    opacity.push_back(sigmoid(cloud.opacity[i]));
  }
  Json attributes = {{"POSITION", add_floats(position, "VEC3")},
                     {khr("ROTATION"), add_floats(rotation, "VEC4")},
                     {khr("SCALE"), add_floats(scale, "VEC3")},
                     {khr("OPACITY"), add_floats(opacity, "SCALAR")}};
  const size_t coefficients = static_cast<size_t>(cloud.coefficients());
  size_t k = 0;
  for (int degree = 0; degree <= cloud.sh_degree; ++degree)
    for (int n = 0; n <= 2 * degree; ++n, ++k) {
      std::vector<float> values;  // m = n - degree; the half turn is (-1)^m
      for (size_t i = 0; i < cloud.size(); ++i)
        for (size_t c = 0; c < 3; ++c)
          values.push_back(cloud.sh[(i * coefficients + k) * 3 + c] *
                           ((n - degree) % 2 == 0 ? 1.0f : -1.0f));
      attributes[khr("SH_DEGREE_" + std::to_string(degree) + "_COEF_" + std::to_string(n))] =
          add_floats(values, "VEC3");
    }
  return {{"attributes", attributes},
          {"mode", 0},
          {"extensions",
           {{"KHR_gaussian_splatting",
             {{"kernel", "ellipse"}, {"colorSpace", "srgb_rec709_display"}}}}}};
}

// One mesh of the cloud, one node that is `node` beside it.
inline GltfFile gltf_of(const GaussianCloud& cloud, Json node = Json::object()) {
  GltfFile file;
  node["mesh"] = file.add_mesh(Json::array({file.primitive_of(cloud)}));
  file.add_node(node);
  return file;
}

// Calls `visit` with each place of the document, as a JSON pointer.
inline void for_places(const Json& json, const Json::json_pointer& at,
                       const std::function<void(const Json::json_pointer&)>& visit) {
  if (json.is_object())
    for (const auto& [key, value] : json.items()) for_places(value, at / key, visit);
  if (json.is_array())
    for (size_t i = 0; i < json.size(); ++i) for_places(json[i], at / i, visit);
  visit(at);
}

// The document without each of its fields, and with absurd values in its place.
inline void for_bad_fields(const Json& good,
                           const std::function<void(const Json&, const std::string&)>& visit) {
  const std::vector<Json> absurd = {nullptr,
                                    true,
                                    -1,
                                    0,
                                    1,
                                    3.5,
                                    1e300,
                                    4294967295u,
                                    UINT64_MAX,
                                    "x",
                                    Json::array(),
                                    Json::object(),
                                    Json::array({0, 0, 0, 0})};
  for_places(good, Json::json_pointer(""), [&](const Json::json_pointer& at) {
    if (at.empty()) return;
    Json without = good;
    Json& parent = without[at.parent_pointer()];
    if (parent.is_object())
      parent.erase(at.back());
    else
      parent.erase(std::stoul(at.back()));
    visit(without, at.to_string());
    for (const Json& value : absurd) {
      Json changed = good;
      changed[at] = value;
      visit(changed, at.to_string() + " " + value.dump());
    }
  });
}

inline GaussianCloud import_source(const Bytes& bytes) {
  return import_gaussians(std::make_shared<MemorySource>("sample.glb", bytes));
}

}  // namespace voyager::test
