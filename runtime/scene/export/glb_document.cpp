#include "runtime/scene/export/glb_document.h"

#include <charconv>

#include "runtime/math/sh.h"

namespace voyager::glb {
namespace {

constexpr int kFloat = 5126, kArrayBuffer = 34962;  // numbers of glTF

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

std::string views(const Document& document, const std::vector<Attribute>& all) {
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
    std::string text = R"({"bufferView":)" + number(i) + R"(,"componentType":)" + number(kFloat) +
                       R"(,"count":)" + number(document.count) + R"(,"type":")" +
                       type_of(all[i].components) + "\"";
    if (i == 0)
      text += R"(,"min":)" + numbers(document.least) + R"(,"max":)" + numbers(document.most);
    return text + "}";
  });
}

}  // namespace

std::vector<Attribute> attributes(int sh_degree) {
  const std::string extension = "KHR_gaussian_splatting:";
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
  const std::vector<Attribute> all = attributes(document.sh_degree);
  uint64_t bytes = 0;
  for (const Attribute& attribute : all)
    bytes += document.count * attribute.components * sizeof(float);
  const std::string semantics =
      list(all.size(), [&](size_t i) { return "\"" + all[i].semantic + "\":" + number(i); });
  return R"({"asset":{"version":"2.0","generator":"Voyager"},)"
         R"("extensionsUsed":["KHR_gaussian_splatting"],"scene":0,"scenes":[{"nodes":[0]}],)"
         R"("nodes":[{"mesh":0,"translation":)" +
         numbers(document.translation) + R"(}],"meshes":[{"primitives":[{"mode":0,"attributes":{)" +
         semantics +
         R"(},"extensions":{"KHR_gaussian_splatting":{"kernel":"ellipse",)"
         R"("colorSpace":"srgb_rec709_display"}}}]}],"buffers":[{"byteLength":)" +
         number(bytes) + R"(}],"bufferViews":[)" + views(document, all) + R"(],"accessors":[)" +
         accessors(document, all) + "]}";
}

}  // namespace voyager::glb
