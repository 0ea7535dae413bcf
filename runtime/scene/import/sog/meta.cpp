#include "runtime/scene/import/sog/meta.h"

#include <algorithm>

#include "runtime/base/path_beside.h"
#include "runtime/math/byte_code.h"
#include "runtime/scene/import/json_value.h"

namespace voyager::sog {
namespace {

constexpr int kMetaLevels = 16;           // of JSON; scenes take 3
constexpr uint64_t kMostCount = 1 << 28;  // pixels of the largest WebP image, 16383 squared
constexpr uint64_t kMostCentroids = 1 << 16;

Table steps(double least, double most) {
  Table table{};
  for (uint32_t i = 0; i < table.size(); ++i)
    table[i] = between(static_cast<float>(least), static_cast<float>(most), i, 255);
  return table;
}

std::vector<double> numbers(const JsonValue& field, size_t count) {
  std::vector<double> values(count);
  field.numbers(values);
  return values;
}

Table codebook(const JsonValue& field) {
  const std::vector<double> values = numbers(field["codebook"], 256);
  Table table{};
  std::transform(values.begin(), values.end(), table.begin(),
                 [](double value) { return static_cast<float>(value); });
  return table;
}

std::array<double, 3> three(const JsonValue& field) {
  const std::vector<double> values = numbers(field, 3);
  return {values[0], values[1], values[2]};
}

void read_files(const JsonValue& json, Meta& meta) {
  const auto take = [&](const char* key, std::initializer_list<File> into) {
    const JsonValue names = json[key]["files"];
    if (names.size() != into.size()) names.refuse("the names of " + std::to_string(into.size()));
    size_t i = 0;
    for (const File file : into) {
      const JsonValue name = names[i++];
      if (!stays_in_folder(name.text())) name.refuse("the name of a file in the same folder");
      meta.files[file] = name.text();
    }
  };
  take("means", {kMeansLow, kMeansHigh});
  take("scales", {kScales});
  take("quats", {kQuats});
  take("sh0", {kColours});
  meta.has_sh = json.has("shN");
  if (meta.has_sh) take("shN", {kCentroids, kLabels});
}

void read_version_2(const JsonValue& json, Meta& meta) {
  meta.count = json["count"].whole(kMostCount);
  meta.antialiased = json.has("antialias") && json["antialias"].flag();
  meta.scales.fill(codebook(json["scales"]));
  meta.colours.fill(codebook(json["sh0"]));
  for (int code = 0; code < 256; ++code)
    meta.opacities[static_cast<size_t>(code)] = logit_of_byte(code);
  if (!meta.has_sh) return;
  const JsonValue sh = json["shN"];
  meta.sh_degree = static_cast<int>(sh["bands"].whole(kMaxShDegree, 1));
  meta.centroids = sh["count"].whole(kMostCentroids, 1);
  meta.sh = codebook(sh);
}

// Steps between a least and a most value in place of code books.
void read_version_1(const JsonValue& json, Meta& meta) {
  meta.count = json["means"]["shape"][0].whole(kMostCount);
  const auto bounds = [&](const char* key, size_t count) {
    return std::pair(numbers(json[key]["mins"], count), numbers(json[key]["maxs"], count));
  };
  const auto [scale_least, scale_most] = bounds("scales", 3);
  const auto [colour_least, colour_most] = bounds("sh0", 4);
  for (size_t k = 0; k < 3; ++k) {
    meta.scales[k] = steps(scale_least[k], scale_most[k]);
    meta.colours[k] = steps(colour_least[k], colour_most[k]);
  }
  meta.opacities = steps(colour_least[3], colour_most[3]);
  if (meta.has_sh) meta.sh = steps(json["shN"]["mins"].number(), json["shN"]["maxs"].number());
}

}  // namespace

std::vector<std::string> Meta::named_files() const {
  std::vector<std::string> names;
  std::copy_if(files.begin(), files.end(), std::back_inserter(names),
               [](const std::string& name) { return !name.empty(); });
  return names;
}

Meta read_meta(const Files& files) {
  const std::vector<std::byte> bytes = files.meta();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const nlohmann::json parsed = parse_json(files.name(), 0, text, kMetaLevels);
  const JsonValue json(files.name(), 0, parsed);
  Meta meta;
  const uint64_t version = json.has("version") ? json["version"].whole(2, 2) : 1;
  read_files(json, meta);
  meta.means_least = three(json["means"]["mins"]);
  meta.means_most = three(json["means"]["maxs"]);
  if (version == 2)
    read_version_2(json, meta);
  else
    read_version_1(json, meta);
  return meta;
}

}  // namespace voyager::sog
