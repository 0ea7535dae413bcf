#include "runtime/scene/import/rad/property.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace voyager::rad {
namespace {

struct NamedEncoding {
  std::string_view name;
  Planes planes;  // of one number; of oct88r8 of all
  bool has_min, has_max;
};
// In the order of Encoding.
constexpr NamedEncoding kEncodings[] = {
    {"f32", {1, 4}, false, false},
    {"f16", {1, 2}, false, false},
    {"f32_lebytes", {4, 1}, false, false},
    {"f16_lebytes", {2, 1}, false, false},
    {"r8", {1, 1}, true, true},
    {"r8_delta", {1, 1}, true, true},
    {"s8", {1, 1}, false, true},
    {"s8_delta", {1, 1}, false, true},
    {"ln_0r8", {1, 1}, true, true},
    {"ln_f16", {1, 2}, false, false},
    {"oct88r8", {1, 3}, false, false},
    {"u16", {1, 2}, false, false},
    {"u32", {1, 4}, false, false},
};

constexpr uint32_t bits() {
  return 0;
}
template <class... More>
constexpr uint32_t bits(Encoding one, More... more) {
  return 1u << static_cast<int>(one) | bits(more...);
}

struct NamedKind {
  std::string_view name;
  size_t numbers;
  uint32_t encodings;
};
using enum Encoding;
constexpr uint32_t kSh = bits(f32, f16, r8, r8_delta, s8, s8_delta);
// In the order of Kind.
constexpr NamedKind kNames[kKinds] = {
    {"center", 3, bits(f32, f16, f32_lebytes, f16_lebytes)},
    {"alpha", 1, bits(f32, f16, r8)},
    {"rgb", 3, bits(f32, f16, r8, r8_delta)},
    {"scales", 3, bits(f32, ln_0r8, ln_f16)},
    {"orientation", 3, bits(f32, f16, oct88r8)},
    {"sh1", 9, kSh},
    {"sh2", 15, kSh},
    {"sh3", 21, kSh},
    {"child_count", 1, bits(u16)},
    {"child_start", 1, bits(u32)},
};

bool is_expected(size_t kind, int sh_degree, bool is_tree) {
  const auto of = static_cast<Kind>(kind);
  if (of >= Kind::child_count) return is_tree;
  return of < Kind::sh1 || static_cast<int>(kind) - static_cast<int>(Kind::sh1) < sh_degree;
}

bool is_of_a_table(std::string_view name) {
  return name == "sh1_code" || name == "sh2_code" || name == "sh3_code" || name == "sh_label";
}

size_t kind_of(const JsonValue& name, int sh_degree, bool is_tree) {
  const auto* found = std::find_if(std::begin(kNames), std::end(kNames),
                                   [&](const NamedKind& row) { return row.name == name.text(); });
  const auto kind = static_cast<size_t>(found - kNames);
  if (is_of_a_table(name.text()))
    name.refuse("SH bands for each Gaussian: tables of SH (sh*_code, sh_label) are not read");
  if (kind == kKinds || !is_expected(kind, sh_degree, is_tree))
    name.refuse(kind == kKinds ? "a property that Spark's source has (commit 37bb7da)"
                               : "none that maxSh and lodTree leave out");
  return kind;
}

Encoding encoding_of(const JsonValue& name, size_t kind) {
  std::string expected;
  for (size_t i = 0; i < std::size(kEncodings); ++i) {
    if ((kNames[kind].encodings >> i & 1) == 0) continue;
    if (kEncodings[i].name == name.text()) return static_cast<Encoding>(i);
    expected += (expected.empty() ? "" : ", ") + std::string(kEncodings[i].name);
  }
  name.refuse("an encoding of " + std::string(kNames[kind].name) + ": " + expected);
}

float bound(const JsonValue& value) {
  const double bound = value.number();
  if (std::fabs(bound) > std::numeric_limits<float>::max()) value.refuse("a number of 32 bits");
  return static_cast<float>(bound);
}

Property property_of(const JsonValue& json, size_t kind, uint64_t payload) {
  Property property;
  property.kind = static_cast<Kind>(kind);
  property.encoding = encoding_of(json["encoding"], kind);
  const NamedEncoding& encoding = kEncodings[static_cast<size_t>(property.encoding)];
  if (encoding.has_min) property.min = bound(json["min"]);
  if (encoding.has_max) property.max = bound(json["max"]);
  property.is_deflated = json.has("compression");
  if (property.is_deflated && json["compression"].text() != "gz")
    json["compression"].refuse("\"gz\" (raw deflate), or no compression");
  property.offset = json["offset"].whole(payload);
  property.bytes = json["bytes"].whole(payload - property.offset);
  return property;
}

}  // namespace

size_t numbers_of(Kind kind) {
  return kNames[static_cast<size_t>(kind)].numbers;
}

Planes planes_of(const Property& property) {
  Planes planes = kEncodings[static_cast<size_t>(property.encoding)].planes;
  if (property.encoding != oct88r8) planes.count *= numbers_of(property.kind);
  return planes;
}

Properties read_properties(const JsonValue& json, int sh_degree, bool is_tree, uint64_t payload) {
  Properties properties;
  for (size_t i = 0; i < json.size(); ++i) {
    const JsonValue name = json[i]["property"];
    const size_t kind = kind_of(name, sh_degree, is_tree);
    if (properties[kind]) name.refuse("each property once");
    properties[kind] = property_of(json[i], kind, payload);
  }
  for (size_t kind = 0; kind < kKinds; ++kind)
    if (is_expected(kind, sh_degree, is_tree) && !properties[kind])
      json.refuse("no property " + std::string(kNames[kind].name), "one");
  return properties;
}

}  // namespace voyager::rad
