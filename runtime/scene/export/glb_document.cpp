#include "runtime/scene/export/glb_document.h"

#include <charconv>

#include "runtime/math/sh.h"
#include "runtime/scene/gltf_format.h"

namespace voyager::glb {
namespace {

constexpr int kByte = 5121, kFloat = 5126, kArrayBuffer = 34962;  // numbers of glTF
constexpr const char* kColour = "COLOR_0";

// The shortest that is read as the same number, whatever the locale.
template <class T>
std::string number(T value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

template <class T>
std::string numbers(const std::array<T, 3>& values) {
  return "[" + number(values[0]) + "," + number(values[1]) + "," + number(values[2]) + "]";
}

// For each attribute `item(index)`, with commas between.
template <class Item>
std::string list(size_t count, const Item& item) {
  std::string text;
  for (size_t i = 0; i < count; ++i) text += (i == 0 ? "" : ",") + item(i);
  return text;
}

const char* type_of(size_t components) {
  return components == 1 ? "SCALAR" : components == 3 ? "VEC3" : "VEC4";
}

std::string place(const Document& document) {
  const auto& at = document.translation;
  if (!document.spz_bytes) return R"("translation":)" + numbers(at);
  return R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,)" + number(at[0]) + "," + number(at[1]) + "," +
         number(at[2]) + ",1]";
}

// What the draft of compression by SPZ maps its numbers to.
std::vector<Attribute> spz_attributes(int sh_degree) {
  std::vector<Attribute> all = {{"POSITION", 3}, {kColour, 4}};
  for (const Attribute& attribute : attributes(sh_degree))
    if (attribute.semantic.find("ROTATION") != std::string::npos ||
        attribute.semantic.find("SCALE") != std::string::npos ||
        (attribute.semantic.find("SH_DEGREE_") != std::string::npos &&
         attribute.semantic.find("SH_DEGREE_0") == std::string::npos))
      all.push_back(attribute);
  return all;
}

uint64_t binary_bytes(const Document& document, const std::vector<Attribute>& all) {
  if (document.spz_bytes) return *document.spz_bytes;
  uint64_t bytes = 0;
  for (const Attribute& attribute : all)
    bytes += document.count * attribute.components * sizeof(float);
  return bytes;
}

std::string views(const Document& document, const std::vector<Attribute>& all) {
  if (document.spz_bytes)
    return R"({"buffer":0,"byteOffset":0,"byteLength":)" + number(*document.spz_bytes) + "}";
  uint64_t offset = 0;
  return list(all.size(), [&](size_t i) {
    const uint64_t bytes = document.count * all[i].components * sizeof(float);
    offset += bytes;
    return R"({"buffer":0,"byteOffset":)" + number(offset - bytes) + R"(,"byteLength":)" +
           number(bytes) + R"(,"target":)" + number(kArrayBuffer) + "}";
  });
}

std::string accessors(const Document& document, const std::vector<Attribute>& all) {
  return list(all.size(), [&](size_t i) {
    const bool colour = all[i].semantic == kColour;
    std::string text = document.spz_bytes ? "{" : R"({"bufferView":)" + number(i) + ",";
    text += R"("componentType":)" + number(colour ? kByte : kFloat) +
            (colour ? R"(,"normalized":true)" : "") + R"(,"count":)" + number(document.count) +
            R"(,"type":")" + type_of(all[i].components) + "\"";
    if (i == 0)
      text += R"(,"min":)" + numbers(document.least) + R"(,"max":)" + numbers(document.most);
    return text + "}";
  });
}

}  // namespace

std::vector<Attribute> attributes(int sh_degree) {
  const std::string extension = std::string(gltf::kSplatting) + ":";
  std::vector<Attribute> all = {{"POSITION", 3},
                                {extension + "ROTATION", 4},
                                {extension + "SCALE", 3},
                                {extension + "OPACITY", 1}};
  for (int degree = 0; degree <= sh_degree; ++degree)
    for (int n = 0; n <= 2 * degree; ++n)
      all.push_back({extension + "SH_DEGREE_" + number(degree) + "_COEF_" + number(n), 3});
  return all;
}

std::string json(const Document& document) {
  const bool spz = document.spz_bytes.has_value();
  const std::vector<Attribute> all =
      spz ? spz_attributes(document.sh_degree) : attributes(document.sh_degree);
  const std::string semantics =
      list(all.size(), [&](size_t i) { return "\"" + all[i].semantic + "\":" + number(i); });
  const std::string used =
      spz ? R"(["KHR_gaussian_splatting",")" + std::string(gltf::kSpz2) + R"("])"
          : R"(["KHR_gaussian_splatting"])";
  return R"({"asset":{"version":"2.0","generator":"Voyager"},"extensionsUsed":)" + used +
         (spz ? R"(,"extensionsRequired":)" + used : "") +
         R"(,"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,)" + place(document) +
         R"(}],"meshes":[{"primitives":[{"mode":0,"attributes":{)" + semantics +
         R"(},"extensions":{"KHR_gaussian_splatting":{"kernel":"ellipse",)"
         R"("colorSpace":"srgb_rec709_display")" +
         (spz ? R"(,"extensions":{")" + std::string(gltf::kSpz2) + R"(":{"bufferView":0}})" : "") +
         R"(}}}]}],"buffers":[{"byteLength":)" + number(binary_bytes(document, all)) +
         R"(}],"bufferViews":[)" + views(document, all) + R"(],"accessors":[)" +
         accessors(document, all) + "]}";
}

}  // namespace voyager::glb
