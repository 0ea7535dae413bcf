#include "runtime/scene/import/gltf/primitive.h"

#include <algorithm>

#include "runtime/math/sh.h"
#include "runtime/scene/gltf_format.h"

namespace voyager::gltf {
namespace {

constexpr const char* kSpz[] = {kSpz1, kSpz2};
constexpr size_t kLookedAt = 4096;  // Gaussians, for a negative scale

using Components = std::initializer_list<Component>;

class Attributes {
 public:
  Attributes(File& file, const JsonValue& json, Primitive& primitive)
      : file_(file), json_(json), primitive_(primitive) {}

  bool has(const std::string& name) const { return json_.has(name); }

  void add(Parameter parameter, const std::string& name, size_t width, Components allowed,
           size_t k = 0) {
    const JsonValue index = json_[name];
    const Accessor accessor = read_accessor(file_, index);
    if (accessor.width != width)
      index.refuse("elements of " + std::to_string(accessor.width), std::to_string(width));
    if (std::find(allowed.begin(), allowed.end(), accessor.component) == allowed.end())
      index.refuse("componentType " + std::to_string(static_cast<uint32_t>(accessor.component)),
                   "one that " + name + " may have");
    const bool integer_share =
        accessor.component == Component::u8 || accessor.component == Component::u16;
    if (integer_share && parameter != Parameter::position && !accessor.normalised)
      index.refuse("integers that are not normalized", "normalized ones");
    require_count(index, accessor.count);
    primitive_.attributes.push_back({parameter, k, accessor});
  }

  void require_count(const JsonValue& index, uint64_t count) const {
    if (count != primitive_.count)
      index.refuse(std::to_string(count) + " elements",
                   std::to_string(primitive_.count) + ", as POSITION has");
  }

  // COLOR_0 is a colour of three or four.
  void add_colour(Parameter parameter, size_t least_width) {
    const JsonValue index = json_["COLOR_0"];
    const size_t width = read_accessor(file_, index).width;
    if (width < least_width || width > 4)
      index.refuse("elements of " + std::to_string(width),
                   std::to_string(least_width) + (least_width == 4 ? "" : " or 4"));
    add(parameter, "COLOR_0", width, {Component::f32, Component::u8, Component::u16});
  }

 private:
  File& file_;
  const JsonValue& json_;
  Primitive& primitive_;
};

std::string named(const std::string& attribute) {
  return std::string(kSplatting) + ":" + attribute;
}

std::string sh_name(int degree, int n) {
  return named("SH_DEGREE_" + std::to_string(degree) + "_COEF_" + std::to_string(n));
}

void add_sh(Attributes& attributes, Primitive& primitive) {
  if (!attributes.has(sh_name(0, 0))) return attributes.add_colour(Parameter::colour, 3);
  size_t k = 0;
  for (int degree = 0; degree <= kMaxShDegree && attributes.has(sh_name(degree, 0)); ++degree) {
    primitive.sh_degree = degree;
    for (int n = 0; n <= 2 * degree; ++n, ++k)
      attributes.add(Parameter::sh, sh_name(degree, n), 3, {Component::f32}, k);
  }
}

void read_attributes(File& file, const JsonValue& json, Primitive& primitive) {
  Attributes attributes(file, json, primitive);
  primitive.count = read_accessor(file, json["POSITION"]).count;
  attributes.add(Parameter::position, "POSITION", 3,
                 {Component::f32, Component::i8, Component::u8, Component::i16, Component::u16});
  attributes.add(Parameter::rotation, named("ROTATION"), 4,
                 {Component::f32, Component::i8, Component::i16});
  attributes.add(Parameter::scale, named("SCALE"), 3,
                 {Component::f32, Component::i8, Component::i16});
  // Drafts had the opacity in COLOR_0 alone.
  if (attributes.has(named("OPACITY")) || !attributes.has("COLOR_0"))
    attributes.add(Parameter::opacity, named("OPACITY"), 1,
                   {Component::f32, Component::u8, Component::u16});
  else
    attributes.add_colour(Parameter::colour_opacity, 4);
  add_sh(attributes, primitive);
}

// A .spz says itself what it has.
void read_spz(File& file, SpzViews& views, const JsonValue& json, const JsonValue& view,
              Primitive& primitive) {
  Spz& spz = views.open(file, view, primitive.place);
  primitive.spz = spz.source;
  primitive.count = spz.header.count;
  primitive.sh_degree = spz.header.sh_degree;
  primitive.native = spz.header.native();
  if (!json.has("attributes") || !json["attributes"].has("POSITION")) {
    primitive.spz_to_inria = axes_of(spz, nullptr);
    return;
  }
  const JsonValue index = json["attributes"]["POSITION"];
  const JsonValue position = file.json()["accessors"][index.whole(kMostIndex)];
  const uint64_t count = position["count"].whole(UINT64_MAX);
  if (count != primitive.count)
    index.refuse(std::to_string(count) + " elements",
                 std::to_string(primitive.count) + ", the Gaussians of its SPZ");
  primitive.spz_to_inria = axes_of(spz, &position);
}

// The view of a .spz, where the numbers are compressed.
std::optional<JsonValue> spz_view(const JsonValue& extension) {
  if (!extension.has("extensions")) return std::nullopt;
  for (const char* name : kSpz)
    if (extension["extensions"].has(name)) return extension["extensions"][name]["bufferView"];
  return std::nullopt;
}

struct Signs {
  bool negative = false, zero = false, positive = false;
};

void look_at(const Accessor& scales, Signs& signs) {
  if (scales.count == 0) return;
  const auto looked_at = static_cast<size_t>(std::min<uint64_t>(scales.count, kLookedAt));
  std::vector<std::byte> bytes(scales.span_of(looked_at));
  scales.read(0, bytes);
  for (size_t i = 0; i < looked_at; ++i)
    for (size_t axis = 0; axis < 3; ++axis) {
      const double scale = scales.number(std::span(bytes).subspan(i * scales.stride), axis);
      if (scale < 0) signs.negative = true;
      if (scale == 0) signs.zero = true;
      if (scale > 0) signs.positive = true;
    }
}

}  // namespace

std::optional<Primitive> read_primitive(File& file, SpzViews& views, const JsonValue& json) {
  if (!json.has("extensions") || !json["extensions"].has(kSplatting)) return std::nullopt;
  const JsonValue extension = json["extensions"][kSplatting];
  if (json.has("mode") && json["mode"].whole(kMostIndex) != 0) json["mode"].refuse("0 (POINTS)");
  Primitive primitive;
  primitive.place = json.place();
  primitive.linear_colours =
      extension.has("colorSpace") && extension["colorSpace"].text() == "lin_rec709_display";
  if (const auto view = spz_view(extension))
    read_spz(file, views, json, *view, primitive);
  else
    read_attributes(file, json["attributes"], primitive);
  return primitive;
}

bool have_log_scales(const std::vector<Primitive>& primitives) {
  Signs signs;
  for (const Primitive& primitive : primitives)
    for (const Attribute& attribute : primitive.attributes)
      if (attribute.parameter == Parameter::scale) look_at(attribute.accessor, signs);
  return signs.negative || (signs.zero && !signs.positive);
}

}  // namespace voyager::gltf
