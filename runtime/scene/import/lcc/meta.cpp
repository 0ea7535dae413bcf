#include "runtime/scene/import/lcc/meta.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/json_value.h"
#include "runtime/scene/import/lcc/index.h"

namespace voyager::lcc {
namespace {

constexpr int kJsonLevels = 16;       // in one another; scenes take 4
constexpr uint64_t kMostLevels = 64;  // of detail, each some half of the one before

std::array<float, 3> three(const JsonValue& field) {
  std::array<double, 3> values{};
  field.numbers(values);
  std::array<float, 3> floats{};
  for (size_t i = 0; i < 3; ++i) {
    if (std::fabs(values[i]) > std::numeric_limits<float>::max())
      field[i].refuse("a number of 32 bits");
    floats[i] = static_cast<float>(values[i]);
  }
  return floats;
}

// Attributes of other names may have other numbers of values.
std::optional<Bounds> bounds_of(const JsonValue& attributes, const std::string& name) {
  for (size_t i = 0; i < attributes.size(); ++i) {
    const JsonValue attribute = attributes[i];
    if (attribute["name"].text() == name)
      return Bounds{three(attribute["min"]), three(attribute["max"])};
  }
  return std::nullopt;
}

void check_version(const JsonValue& version) {
  const std::string& text = version.text();
  if (text.empty() || text[0] < '2' || text[0] > '5' || (text.size() > 1 && text[1] != '.'))
    version.refuse("2 to 5");
}

bool is_all(const JsonValue& json, const char* field, float value) {
  if (!json.has(field)) return true;
  const std::array<float, 3> values = three(json[field]);
  return std::all_of(values.begin(), values.end(), [&](float v) { return v == value; });
}

// No scene is known that has them, and nothing says in which order they apply.
void check_placement(const JsonValue& json) {
  if (!is_all(json, "shift", 0)) json["shift"].refuse("other numbers", "0, 0, 0");
  if (!is_all(json, "scale", 1)) json["scale"].refuse("other numbers", "1, 1, 1");
}

std::optional<bool> has_sh(const JsonValue& json) {
  if (!json.has("fileType")) return std::nullopt;
  const JsonValue type = json["fileType"];
  if (type.text() != "Quality" && type.text() != "Portable")
    type.refuse("\"Portable\" or \"Quality\"");
  return type.text() == "Quality";
}

}  // namespace

Meta read_meta(const ByteSource& lcc) {
  const std::vector<std::byte> bytes = read_all(lcc);
  const nlohmann::json parsed = parse_json(
      lcc.name(), 0, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, kJsonLevels);
  const JsonValue json(lcc.name(), 0, parsed);
  check_version(json["version"]);
  if (json.has("encoding") && json["encoding"].text() != "COMPRESS")
    json["encoding"].refuse("\"COMPRESS\"");
  check_placement(json);
  Meta meta;
  meta.levels = json["totalLevel"].whole(kMostLevels, 1);
  const uint64_t cell = bytes_of_cell(meta.levels);
  json["indexDataSize"].whole(cell, cell);
  meta.has_sh = has_sh(json);
  const JsonValue attributes = json["attributes"];
  meta.scale = bounds_of(attributes, "scale");
  meta.sh = bounds_of(attributes, "shcoef");
  meta.environment_scale = bounds_of(attributes, "envscale");
  meta.environment_sh = bounds_of(attributes, "envshcoef");
  meta.is_on_earth = !is_all(json, "offset", 0);
  return meta;
}

}  // namespace voyager::lcc
